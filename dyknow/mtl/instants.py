"""Sets of instants: unions of intervals of whole nanoseconds.

A set is a flat ascending tuple of boundaries `(start, end, start, end, ...)`; a start belongs to
the set, an end does not. `PAST` and `FUTURE` stand for no bound. No operation takes longer than
linear in the number of boundaries.
"""

from bisect import bisect_right
from collections.abc import Iterable

__all__ = [
    "EMPTY",
    "EVERYTHING",
    "FUTURE",
    "PAST",
    "Instants",
    "after",
    "before",
    "between",
    "both",
    "complement",
    "either",
    "first_from",
    "pieces",
    "run_end",
    "shift",
    "until",
    "without",
]

Instants = tuple[int, ...]
FUTURE = 1 << 62
PAST = -FUTURE
EMPTY: Instants = ()
EVERYTHING: Instants = (PAST, FUTURE)


def between(start: int, end: int) -> Instants:
    """Return the instants from *start* up to but not including *end*."""
    return (start, end) if start < end else EMPTY


def complement(instants: Instants) -> Instants:
    """Return the instants that are not in the set."""
    inner = instants[1:] if instants and instants[0] == PAST else (PAST, *instants)
    return inner[:-1] if inner and inner[-1] == FUTURE else (*inner, FUTURE)


def both(left: Instants, right: Instants) -> Instants:
    """Return the instants that are in each of two sets."""
    found: list[int] = []
    i = j = 0
    while i < len(left) and j < len(right):
        start, end = max(left[i], right[j]), min(left[i + 1], right[j + 1])
        if start < end:
            found += (start, end)
        if left[i + 1] < right[j + 1]:
            i += 2
        else:
            j += 2
    return tuple(found)


def either(left: Instants, right: Instants) -> Instants:
    """Return the instants that are in at least one of two sets."""
    if not left or not right:
        return left or right
    return complement(both(complement(left), complement(right)))


def without(left: Instants, right: Instants) -> Instants:
    """Return the instants of the first set that are not in the second."""
    return both(left, complement(right)) if left and right else left


def pieces(instants: Instants) -> list[tuple[int, int]]:
    """Return the intervals of the set in ascending order, each with its start and end."""
    return [(instants[i], instants[i + 1]) for i in range(0, len(instants), 2)]


def run_end(instants: Instants, start: int) -> int:
    """Return the first instant from *start* on that is not in the set, or `FUTURE`."""
    at = bisect_right(instants, start)
    return instants[at] if at % 2 else start


def first_from(instants: Instants, start: int) -> int:
    """Return the first instant from *start* on that is in the set, or `FUTURE`."""
    at = bisect_right(instants, start)
    if at % 2:
        return start
    return instants[at] if at < len(instants) else FUTURE


def shift(instants: Instants, by: int) -> Instants:
    """Return the set with all bounds moved by *by*."""
    return tuple([_moved(bound, by) for bound in instants])


def before(witnesses: Instants, least: int, most: int) -> Instants:
    """Return the instants that lie *least* to *most* before some witness, both included."""
    bounds = range(0, len(witnesses), 2)
    return _merged([(_less(witnesses[i], most), _less(witnesses[i + 1], least)) for i in bounds])


def after(instants: Instants, least: int, most: int) -> Instants:
    """Return the instants that lie *least* to *most* after some instant, both included."""
    bounds = range(0, len(instants), 2)
    return _merged([(_moved(instants[i], least), _more(instants[i + 1], most)) for i in bounds])


def until(left: Instants, right: Instants, least: int, most: int) -> Instants:
    """Return the instants at which `left until [least, most] right` holds.

    The left set must hold from the instant up to but not including the witness.
    """
    found = [(right[i], right[i + 1]) for i in range(0, len(right), 2)] if least == 0 else []
    for i in range(0, len(left), 2):
        start, end = left[i], left[i + 1]
        for j in range(0, len(right), 2):
            first, last = max(right[j], start), min(right[j + 1], _moved(end, 1))
            if first < last:
                found.append((max(start, _less(first, most)), _less(last, least)))
    return _merged(sorted(found))


def _moved(bound: int, by: int) -> int:
    return bound if bound in (PAST, FUTURE) else bound + by


def _less(bound: int, by: int) -> int:
    if by == FUTURE:
        return PAST
    return _moved(bound, -by)


def _more(bound: int, by: int) -> int:
    return FUTURE if by == FUTURE else _moved(bound, by)


def _merged(pairs: Iterable[tuple[int, int]]) -> Instants:
    """Return the union of intervals that are given in ascending order of their starts."""
    found: list[int] = []
    for start, end in pairs:
        if start >= end:
            continue
        if found and start <= found[-1]:
            found[-1] = max(found[-1], end)
        else:
            found += (start, end)
    return tuple(found)

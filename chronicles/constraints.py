"""Simple temporal networks: which times the instants of a chronicle can have.

A network says for pairs of instants how much later one may be than the other (Dechter, Meiri and
Pearl 1991, 'Temporal constraint networks'). Path consistency makes it minimal: each limit is as
tight as all limits together make it, so that afterwards one look at each pair tells what a new
event leaves possible (Heintz 2009, section 8.4).

Limits are closed and in nanoseconds. `t1 < t2` means that t2 is at least one instant of the
chronicle language later, which is one millisecond.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from chronicles.syntax import (
    Comparison,
    Difference,
    Displaced,
    Instant,
    Length,
    Operand,
    TemporalConstraint,
    Within,
)
from dyknow.time import MILLISECOND

__all__ = [
    "INSTANT",
    "NEVER",
    "UNBOUNDED",
    "ZERO",
    "Bound",
    "TemporalNetwork",
    "bounds_of",
    "floor_to_instant",
]

INSTANT: Final = int(MILLISECOND)
"""The length of an instant, the resolution of the chronicle language, in nanoseconds."""

ZERO: Final = "0"
"""The name of the instant from which time is counted; nothing that is written has it."""

UNBOUNDED: Final = 1 << 60
"""A limit that is none: 36 years in nanoseconds."""

NEVER: Final = 1 << 70
"""A time after all others; those of events fit into 64 bits."""


@dataclass(frozen=True, slots=True)
class Bound:
    """`later - earlier <= limit`.

    Attributes:
        later: Name of an instant.
        earlier: Name of another instant.
        limit: Nanoseconds; may be negative.
        constraint: What the author wrote that says so; None if it goes without saying.
    """

    later: str
    earlier: str
    limit: int
    constraint: TemporalConstraint | None


def floor_to_instant(time: int) -> int:
    """Return the beginning of the instant that *time* lies in."""
    return time - time % INSTANT


def bounds_of(constraint: TemporalConstraint) -> tuple[Bound, ...]:
    """Return the limits that *constraint* puts on pairs of instants.

    An instant that is compared with a length is compared with the instant `ZERO`.

    Raises:
        ValueError: One of its comparisons is not between one or two different instants.
    """
    if isinstance(constraint, Comparison):
        found = _bounds_of_comparison(constraint)
    else:
        found = _bounds_of_within(constraint)
    return tuple(bound for bound in found if bound is not None)


class TemporalNetwork:
    """The minimal network of some bounds.

    Attributes:
        instants: The names of the instants, in order.
        limits: shape (n, n), nanoseconds; the instant of column j is at most `limits[i, j]`
            later than that of row i, `UNBOUNDED` if nothing says so.
    """

    def __init__(self, instants: Sequence[str], bounds: Iterable[Bound]) -> None:
        self.instants = tuple(instants)
        self._index = {name: i for i, name in enumerate(self.instants)}
        self._bounds = tuple(bounds)
        self.limits = self._minimal_limits()

    @property
    def consistent(self) -> bool:
        """Whether any times satisfy all bounds."""
        return bool((np.diagonal(self.limits) >= 0).all())

    def limit(self, earlier: str, later: str) -> int:
        """Return how much later than *earlier* the instant *later* can be at most."""
        return int(self.limits[self._index[earlier], self._index[later]])

    def contradiction(self) -> tuple[TemporalConstraint, ...]:
        """Return constraints that contradict each other, in the order of their circle.

        The result is empty if the network is consistent. Bellman and Ford's search for a circle
        of negative length finds the constraints on it; without any of them there would be none.
        """
        distance = dict.fromkeys(self.instants, 0)
        reached_by: dict[str, Bound] = {}
        changed: str | None = None
        for _ in range(len(self.instants) + 1):
            changed = None
            for bound in self._bounds:
                if distance[bound.earlier] + bound.limit < distance[bound.later]:
                    distance[bound.later] = distance[bound.earlier] + bound.limit
                    reached_by[bound.later] = bound
                    changed = bound.later
        return _circle(changed, reached_by) if changed else ()

    def _minimal_limits(self) -> npt.NDArray[np.int64]:
        n = len(self.instants)
        limits = np.full((n, n), UNBOUNDED, dtype=np.int64)
        np.fill_diagonal(limits, 0)
        for bound in self._bounds:
            at = self._index[bound.earlier], self._index[bound.later]
            limits[at] = min(int(limits[at]), bound.limit)
        for middle in range(n):
            through = limits[:, middle, None] + limits[None, middle, :]
            is_limit = (limits[:, middle, None] < UNBOUNDED) & (limits[middle] < UNBOUNDED)
            limits = np.where(is_limit, np.minimum(limits, through), limits)
            # Contradictory bounds would go on tightening each other beyond all numbers.
            np.maximum(limits, -UNBOUNDED, out=limits)
        return limits


def _circle(start: str, reached_by: dict[str, Bound]) -> tuple[TemporalConstraint, ...]:
    at = start
    for _ in reached_by:
        at = reached_by[at].earlier
    constraints = [reached_by[at].constraint]
    last = at
    while (at := reached_by[at].earlier) != last:
        constraints.append(reached_by[at].constraint)
    return tuple(dict.fromkeys(c for c in reversed(constraints) if c is not None))


def _bounds_of_comparison(comparison: Comparison) -> Iterator[Bound | None]:
    pairs = zip(comparison.operands, comparison.operands[1:], comparison.orders, strict=False)
    for left, right, order in pairs:
        strictness = INSTANT if order in ("<", ">") else 0
        if order in ("<", "<=", "="):
            yield _at_most(left, right, strictness, comparison)
        if order in (">", ">=", "="):
            yield _at_most(right, left, strictness, comparison)


def _bounds_of_within(within: Within) -> Iterator[Bound | None]:
    difference, interval = within.difference, within.interval
    span = within.span
    if interval.upper is not None:
        yield _at_most(difference, Length(span, interval.upper), 0, within)
    if interval.lower is not None:
        yield _at_most(Length(span, interval.lower), difference, 0, within)


def _at_most(
    left: Operand, right: Operand, strictness: int, constraint: TemporalConstraint
) -> Bound | None:
    """Return the bound that says `left + strictness <= right`, if it limits anything."""
    signs: dict[str, int] = {}
    for name, sign in (*_terms(left, 1), *_terms(right, -1)):
        signs[name] = signs.get(name, 0) + sign
    later = [name for name, sign in signs.items() if sign == 1]
    earlier = [name for name, sign in signs.items() if sign == -1]
    is_one_each = len(later) <= 1 and len(earlier) <= 1 and later != earlier
    if not is_one_each or any(abs(sign) > 1 for sign in signs.values()):
        raise ValueError("expected a comparison of two different instants")
    least, most = _offset(left, at_most=False), _offset(right, at_most=True)
    if least is None or most is None:
        return None
    names = (*later, ZERO)[0], (*earlier, ZERO)[0]
    return Bound(names[0], names[1], most - least - strictness, constraint)


def _terms(operand: Operand, sign: int) -> tuple[tuple[str, int], ...]:
    match operand:
        case Instant(_, name, _) | Displaced(_, name, _):
            return ((name, sign),)
        case Difference(_, later, earlier, _):
            return ((later, sign), (earlier, -sign))
        case Length():
            return ()


def _offset(operand: Operand, *, at_most: bool) -> int | None:
    match operand:
        case Length(_, duration):
            return duration
        case Displaced(_, _, interval):
            return interval.upper if at_most else interval.lower
        case _:
            return operand.offset

"""The constraints of a chronicle, and what they came to in one recognition."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from chronicles.conditions import holds, variables_in
from chronicles.constraints import INSTANT
from chronicles.printer import text_of
from chronicles.syntax import (
    Comparison,
    Condition,
    Difference,
    Displaced,
    Domain,
    Instant,
    Interval,
    Length,
    Operand,
    Star,
    Within,
)
from dyknow.time import MILLISECOND
from traffic.explaining.explanation import Constraint, Term

__all__ = ["condition_explained", "constraint_explained"]

_ZERO = "0"


@dataclass(frozen=True, slots=True)
class _Sum:
    """Instants that are added and subtracted, and a length between two bounds; nanoseconds."""

    weights: Mapping[str, int]
    least: int | None
    most: int | None


def constraint_explained(statement: Comparison | Within, times: Mapping[str, int]) -> Constraint:
    """Return what a constraint on *times* (nanoseconds) came to."""
    terms: dict[str, Term] = {}
    for term in _terms(statement, times):
        known = terms.get(term.text)
        terms[term.text] = term if known is None else _both(known, term)
    return Constraint(
        text=text_of(statement),
        terms=list(terms.values()),
        values={},
        holds=all(_keeps(term) for term in terms.values()),
    )


def condition_explained(
    condition: Condition, values: Mapping[str, str], domains: Mapping[str, Domain]
) -> Constraint | None:
    """Return what a condition on *values* came to; None if it is about each event by itself."""
    names = dict.fromkeys(each.name for each in variables_in(condition))
    if any(isinstance(each, Star) for each in variables_in(condition)):
        return None
    return Constraint(
        text=text_of(condition),
        terms=[],
        values={name: values[name] for name in names},
        holds=holds(condition, values, domains),
    )


def _terms(statement: Comparison | Within, times: Mapping[str, int]) -> Iterator[Term]:
    match statement:
        case Within(_, difference, interval):
            what = _sum(difference)
            yield from _at_most(_interval(interval), what, times)
            yield from _at_most(what, _interval(interval), times)
        case Comparison(_, operands, orders):
            sums = [_sum(operand) for operand in operands]
            for order, left, right in zip(orders, sums, sums[1:], strict=False):
                gap = INSTANT if order in ("<", ">") else 0
                if order in (">", ">="):
                    yield from _at_most(right, left, times, gap)
                else:
                    yield from _at_most(left, right, times, gap)
                if order == "=":
                    yield from _at_most(right, left, times)


def _sum(operand: Operand) -> _Sum:
    match operand:
        case Instant(_, name, offset):
            return _Sum({name: 1}, offset, offset)
        case Displaced(_, name, interval):
            return _Sum({name: 1}, interval.lower, interval.upper)
        case Difference(_, later, earlier, offset):
            return _Sum({} if later == earlier else {later: 1, earlier: -1}, offset, offset)
        case Length(_, duration):
            return _Sum({}, duration, duration)


def _interval(interval: Interval) -> _Sum:
    return _Sum({}, interval.lower, interval.upper)


def _at_most(left: _Sum, right: _Sum, times: Mapping[str, int], gap: int = 0) -> Iterator[Term]:
    """Yield what it says that *left* is at most *right*, and less by *gap*.

    A sum with an interval is some length in it: the least of the one side must reach the most of
    the other.
    """
    low, high = left.least, right.most
    if low is None or high is None:
        return
    weights = dict(right.weights)
    for name, weight in left.weights.items():
        weights[name] = weights.get(name, 0) - weight
    weights = {name: weight for name, weight in weights.items() if weight}
    if not weights:
        return
    bound = low - high + gap
    value = sum(weight * times[name] for name, weight in weights.items())
    if value < 0 or (value == 0 and bound < 0):
        flipped = {name: -weight for name, weight in weights.items()}
        yield Term(text=_text(flipped), ms=_ms(-value), least=None, most=_ms(-bound))
    else:
        yield Term(text=_text(weights), ms=_ms(value), least=_ms(bound), most=None)


def _text(weights: Mapping[str, int]) -> str:
    """Return a sum of instants as people write it, what is added first."""
    added = [name for name, weight in weights.items() for _ in range(weight)]
    taken = [name for name, weight in weights.items() for _ in range(-weight)]
    return " ".join([" + ".join(added) or _ZERO, *(f"− {name}" for name in taken)])


def _both(one: Term, other: Term) -> Term:
    least = [each.least for each in (one, other) if each.least is not None]
    most = [each.most for each in (one, other) if each.most is not None]
    return Term(
        text=one.text,
        ms=one.ms,
        least=max(least, default=None),
        most=min(most, default=None),
    )


def _keeps(term: Term) -> bool:
    return (term.least is None or term.least <= term.ms) and (
        term.most is None or term.ms <= term.most
    )


def _ms(duration: int) -> float:
    return duration / MILLISECOND

"""The constraints of a chronicle, and what they came to in one recognition."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

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


@dataclass(frozen=True, slots=True)
class _Order:
    """That one sum is at most another one, and less by a gap; nanoseconds.

    A sum with an interval is some length in it: the least of the one side must reach the most of
    the other.
    """

    left: _Sum
    right: _Sum
    gap: int = 0

    @property
    def weights(self) -> dict[str, int]:
        """The instants of the right side without those of the left side."""
        found = dict(self.right.weights)
        for name, weight in self.left.weights.items():
            found[name] = found.get(name, 0) - weight
        return {name: weight for name, weight in found.items() if weight}

    @property
    def bound(self) -> int | None:
        """How much these must come to at least; None if that does not matter."""
        low, high = self.left.least, self.right.most
        return None if low is None or high is None else low - high + self.gap

    def value(self, times: Mapping[str, int]) -> int:
        """Return how much they come to."""
        return sum(weight * times[name] for name, weight in self.weights.items())

    def holds(self, times: Mapping[str, int]) -> bool:
        """Return whether it is so."""
        return self.bound is None or self.value(times) >= self.bound

    def term(self, times: Mapping[str, int]) -> Term | None:
        """Return the length of time that is bounded, later instants first; None without any."""
        weights, bound, value = self.weights, self.bound, self.value(times)
        if bound is None or not weights:
            return None
        if value < 0 or (value == 0 and bound < 0):
            flipped = {name: -weight for name, weight in weights.items()}
            return Term(text=_text(flipped), ms=_ms(-value), least=None, most=_ms(-bound))
        return Term(text=_text(weights), ms=_ms(value), least=_ms(bound), most=None)


def constraint_explained(statement: Comparison | Within, times: Mapping[str, int]) -> Constraint:
    """Return what a constraint on *times* (nanoseconds) came to."""
    orders = list(_orders(statement))
    terms: dict[str, Term] = {}
    for order in orders:
        term = order.term(times)
        if term is not None:
            known = terms.get(term.text)
            terms[term.text] = term if known is None else _both(known, term)
    return Constraint(
        text=text_of(statement),
        terms=list(terms.values()),
        values={},
        holds=all(order.holds(times) for order in orders),
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


def _orders(statement: Comparison | Within) -> Iterator[_Order]:
    """Yield what a constraint says of pairs of sums."""
    match statement:
        case Within(_, difference, interval):
            what, lengths = _sum(difference), _Sum({}, interval.lower, interval.upper)
            yield _Order(lengths, what)
            yield _Order(what, lengths)
        case Comparison(_, operands, signs):
            for sign, (left, right) in zip(signs, pairwise(map(_sum, operands)), strict=True):
                gap = INSTANT if sign in ("<", ">") else 0
                yield _Order(right, left, gap) if sign in (">", ">=") else _Order(left, right, gap)
                if sign == "=":
                    yield _Order(right, left)


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


def _ms(duration: int) -> float:
    return duration / MILLISECOND

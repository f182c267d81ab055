"""Conditions on the values of variables: which values they allow, and whether any do.

A complement is relative to all symbols, so that `~{}` holds every value and `~{a}` every value
but `a`, whether or not it is written anywhere. A domain is therefore a finite set of values or
all but a finite set.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import assert_never

from chronicles.syntax import (
    Condition,
    Conditional,
    Conjunction,
    Disjunction,
    Domain,
    DomainComplement,
    DomainDifference,
    DomainIntersection,
    DomainReference,
    DomainUnion,
    Equivalence,
    Implication,
    Membership,
    Negation,
    Relation,
    Star,
    Value,
    ValueSet,
    Variable,
)

__all__ = [
    "Members",
    "contradictory_conditions",
    "holds",
    "members_of",
    "parts_of",
    "references_of",
    "tester_of",
    "variables_in",
]

_MOST_TRIALS = 20_000


@dataclass(frozen=True, slots=True)
class Members:
    """A domain as a set.

    Attributes:
        values: Finitely many values.
        complemented: Whether the domain holds all values but these.
    """

    values: frozenset[str]
    complemented: bool = False

    def __contains__(self, value: object) -> bool:
        return (value in self.values) != self.complemented

    def complement(self) -> "Members":
        """Return everything else."""
        return Members(self.values, not self.complemented)

    def intersection(self, other: "Members") -> "Members":
        """Return what is in both."""
        if self.complemented and other.complemented:
            return Members(self.values | other.values, complemented=True)
        if self.complemented:
            return other.intersection(self)
        return Members(frozenset(value for value in self.values if value in other))

    def union(self, other: "Members") -> "Members":
        """Return what is in either."""
        return self.complement().intersection(other.complement()).complement()


def members_of(domain: Domain, domains: Mapping[str, Domain]) -> Members:
    """Return the members of *domain*, looking names up in *domains*, which has no circle."""
    match domain:
        case ValueSet(_, values):
            return Members(frozenset(values))
        case DomainReference(_, name):
            return members_of(domains[name], domains)
        case DomainUnion(_, left, right):
            return members_of(left, domains).union(members_of(right, domains))
        case DomainIntersection(_, left, right):
            return members_of(left, domains).intersection(members_of(right, domains))
        case DomainDifference(_, left, right):
            others = members_of(right, domains).complement()
            return members_of(left, domains).intersection(others)
        case DomainComplement(_, body):
            return members_of(body, domains).complement()
        case _:
            assert_never(domain)


def references_of(domain: Domain) -> Iterator[DomainReference]:
    """Yield the named domains that *domain* is made of."""
    match domain:
        case DomainReference():
            yield domain
        case DomainUnion(_, left, right) | DomainIntersection(_, left, right):
            yield from references_of(left)
            yield from references_of(right)
        case DomainDifference(_, left, right):
            yield from references_of(left)
            yield from references_of(right)
        case DomainComplement(_, body):
            yield from references_of(body)
        case _:
            pass


def parts_of(condition: Condition) -> Iterator[Membership | Relation]:
    """Yield the atomic conditions of *condition*."""
    match condition:
        case Membership() | Relation():
            yield condition
        case Negation(_, body):
            yield from parts_of(body)
        case Conditional(_, first, second, third):
            for part in (first, second, *((third,) if third else ())):
                yield from parts_of(part)
        case _:
            yield from parts_of(condition.left)
            yield from parts_of(condition.right)


def variables_in(condition: Condition) -> tuple[Variable | Star, ...]:
    """Return the variables of *condition*, as often as they stand in it."""
    found: list[Variable | Star] = []
    for part in parts_of(condition):
        terms = (part.variable, part.other) if isinstance(part, Relation) else (part.variable,)
        found.extend(term for term in terms if not isinstance(term, Value))
    return tuple(found)


def holds(condition: Condition, values: Mapping[str, str], domains: Mapping[str, Domain]) -> bool:
    """Return whether *condition* holds for the *values* of its variables."""

    def of(part: Condition) -> bool:
        return holds(part, values, domains)

    def value(term: Variable | Star | Value) -> str:
        return term.text if isinstance(term, Value) else values[term.name]

    match condition:
        case Membership(_, variable, domain):
            return value(variable) in members_of(domain, domains)
        case Relation(_, variable, sign, other):
            return (value(variable) == value(other)) == (sign == "==")
        case Negation(_, body):
            return not of(body)
        case Conditional(_, first, second, third):
            return of(second) if of(first) else third is None or of(third)
        case _:
            return _connected(condition, of(condition.left), of(condition.right))


def _connected(
    condition: Conjunction | Disjunction | Implication | Equivalence,
    left: bool,  # noqa: FBT001  # a truth value is what it is about
    right: bool,  # noqa: FBT001
) -> bool:
    match condition:
        case Conjunction():
            return left and right
        case Disjunction():
            return left or right
        case Implication():
            return not left or right
        case Equivalence():
            return left == right


_Row = Sequence[str | None]
_Test = Callable[[_Row], bool]


def tester_of(condition: Condition, names: Sequence[str], domains: Mapping[str, Domain]) -> _Test:
    """Return *condition* as a function of the values of *names*, taken apart once."""

    def of(part: Condition) -> _Test:
        return tester_of(part, names, domains)

    match condition:
        case Membership(_, variable, domain):
            return _membership(_term(variable, names), members_of(domain, domains))
        case Relation(_, variable, sign, other):
            return _relation(_term(variable, names), _term(other, names), same=sign == "==")
        case Negation(_, body):
            test = of(body)
            return lambda row: not test(row)
        case Conditional(_, first, second, third):
            return _choice(of(first), of(second), of(third) if third else lambda _row: True)
        case _:
            return _joined(condition, of(condition.left), of(condition.right))


def _term(term: Variable | Star | Value, names: Sequence[str]) -> Callable[[_Row], str | None]:
    if isinstance(term, Value):
        text = term.text
        return lambda _row: text
    return itemgetter(names.index(term.name))


def _relation(
    left: Callable[[_Row], str | None], right: Callable[[_Row], str | None], *, same: bool
) -> _Test:
    return lambda row: (left(row) == right(row)) == same


def _membership(term: Callable[[_Row], str | None], members: Members) -> _Test:
    values, complemented = members.values, members.complemented
    return lambda row: (term(row) in values) != complemented


def _choice(first: _Test, second: _Test, third: _Test) -> _Test:
    return lambda row: second(row) if first(row) else third(row)


def _joined(
    condition: Conjunction | Disjunction | Implication | Equivalence, left: _Test, right: _Test
) -> _Test:
    match condition:
        case Conjunction():
            return lambda row: left(row) and right(row)
        case Disjunction():
            return lambda row: left(row) or right(row)
        case Implication():
            return lambda row: not left(row) or right(row)
        case Equivalence():
            return lambda row: left(row) == right(row)


def contradictory_conditions(
    conditions: Sequence[Condition], domains: Mapping[str, Domain]
) -> tuple[Condition, ...]:
    """Return some of *conditions* that no values satisfy together, none of them needlessly.

    The result is empty if there are such values. As conditions only compare values with each
    other and with those that are written down, it is enough to try the latter, and for each
    variable one more value that is written nowhere. Very large searches are given up, and their
    conditions taken to be satisfiable.
    """
    if _satisfiable(conditions, domains):
        return ()
    needed = list(conditions)
    for condition in conditions:
        others = [other for other in needed if other is not condition]
        if not _satisfiable(others, domains):
            needed = others
    return tuple(needed)


def _satisfiable(  # noqa: C901  # one search
    conditions: Sequence[Condition], domains: Mapping[str, Domain]
) -> bool:
    names = list(dict.fromkeys(v.name for c in conditions for v in variables_in(c)))
    constants = dict.fromkeys(_constants(conditions, domains))
    waiting: list[list[Condition]] = [[] for _ in names]
    for condition in conditions:
        places = [names.index(v.name) for v in variables_in(condition)]
        if places:
            waiting[max(places)].append(condition)
        elif not holds(condition, {}, domains):
            return False
    n_trials = 0

    def extend(at: int, values: dict[str, str]) -> bool:
        nonlocal n_trials
        if at == len(names):
            return True
        for value in (*constants, *(f"\0{i}" for i in range(at + 1))):
            n_trials += 1
            if n_trials > _MOST_TRIALS:
                return True
            values[names[at]] = value
            if all(holds(c, values, domains) for c in waiting[at]) and extend(at + 1, values):
                return True
        return False

    return extend(0, {})


def _constants(conditions: Sequence[Condition], domains: Mapping[str, Domain]) -> Iterator[str]:
    for condition in conditions:
        for part in parts_of(condition):
            if isinstance(part, Membership):
                yield from sorted(members_of(part.domain, domains).values)
            elif isinstance(part.other, Value):
                yield part.other.text
            if isinstance(part.variable, Value):
                yield part.variable.text

"""Chronicles prepared for recognition: event slots, counters, minimal limits between them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from chronicles.check import check, domain_values
from chronicles.constraints import INSTANT, TemporalNetwork, bounds_of
from chronicles.patterns import Pattern, Values, pattern_from_event_type
from chronicles.syntax import (
    Chronicle,
    ChronicleFile,
    EventAt,
    Membership,
    NoEvent,
    Occurs,
    Relation,
    ReportNonOverlapping,
    TemporalConstraint,
    ValueSet,
    Variable,
)

__all__ = ["Counter", "Model", "Restriction", "Slot", "models_from_chronicles"]


@dataclass(frozen=True, slots=True)
class Slot:
    """An `event` predicate, to be filled by one event.

    Attributes:
        index: Its place among the event predicates of the model.
        instant: Name of its time.
        pattern: Which events fill it.
        neighbours: The slots that share a variable with it, as a set of bits; if the slots would
            fall into parts without a shared variable, each slot also neighbours the other parts.
    """

    index: int
    instant: str
    pattern: Pattern
    neighbours: int


@dataclass(frozen=True, slots=True, eq=False)
class Counter:
    """An `occurs` or `noevent` predicate; each is equal only to itself.

    Attributes:
        least: Least number of events.
        most: Largest number; None is without limit.
        pattern: Which events count.
        begin: Slot at whose time the interval begins.
        begin_offset: Nanoseconds from there to the beginning.
        end: Slot at whose time the interval ends.
        end_offset: Nanoseconds from there to the end, which itself does not count.
        looks_back: Whether events count that can come before the instance knows that they do.
        predicate: What it was made from.
    """

    least: int
    most: int | None
    pattern: Pattern
    begin: int
    begin_offset: int
    end: int
    end_offset: int
    looks_back: bool
    predicate: NoEvent | Occurs


@dataclass(frozen=True, slots=True)
class Restriction:
    """A condition on the values of some variables.

    Attributes:
        variables: Whose values it looks at.
        allows: Whether it allows their values, in that order.
    """

    variables: tuple[str, ...]
    allows: Callable[[Values], bool]


@dataclass(frozen=True, slots=True)
class Model:
    """A chronicle, ready to be recognised.

    Attributes:
        name: Name of the chronicle.
        parameters: The variables that a recognition tells.
        variables: All variables, in the order in which the slots bind them.
        slots: The event predicates.
        counters: The `occurs` and `noevent` predicates.
        limits: `limits[i][j]`: how much later than slot i slot j can be at most.
        restrictions: Conditions on variables.
        counted_interval: The slots at whose times the interval of `report non_overlapping`
            begins and ends, or None if all matches are reported.
    """

    name: str
    parameters: tuple[str, ...]
    variables: tuple[str, ...]
    slots: tuple[Slot, ...]
    counters: tuple[Counter, ...]
    limits: tuple[tuple[int, ...], ...]
    restrictions: tuple[Restriction, ...]
    counted_interval: tuple[int, int] | None


def models_from_chronicles(file: ChronicleFile) -> tuple[Model, ...]:
    """Return the chronicles of *file*, checked and ready to be recognised.

    Raises:
        SpecificationErrors: The file has faults.
    """
    check(file)
    domains = {declaration.name: declaration.domain for declaration in file.domains}
    return tuple(_model(chronicle, domains) for chronicle in file.chronicles)


def _model(chronicle: Chronicle, domains: dict[str, ValueSet]) -> Model:
    slots = _slots([s for s in chronicle.statements if isinstance(s, EventAt)])
    variables = dict.fromkeys(name for slot in slots for name in slot.pattern.variables)
    counted = [s for s in chronicle.statements if isinstance(s, ReportNonOverlapping)]
    slot_at = {slot.instant: slot.index for slot in reversed(slots)}
    return Model(
        name=chronicle.name,
        parameters=tuple(parameter.name for parameter in chronicle.parameters),
        variables=tuple(variables),
        slots=slots,
        counters=tuple(
            _counter(s, slots) for s in chronicle.statements if isinstance(s, NoEvent | Occurs)
        ),
        limits=_limits(chronicle, slots),
        restrictions=tuple(
            _restriction(s, domains)
            for s in chronicle.statements
            if isinstance(s, Membership | Relation)
        ),
        counted_interval=(
            (slot_at[counted[0].begin], slot_at[counted[0].end]) if counted else None
        ),
    )


def _slots(events: Sequence[EventAt]) -> tuple[Slot, ...]:
    patterns = [pattern_from_event_type(event.event_type) for event in events]
    neighbours = _neighbours([set(pattern.variables) for pattern in patterns])
    return tuple(
        Slot(index, event.instant, pattern, shared)
        for index, (event, pattern, shared) in enumerate(
            zip(events, patterns, neighbours, strict=True)
        )
    )


def _neighbours(variables: Sequence[set[str]]) -> list[int]:
    slots = range(len(variables))
    neighbours = [
        sum(1 << j for j in slots if j != i and variables[i] & variables[j]) for i in slots
    ]
    everything = (1 << len(variables)) - 1
    parts = [_closure(1 << i, neighbours) for i in slots]
    return [near | everything & ~part for near, part in zip(neighbours, parts, strict=True)]


def _closure(part: int, neighbours: Sequence[int]) -> int:
    while True:
        grown = part
        for i, near in enumerate(neighbours):
            if part & 1 << i:
                grown |= near
        if grown == part:
            return part
        part = grown


def _limits(chronicle: Chronicle, slots: Sequence[Slot]) -> tuple[tuple[int, ...], ...]:
    bounds = [
        bound
        for statement in chronicle.statements
        if isinstance(statement, TemporalConstraint)
        for bound in bounds_of(statement)
    ]
    instants = tuple(dict.fromkeys(slot.instant for slot in slots))
    network = TemporalNetwork(instants, bounds)
    return tuple(
        tuple(network.limit(one.instant, other.instant) for other in slots) for one in slots
    )


def _counter(predicate: NoEvent | Occurs, slots: Sequence[Slot]) -> Counter:
    least, most = (0, 0) if isinstance(predicate, NoEvent) else (predicate.least, predicate.most)
    pattern = pattern_from_event_type(predicate.event_type)
    begin = _binding_slot(predicate.begin.name, pattern, slots)
    end = _binding_slot(predicate.end.name, pattern, slots)
    knows_all = set(pattern.variables) <= set(begin.pattern.variables)
    is_forbidden = most == 0 and predicate.begin.offset >= INSTANT
    return Counter(
        least=least,
        most=most,
        pattern=pattern,
        begin=begin.index,
        begin_offset=predicate.begin.offset,
        end=end.index,
        end_offset=predicate.end.offset,
        looks_back=not (knows_all and is_forbidden),
        predicate=predicate,
    )


def _binding_slot(instant: str, pattern: Pattern, slots: Iterable[Slot]) -> Slot:
    """Return the slot at *instant* that binds most of the variables of *pattern*."""
    at_instant = [slot for slot in slots if slot.instant == instant]
    wanted = set(pattern.variables)
    return max(at_instant, key=lambda slot: len(wanted & set(slot.pattern.variables)))


def _restriction(statement: Membership | Relation, domains: dict[str, ValueSet]) -> Restriction:
    name = statement.variable.name
    if isinstance(statement, Membership):
        members = domain_values(statement.domain, domains)
        return Restriction((name,), lambda values: values[0] in members)
    wants_same = statement.sign == "=="
    if isinstance(statement.other, Variable):
        both = (name, statement.other.name)
        return Restriction(both, lambda values: (values[0] == values[1]) == wants_same)
    text = statement.other.text
    return Restriction((name,), lambda values: (values[0] == text) == wants_same)

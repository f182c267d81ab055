"""Chronicles prepared for recognition: event slots, counters, minimal limits between them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from chronicles.check import check
from chronicles.conditions import tester_of, variables_in
from chronicles.constraints import INSTANT, ZERO, Bound
from chronicles.expansion import END, START, expand, instants_of
from chronicles.patterns import Filter, Pattern, Values, pattern_from_event_type
from chronicles.syntax import (
    Chronicle,
    ChronicleFile,
    Condition,
    Domain,
    EventAt,
    EventType,
    Instant,
    NoEvent,
    Occurs,
    ReportNonOverlapping,
    Star,
    names_in,
)
from chronicles.timing import Place, timing_of

__all__ = ["Counter", "Extreme", "Model", "Restriction", "Slot", "models_from_chronicles"]


@dataclass(frozen=True, slots=True)
class Slot:
    """An `event` predicate, to be filled by one event.

    Attributes:
        index: Its place among the event predicates of the model.
        instant: Name of its time.
        pattern: Which events fill it.
        neighbours: The slots that share a variable with it, as a set of bits; if the slots would
            fall into parts without a shared variable, each slot also neighbours the other parts.
        earliest: Before which time since time zero it cannot be filled.
        latest: After which time since time zero it cannot be filled.
    """

    index: int
    instant: str
    pattern: Pattern
    neighbours: int
    earliest: int
    latest: int


@dataclass(frozen=True, slots=True)
class Extreme:
    """The earliest or latest of some slots, where the constraints leave open which that is.

    It has a place in the times of an instance behind those of the slots, and is known when all
    slots are filled.

    Attributes:
        is_end: Whether it is the latest.
        slots: The places of the slots.
    """

    is_end: bool
    slots: tuple[int, ...]

    def time(self, times: Sequence[int]) -> int:
        """Return its time."""
        found = [times[i] for i in self.slots]
        return max(found) if self.is_end else min(found)


@dataclass(frozen=True, slots=True, eq=False)
class Counter:
    """An `occurs` or `noevent` predicate; each is equal only to itself.

    Attributes:
        least: Least number of events.
        most: Largest number; None is without limit.
        pattern: Which events count.
        begin: Slot or extreme at whose time the interval begins, by its place among the times.
        begin_offset: Nanoseconds from there to the beginning.
        end: Slot or extreme at whose time the interval ends.
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
        extremes: The beginning and the end, as far as they are open and matter.
        derived: Other instants of the text, by name: a place among the times, and how much later.
        tests: What must hold of the times once all slots are filled: the time at one place is at
            most so much later than that at another; -1 stands for time zero.
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
    extremes: tuple[Extreme, ...]
    derived: Mapping[str, tuple[int, int]]
    tests: tuple[tuple[int, int, int], ...]
    counted_interval: tuple[int, int] | None


def models_from_chronicles(file: ChronicleFile) -> tuple[Model, ...]:
    """Return the chronicles of *file*, checked and ready to be recognised.

    Raises:
        SpecificationErrors: The file has faults.
    """
    check(file)
    domains = {declaration.name: declaration.domain for declaration in file.domains}
    return tuple(_Maker(chronicle, file, domains).model() for chronicle in file.chronicles)


class _Maker:
    """Makes the model of one chronicle."""

    def __init__(
        self, chronicle: Chronicle, file: ChronicleFile, domains: Mapping[str, Domain]
    ) -> None:
        self._chronicle = chronicle
        self._domains = domains
        expansion = expand(chronicle, file)
        self._statements = expansion.statements
        self._timing = timing_of(expansion)
        self._slots = self._make_slots(expansion.events)
        slot_at = {slot.instant: slot.index for slot in reversed(self._slots)}
        used = self._extremes_used()
        self._extremes = tuple(
            Extreme(extreme.is_end, tuple(slot_at[name] for name in extreme.members))
            for name, extreme in self._timing.open_extremes.items()
            if name in used
        )
        n_slots = len(self._slots)
        self._index = slot_at | {name: n_slots + i for i, name in enumerate(used)}

    def model(self) -> Model:
        statements = self._statements
        counted = [s for s in statements if isinstance(s, ReportNonOverlapping)]
        variables = dict.fromkeys(name for slot in self._slots for name in slot.pattern.variables)
        return Model(
            name=self._chronicle.name,
            parameters=tuple(parameter.name for parameter in self._chronicle.parameters),
            variables=tuple(variables),
            slots=self._slots,
            counters=tuple(
                self._counter(s) for s in statements if isinstance(s, NoEvent | Occurs)
            ),
            limits=self._limits(),
            restrictions=tuple(
                self._restriction(s)
                for s in statements
                if isinstance(s, Condition) and not _has_star(s)
            ),
            extremes=self._extremes,
            derived=self._derived(),
            tests=tuple(self._test(bound) for bound in self._timing.tests),
            counted_interval=(
                (self._at(counted[0].begin)[0], self._at(counted[0].end)[0]) if counted else None
            ),
        )

    def _at(self, instant: str) -> tuple[int, int]:
        """Return the place of *instant* among the times, and how much later it is."""
        if instant == ZERO:
            return -1, 0
        place: Place = self._timing.places[instant]
        return self._index[place.anchor], place.offset

    def _extremes_used(self) -> tuple[str, ...]:
        names = [
            name
            for statement in self._statements
            if not isinstance(statement, Condition)
            for name in instants_of(statement)
            if name in self._timing.places
        ]
        anchors = dict.fromkeys(self._timing.places[name].anchor for name in names)
        return tuple(name for name in self._timing.open_extremes if name in anchors)

    def _derived(self) -> dict[str, tuple[int, int]]:
        events = {slot.instant for slot in self._slots}
        return {
            name: self._at(name)
            for name, place in self._timing.places.items()
            if name not in events
            and name.rpartition(".")[2] not in (START, END)
            and place.anchor in self._index
        }

    def _test(self, bound: Bound) -> tuple[int, int, int]:
        later, later_offset = self._at(bound.later)
        earlier, earlier_offset = self._at(bound.earlier)
        return later, earlier, bound.limit - later_offset + earlier_offset

    def _make_slots(self, events: Sequence[EventAt]) -> tuple[Slot, ...]:
        patterns = [self._pattern(event.event_type) for event in events]
        neighbours = _neighbours([set(pattern.variables) for pattern in patterns])
        return tuple(
            Slot(index, event.instant, pattern, shared, *self._timing.window(event.instant))
            for index, (event, pattern, shared) in enumerate(
                zip(events, patterns, neighbours, strict=True)
            )
        )

    def _pattern(self, event_type: EventType) -> Pattern:
        """Return the pattern of *event_type*, which also tests its star variables."""
        known = names_in(event_type)
        filters = []
        for statement in self._statements:
            if isinstance(statement, Condition) and _has_star(statement):
                names = tuple(dict.fromkeys(v.name for v in variables_in(statement)))
                if set(names) <= known:
                    filters.append(Filter(names, tester_of(statement, names, self._domains)))
        return pattern_from_event_type(event_type, filters)

    def _limits(self) -> tuple[tuple[int, ...], ...]:
        network = self._timing.network
        return tuple(
            tuple(network.limit(one.instant, other.instant) for other in self._slots)
            for one in self._slots
        )

    def _counter(self, predicate: NoEvent | Occurs) -> Counter:
        least, most = (
            (0, 0) if isinstance(predicate, NoEvent) else (predicate.least, predicate.most)
        )
        pattern = self._pattern(predicate.event_type)
        begin, begin_offset = self._end_of_interval(predicate.begin, pattern)
        end, end_offset = self._end_of_interval(predicate.end, pattern)
        n_slots = len(self._slots)
        begin_variables = self._slots[begin].pattern.variables if begin < n_slots else ()
        knows_all = begin < n_slots and set(pattern.variables) <= set(begin_variables)
        is_forbidden = most == 0 and begin_offset >= INSTANT and end < n_slots
        return Counter(
            least=least,
            most=most,
            pattern=pattern,
            begin=begin,
            begin_offset=begin_offset,
            end=end,
            end_offset=end_offset,
            looks_back=not (knows_all and is_forbidden),
            predicate=predicate,
        )

    def _end_of_interval(self, instant: Instant, pattern: Pattern) -> tuple[int, int]:
        """Return the place of an end of an interval, and the time from there to it.

        Of several slots at one instant it is that which binds most variables of *pattern*.
        """
        place, offset = self._at(instant.name)
        offset += instant.offset
        if place >= len(self._slots):
            return place, offset
        name = self._slots[place].instant
        at_instant = [slot for slot in self._slots if slot.instant == name]
        wanted = set(pattern.variables)
        best = max(at_instant, key=lambda slot: len(wanted & set(slot.pattern.variables)))
        return best.index, offset

    def _restriction(self, condition: Condition) -> Restriction:
        names = tuple(dict.fromkeys(variable.name for variable in variables_in(condition)))
        return Restriction(names, tester_of(condition, names, self._domains))


def _has_star(condition: Condition) -> bool:
    return any(isinstance(variable, Star) for variable in variables_in(condition))


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

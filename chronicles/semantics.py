"""What chronicles mean, as plainly as it can be written down; `docs/chronicles.md` says why.

Everything is tried: each event for each `event` predicate, and then whether all statements hold.
Nothing here is meant to be fast. The tests hold the recogniser to it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from chronicles.conditions import holds, variables_in
from chronicles.constraints import INSTANT
from chronicles.events import Event
from chronicles.expansion import Expansion, expand, instants_of
from chronicles.syntax import (
    Chronicle,
    ChronicleFile,
    Comparison,
    Condition,
    Difference,
    Displaced,
    Domain,
    EventAt,
    EventType,
    Instant,
    Length,
    NoEvent,
    Occurs,
    Operand,
    Star,
    Value,
    Variable,
    Within,
    names_in,
)

__all__ = ["Match", "matches"]

_MARGIN = 12
"""How many instants around the events are tried for instants that are no times of events."""

_EVER = -(1 << 62)

Times = Mapping[str, int]
Values = Mapping[str, str]


@dataclass(frozen=True, order=True, slots=True)
class Match:
    """An assignment that satisfies a chronicle.

    Attributes:
        recognised_at: From when on nothing could take it back.
        times: The time of each instant at which an event is asked for, by name.
        values: The value of each variable, by name.
    """

    recognised_at: int
    times: tuple[tuple[str, int], ...]
    values: tuple[tuple[str, str], ...]


def matches(
    chronicle: Chronicle, file: ChronicleFile, events: Sequence[Event], clock: int
) -> list[Match]:
    """Return all matches of *chronicle* that are certain when the clock stands at *clock*.

    Args:
        chronicle: The chronicle.
        file: What it refers to.
        events: At whole instants; also those that other chronicles are.
        clock: The time before which everything is known.
    """
    return sorted(set(_Meaning(expand(chronicle, file), file, events).matches(clock)))


class _Meaning:
    def __init__(self, expansion: Expansion, file: ChronicleFile, events: Sequence[Event]) -> None:
        facts = {(e.time, e.attribute, e.arguments, e.from_value, e.to_value): e for e in events}
        self._events = list(facts.values())
        self._expansion = expansion
        self._statements = expansion.statements
        self._domains: dict[str, Domain] = {d.name: d.domain for d in file.domains}
        starred = [s for s in self._statements if isinstance(s, Condition) and _stars_in(s)]
        self._star_conditions: list[Condition] = starred

    def matches(self, clock: int) -> Iterator[Match]:
        for at_events, values in self._assignments():
            for times in self._complete(at_events):
                settled = [self._settled_at(s, times, values) for s in self._statements]
                if None in settled or not self._all_hold(times, values):
                    continue
                moments = [int(moment) for moment in settled if moment is not None]
                recognised_at = max([*moments, *at_events.values()])
                if recognised_at <= clock:
                    instants = tuple(sorted(at_events.items()))
                    yield Match(recognised_at, instants, tuple(sorted(values.items())))

    def _assignments(self) -> Iterator[tuple[Times, Values]]:
        def extend(
            left: list[EventAt], times: Times, values: Values
        ) -> Iterator[tuple[Times, Values]]:
            if not left:
                yield times, values
                return
            first, *others = left
            for event in self._events:
                if times.get(first.instant, event.time) == event.time:
                    extended = self._match(first.event_type, event, values)
                    if extended is not None:
                        now = {**times, first.instant: event.time}
                        yield from extend(others, now, extended)

        yield from extend(self._expansion.events, {}, {})

    def _match(self, event_type: EventType, event: Event, known: Values) -> Values | None:
        """Return the values of the variables if *event* is of a type, given *known* values."""
        change = event_type.change
        is_message = event.from_value is None and event.to_value is None
        if event.attribute != event_type.name or (change is not None and is_message):
            return None
        parameters = (*event_type.arguments, *((change.before, change.after) if change else ()))
        found = (*event.arguments, *((event.from_value, event.to_value) if change else ()))
        if len(event.arguments) != len(event_type.arguments):
            return None
        values = dict(known)
        stars: dict[str, list[str]] = {}
        for parameter, value in zip(parameters, found, strict=True):
            if isinstance(parameter, Value) and value != parameter.text:
                return None
            if isinstance(parameter, Variable) and (
                value is None or values.setdefault(parameter.name, value) != value
            ):
                return None
            if isinstance(parameter, Star):
                stars.setdefault(parameter.name, []).append("" if value is None else value)
        return values if self._stars_hold(stars, event_type, values) else None

    def _stars_hold(
        self, stars: Mapping[str, list[str]], event_type: EventType, values: Values
    ) -> bool:
        own = names_in(event_type)
        for condition in self._star_conditions:
            if {variable.name for variable in variables_in(condition)} <= own:
                for chosen in product(*stars.values()):
                    with_stars = {**values, **dict(zip(stars, chosen, strict=True))}
                    if not holds(condition, with_stars, self._domains):
                        return False
        return True

    def _complete(self, times: Times) -> Iterator[Times]:
        """Yield the ways to give times to the instants that are no times of events."""
        known = dict(times)
        for name, extreme in self._expansion.extremes.items():
            moments = [times[member] for member in extreme.members]
            known[name] = max(moments) if extreme.is_end else min(moments)
        used = {name for s in self._statements for name in instants_of(s)}
        free = sorted((used | set(self._expansion.declared)) - set(known))
        first = min(times.values()) - _MARGIN * INSTANT
        tried = range(first, max(times.values()) + _MARGIN * INSTANT, INSTANT)
        for chosen in product(tried, repeat=len(free)):
            yield {**known, **dict(zip(free, chosen, strict=True))}

    def _all_hold(self, times: Times, values: Values) -> bool:
        for statement in self._statements:
            match statement:
                case Comparison():
                    if not _compares(statement, times):
                        return False
                case Within(_, difference, interval):
                    low, high = _amount(difference, times)
                    if not (_at_most(interval.lower, low) and _at_most(high, interval.upper)):
                        return False
                case _ if isinstance(statement, Condition) and not _stars_in(statement):
                    if not holds(statement, values, self._domains):
                        return False
                case _:
                    pass
        return True

    def _settled_at(self, statement: object, times: Times, values: Values) -> int | None:
        """Return from when on a counter holds for good; None if it never does."""
        most: int | None
        match statement:
            case NoEvent(_, event_type, begin, end):
                least, most = 0, 0
            case Occurs(_, least, most, event_type, begin, end):
                pass
            case _:
                return _EVER
        first, last = times[begin.name] + begin.offset, times[end.name] + end.offset
        counted = sorted(
            event.time
            for event in self._events
            if first <= event.time < last and self._match(event_type, event, values) is not None
        )
        if len(counted) < least or (most is not None and len(counted) > most):
            return None
        if first >= last:
            return _EVER
        if most is not None:
            return last
        return counted[least - 1] if least else _EVER


def _stars_in(condition: Condition) -> bool:
    return any(isinstance(variable, Star) for variable in variables_in(condition))


def _amount(operand: Operand, times: Times) -> tuple[int | None, int | None]:
    """Return the least and the largest number that a temporal expression may stand for."""
    match operand:
        case Instant(_, name, offset):
            return times[name] + offset, times[name] + offset
        case Displaced(_, name, interval):
            lower, upper = interval.lower, interval.upper
            return (
                None if lower is None else times[name] + lower,
                None if upper is None else times[name] + upper,
            )
        case Difference(_, later, earlier, offset):
            length = times[later] - times[earlier] + offset
            return length, length
        case Length(_, duration):
            return duration, duration


def _compares(comparison: Comparison, times: Times) -> bool:
    amounts = [_amount(operand, times) for operand in comparison.operands]
    pairs = zip(comparison.orders, amounts, amounts[1:], strict=False)
    return all(_in_order(order, left, right) for order, left, right in pairs)


def _in_order(
    order: str, left: tuple[int | None, int | None], right: tuple[int | None, int | None]
) -> bool:
    if order in (">", ">="):
        left, right = right, left
    forward = _at_most(left[0], right[1], strictly=order in ("<", ">"))
    return forward and (order != "=" or _at_most(right[0], left[1]))


def _at_most(low: int | None, high: int | None, *, strictly: bool = False) -> bool:
    return low is None or high is None or (low < high if strictly else low <= high)

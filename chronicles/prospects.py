"""Partial instances as people see them: what has been seen, what is still awaited, until when."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from chronicles.constraints import NEVER
from chronicles.events import Event
from chronicles.instances import Instance
from chronicles.models import Model
from chronicles.printer import text_of
from chronicles.syntax import EventAt, EventType, Parameter, Value, Variable
from dyknow.source_text import MADE_IN_PYTHON
from dyknow.time import TimePoint

__all__ = ["Awaited", "EndedInstance", "PartialInstance", "partial_instance"]


@dataclass(frozen=True, slots=True)
class Awaited:
    """Something that a partial instance waits for.

    Attributes:
        predicate: The predicate of the chronicle with the values known so far.
        earliest: When the event can come at the earliest; for an interval, when it begins.
        latest: Until when, None if there is no limit; for an interval, when it ends.
    """

    predicate: str
    earliest: TimePoint
    latest: TimePoint | None


@dataclass(frozen=True, slots=True)
class PartialInstance:
    """A chronicle some of whose events have been seen.

    Attributes:
        chronicle: Name of the chronicle.
        values: Values of the variables known so far, by name without mark.
        instants: Times of the events seen, by the name of the instant.
        events: The events seen, in the order of the model.
        awaited: What is still to come: events, or if all have come, the ends of the intervals
            in which events are counted.
    """

    chronicle: str
    values: dict[str, str]
    instants: dict[str, TimePoint]
    events: tuple[Event, ...]
    awaited: tuple[Awaited, ...]

    def is_possible(self, clock: int) -> bool:
        """Return whether everything that is awaited can still come.

        An instance that has become impossible is dropped when its deadline is, which may be later
        in the same instant.
        """
        return all(
            each.latest is None or max(clock, each.earliest) <= each.latest
            for each in self.awaited
        )


@dataclass(frozen=True, slots=True)
class EndedInstance:
    """A partial instance that can no longer become complete.

    Attributes:
        instance: What had been seen, and what was awaited.
        reason: Why: `deadline`, `forbidden event`, `too many events`, `too few events`, or
            `limit` if it was given up because there were too many.
        time: When that was known.
    """

    instance: PartialInstance
    reason: str
    time: TimePoint


def partial_instance(model: Model, instance: Instance, clock: int) -> PartialInstance:
    """Return what *instance* of *model* looks like when the clock stands at *clock*."""
    stage = instance.stage
    values = dict(zip(stage.variables, instance.values, strict=True))
    found = _intervals if stage.is_complete else _slots
    return PartialInstance(
        chronicle=model.name,
        values={name.removeprefix("?"): value for name, value in values.items()},
        instants={model.slots[i].instant: TimePoint(instance.times[i]) for i in stage.filled},
        events=tuple(event for event in instance.events if event is not None),
        awaited=tuple(found(model, instance, clock, values)),
    )


def _slots(
    model: Model, instance: Instance, clock: int, values: Mapping[str, str]
) -> Iterator[Awaited]:
    stage = instance.stage
    for i in stage.open:
        slot = model.slots[i]
        event_type = _with_values(slot.pattern.event_type, values)
        pauses = [instance.times[j] - model.limits[i][j] for j in stage.filled]
        earliest = max(clock if i in stage.awaited else pauses[0], *pauses)
        latest = instance.times[i]
        yield Awaited(
            text_of(EventAt(MADE_IN_PYTHON, event_type, slot.instant)),
            TimePoint(earliest),
            TimePoint(latest) if latest < NEVER else None,
        )


def _intervals(
    model: Model, instance: Instance, clock: int, values: Mapping[str, str]
) -> Iterator[Awaited]:
    for counter in model.counters:
        begin = instance.times[counter.begin] + counter.begin_offset
        end = instance.times[counter.end] + counter.end_offset
        if end > max(begin, clock):
            event_type = _with_values(counter.pattern.event_type, values)
            yield Awaited(
                text_of(replace(counter.predicate, event_type=event_type)),
                TimePoint(begin),
                TimePoint(end),
            )


def _with_values(event_type: EventType, values: Mapping[str, str]) -> EventType:
    def known(parameter: Parameter) -> Parameter:
        if isinstance(parameter, Variable) and parameter.name in values:
            return Value(parameter.span, values[parameter.name])
        return parameter

    change = event_type.change
    return replace(
        event_type,
        arguments=tuple(map(known, event_type.arguments)),
        change=change and replace(change, before=known(change.before), after=known(change.after)),
    )

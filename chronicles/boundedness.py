"""Which partial instances of a chronicle would be kept without end, and for want of what limit.

An instance lives until the deadline of one of the events that it awaits. Instances that have
seen some events, and await only such as nothing limits, are given up only if a forbidden event
ends them. If it is the very next event of the kind that they began with which does that, there is
never more than one of them for the same values: what holds now is remembered as long as it holds,
such as `event(p[?x]:(?, true), t0)` with `noevent(p[?x]:(true, ?), (t0 + 1, t1))`. That is no
reason for a warning.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from chronicles.constraints import INSTANT, UNBOUNDED
from chronicles.expansion import expand
from chronicles.models import Counter, Model, Slot, models_from_chronicles
from chronicles.syntax import Anything, ChronicleFile, EventType, Parameter
from dyknow.source_text import Span

__all__ = ["UnlimitedEvent", "warnings"]


@dataclass(frozen=True, slots=True)
class UnlimitedEvent:
    """An event that a partial instance may await without end.

    Attributes:
        span: Where the event is asked for.
        message: What to tell about it.
    """

    span: Span
    message: str


def warnings(file: ChronicleFile) -> list[UnlimitedEvent]:
    """Return the events of *file*, which has no faults, that need a limit, in reading order."""
    found: dict[Span, UnlimitedEvent] = {}
    for chronicle, model in zip(file.chronicles, models_from_chronicles(file), strict=True):
        events = expand(chronicle, file).events
        for seen, awaited in unlimited(model):
            since = model.slots[seen].instant
            slot = model.slots[awaited]
            message = (
                f"chronicle '{model.name}' may await this event without end: nothing limits how"
                f" long after '{since}' '{slot.instant}' can be"
            )
            span = events[awaited].span
            found.setdefault(span, UnlimitedEvent(span, message))
    return sorted(found.values(), key=lambda warning: warning.span.start)


def unlimited(model: Model) -> Iterator[tuple[int, int]]:
    """Yield pairs of a slot that has been filled and one that may be awaited without end.

    From each slot on, the slots that are awaited with a limit are taken to be filled as well;
    if this leaves any open that share a variable with them, they are awaited without end.
    """
    for slot in model.slots:
        filled = _reached(slot, model.slots, model.limits)
        near = 0
        for i in filled:
            near |= model.slots[i].neighbours
        awaited = [s.index for s in model.slots if near & 1 << s.index and s.index not in filled]
        possible = all(s.latest >= UNBOUNDED for s in model.slots if s.index in awaited)
        if awaited and possible and not _is_renewed(slot, filled, model):
            yield slot.index, awaited[0]


def _reached(
    start: Slot, slots: Sequence[Slot], limits: Sequence[Sequence[int]]
) -> dict[int, None]:
    filled = {start.index: None}
    waiting = [start]
    while waiting:
        slot = waiting.pop()
        for other in slots:
            is_near = bool(slot.neighbours & 1 << other.index)
            is_limited = limits[slot.index][other.index] < UNBOUNDED
            if is_near and is_limited and other.index not in filled:
                filled[other.index] = None
                waiting.append(other)
    return filled


def _is_renewed(start: Slot, filled: dict[int, None], model: Model) -> bool:
    """Return whether an instance with these slots filled ends when a like one begins."""
    limits = model.limits
    near = [
        i
        for i in filled
        if limits[i][start.index] < UNBOUNDED and limits[start.index][i] < UNBOUNDED
    ]
    return any(
        _ends_with_next(model.slots[counter.begin], counter)
        for counter in model.counters
        if counter.begin in near and counter.end not in filled
    )


def _ends_with_next(slot: Slot, counter: Counter) -> bool:
    """Return whether *counter* forbids the next event that would fill *slot* the same way."""
    if counter.most != 0 or counter.begin_offset > INSTANT:
        return False
    kept, forbidden = slot.pattern.event_type, counter.pattern.event_type
    same = kept.name == forbidden.name and len(kept.arguments) == len(forbidden.arguments)
    if not same or not all(map(_includes, forbidden.arguments, kept.arguments)):
        return False
    return _ends_with_next_change(kept, forbidden)


def _ends_with_next_change(kept: EventType, forbidden: EventType) -> bool:
    """Return whether the change that is forbidden must come before *kept* can come again."""
    if kept.change is None or forbidden.change is None:
        return kept.change is forbidden.change
    again = _includes(forbidden.change.before, kept.change.before) and _includes(
        forbidden.change.after, kept.change.after
    )
    leaves = _includes(forbidden.change.before, kept.change.after)
    return again or (leaves and isinstance(forbidden.change.after, Anything))


def _includes(wider: Parameter, narrower: Parameter) -> bool:
    """Return whether whatever is *narrower*, with the same values of variables, is *wider*."""
    return isinstance(wider, Anything) or wider == narrower

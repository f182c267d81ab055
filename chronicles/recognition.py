"""Recognise chronicles on-line: events in, recognitions out as soon as they are certain.

The algorithm is that of Heintz (2009), section 8.4, with the choices of meaning that the sources
leave open:

* Time is a sequence of instants of one millisecond; a finer time is rounded down. An instant is a
  set of events: the order in which they are listed does not matter, and equal ones are one.
* A match gives every instant a time and every `?` variable a value so that all predicates hold.
  All matches are reported, unless the chronicle says `report non_overlapping`.
* `occurs` and `noevent` count every event of the stream from the first instant of their interval
  up to but not at the second. An empty or inverted interval holds no event.
* A match is recognised as soon as nothing later can take it back: its last event has come, and
  the clock has reached the end of each counted interval that has an upper limit.
* Only the times of events and `advance` move the clock. The clock at t says that everything
  before t is known; more events at t itself may follow.
* An event before the clock is late: it is left out and counted.
"""

from collections.abc import Iterable

from chronicles.constraints import floor_to_instant
from chronicles.events import Event, Recognition
from chronicles.instances import Agenda, Instance
from chronicles.matching import Handler, Matcher
from chronicles.models import Model
from chronicles.patterns import Values
from chronicles.prospects import PartialInstance, partial_instance
from chronicles.reporting import NonOverlapping
from dyknow.time import TimePoint

__all__ = ["Recogniser"]

_Found = tuple[int, int, Matcher, Instance]
"""When it was recognised, the place of its chronicle, its matcher, and the match."""


class _Route:
    """The handlers of the events of one name."""

    def __init__(self, handlers: list[tuple[str | None, Handler]]) -> None:
        values = {value for value, _ in handlers if value is not None}
        self.by_value = {value: self._of(handlers, value) for value in values}
        self.other = self._of(handlers, None)

    @staticmethod
    def _of(handlers: list[tuple[str | None, Handler]], value: str | None) -> tuple[Handler, ...]:
        return tuple(handler for wanted, handler in handlers if wanted in (None, value))


class Recogniser:
    """Recognises chronicles in a stream of events.

    Args:
        models: The chronicles, as `chronicles.models.models_from_chronicles` prepares them.

    Attributes:
        n_late: How many events were left out because they came too late.
    """

    def __init__(self, models: Iterable[Model]) -> None:
        self.n_late = 0
        self._clock: int | None = None
        self._agenda = Agenda()
        self._found: list[_Found] = []
        self._seen: set[tuple[str, Values, str | None, str | None]] = set()
        self._matchers = [Matcher(model, self._agenda, self._note) for model in models]
        self._place = {matcher: i for i, matcher in enumerate(self._matchers)}
        self._with_counts = [m for m in self._matchers if m.keeps_counts]
        self._reports = {
            matcher: NonOverlapping(matcher, matcher.model.counted_interval)
            for matcher in self._matchers
            if matcher.model.counted_interval is not None
        }
        handlers: dict[str, list[tuple[str | None, Handler]]] = {}
        for matcher in self._matchers:
            for name, value, handler in matcher.handlers():
                handlers.setdefault(name, []).append((value, handler))
        self._routes = {name: _Route(found) for name, found in handlers.items()}

    @property
    def clock(self) -> TimePoint | None:
        """The time before which everything is known; None before the first event."""
        return None if self._clock is None else TimePoint(self._clock)

    @property
    def attributes(self) -> frozenset[str]:
        """The names of the attributes and messages that any chronicle uses."""
        return frozenset(self._routes)

    def push(self, time: TimePoint, events: Iterable[Event]) -> list[Recognition]:
        """Take in *events* that happened at *time* and return what is recognised by then.

        Further events of the same instant may follow in another call. Late events are left out
        and counted in `n_late`.
        """
        now = floor_to_instant(time)
        if self._clock is not None and now < self._clock:
            self.n_late += sum(1 for _ in events)
            return []
        if now != self._clock:
            self._move_clock(now)
        seen, routes = self._seen, self._routes
        for event in events:
            route = routes.get(event.attribute)
            if route is None:
                continue
            value = event.to_value
            fact = (event.attribute, event.arguments, event.from_value, value)
            if fact in seen:
                continue
            seen.add(fact)
            for handle in route.by_value.get(value, route.other):  # type: ignore[arg-type]
                handle(event, now)
        return self._take_found() if self._found else []

    def advance(self, time: TimePoint) -> list[Recognition]:
        """Note that everything before *time* is known and return what is recognised by then.

        A time before the clock changes nothing.
        """
        now = floor_to_instant(time)
        if self._clock is None or now > self._clock:
            self._move_clock(now)
        return self._take_found()

    def next_deadline(self) -> TimePoint | None:
        """Return at which clock time alone next recognises or ends an instance, if ever."""
        due = self._agenda.due()
        return None if due is None else TimePoint(due)

    def partial_instances(self) -> list[PartialInstance]:
        """Return every partial instance with what it still waits for, and until when."""
        clock = self._clock or 0
        return [
            partial_instance(matcher.model, instance, clock)
            for matcher in self._matchers
            for instance in matcher.instances()
        ]

    def size(self) -> int:
        """Return how many instances, deadlines, counted events and reports are kept."""
        n_instances = sum(sum(1 for _ in matcher.instances()) for matcher in self._matchers)
        n_counted = sum(matcher.n_counted() for matcher in self._matchers)
        n_reports = sum(len(report) for report in self._reports.values())
        return n_instances + n_counted + n_reports + len(self._agenda)

    def _note(self, matcher: Matcher, instance: Instance, recognised_at: int) -> None:
        self._found.append((recognised_at, self._place[matcher], matcher, instance))

    def _move_clock(self, now: int) -> None:
        if self._agenda.is_due(now):
            for due, instance in self._agenda.until(now):
                instance.stage.review(instance, due)
        self._clock = now
        self._seen.clear()
        for matcher in self._with_counts:
            matcher.sweep(now)

    def _take_found(self) -> list[Recognition]:
        found = sorted(self._found, key=_order)
        self._found.clear()
        return [
            _recognition(matcher.model, instance, recognised_at)
            for recognised_at, _, matcher, instance in found
            if self._is_reported(matcher, instance)
        ]

    def _is_reported(self, matcher: Matcher, instance: Instance) -> bool:
        report = self._reports.get(matcher)
        if report is None:
            return True
        assert self._clock is not None
        arguments = tuple(_arguments(matcher.model, instance).values())
        return report.admits(arguments, instance.times, self._clock)


def _order(found: _Found) -> tuple[int, int, int, list[int], Values]:
    recognised_at, place, _, instance = found
    return recognised_at, place, max(instance.times), instance.times, instance.values


def _arguments(model: Model, instance: Instance) -> dict[str, str]:
    value_by_name = dict(zip(instance.stage.variables, instance.values, strict=True))
    return {name.removeprefix("?"): value_by_name[name] for name in model.parameters}


def _recognition(model: Model, instance: Instance, recognised_at: int) -> Recognition:
    times = instance.times
    first, last = min(times), max(times)
    if model.counted_interval is not None:
        first, last = (times[slot] for slot in model.counted_interval)
    return Recognition(
        chronicle=model.name,
        arguments=_arguments(model, instance),
        instants={
            **{slot.instant: TimePoint(times[slot.index]) for slot in model.slots},
            **{name: TimePoint(times[at] + by) for name, (at, by) in model.derived.items()},
        },
        events=tuple(event for event in instance.events if event is not None),
        begin=TimePoint(first),
        end=TimePoint(last),
        recognised_at=TimePoint(recognised_at),
    )

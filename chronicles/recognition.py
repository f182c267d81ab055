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
* What is recognised is an event itself, at the time of recognition, for chronicles that name it.
"""

import logging
from collections.abc import Callable, Iterable, Sequence

from chronicles.constraints import floor_to_instant
from chronicles.events import Event, Recognition, event_from_recognition
from chronicles.instances import Agenda, Instance
from chronicles.matching import Handler, Matcher
from chronicles.models import Model
from chronicles.patterns import Values
from chronicles.prospects import EndedInstance, PartialInstance, partial_instance
from chronicles.reporting import NonOverlapping
from dyknow.source_text import nearest_name
from dyknow.time import TimePoint

__all__ = ["Recogniser"]

_logger = logging.getLogger(__name__)

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
        limit: How many partial instances of one chronicle are kept; None for any number. When
            there are more, the oldest are given up, a sixteenth of them at a time.
        on_end: Called with each partial instance that can no longer become complete.

    Attributes:
        n_late: How many events were left out because they came too late.
    """

    def __init__(
        self,
        models: Iterable[Model] = (),
        *,
        limit: int | None = None,
        on_end: Callable[[EndedInstance], None] | None = None,
    ) -> None:
        if limit is not None and limit < 1:
            raise ValueError(f"expected a limit of at least 1 partial instance, found {limit}")
        self.n_late = 0
        self._limit = limit
        self._on_end = on_end
        self._clock: int | None = None
        self._agenda = Agenda()
        self._found: list[_Found] = []
        self._seen: set[tuple[str, Values, str | None, str | None]] = set()
        self._matchers: list[Matcher] = []
        self._reports: dict[Matcher, NonOverlapping] = {}
        self._n_given_up: dict[str, int] = {}
        self.register(models)

    @property
    def clock(self) -> TimePoint | None:
        """The time before which everything is known; None before the first event."""
        return None if self._clock is None else TimePoint(self._clock)

    @property
    def attributes(self) -> frozenset[str]:
        """The names of the attributes and messages that any chronicle uses."""
        return frozenset(self._routes)

    @property
    def n_given_up(self) -> dict[str, int]:
        """How many partial instances were given up because of the limit, by chronicle."""
        return {name: n for name, n in self._n_given_up.items() if n}

    def register(self, models: Iterable[Model]) -> None:
        """Recognise further chronicles in what comes from now on.

        Raises:
            ValueError: A chronicle of this name is recognised already, or the chronicles would
                be made of themselves; none of the models is registered then.
        """
        added = [Matcher(model, self._agenda, self._note) for model in models]
        matchers = [*self._matchers, *added]
        names = [matcher.model.name for matcher in matchers]
        for name in dict.fromkeys(names):
            if names.count(name) > 1:
                raise ValueError(f"chronicle '{name}' is recognised already")
        _levels(matchers)
        for matcher in added:
            matcher.limit = self._limit
            matcher.on_end = self._note_end if self._on_end is not None else None
            matcher.on_given_up = self._note_given_up
            if matcher.model.counted_interval is not None:
                interval = matcher.model.counted_interval
                self._reports[matcher] = NonOverlapping(matcher, interval)
        self._set_matchers(matchers)

    def withdraw(self, name: str) -> None:
        """Stop recognising a chronicle and forget its partial instances.

        Raises:
            ValueError: No chronicle of this name is recognised.
        """
        gone = [matcher for matcher in self._matchers if matcher.model.name == name]
        if not gone:
            known = [matcher.model.name for matcher in self._matchers]
            nearest = nearest_name(name, known)
            hint = f"; did you mean '{nearest}'?" if nearest else ""
            raise ValueError(f"no chronicle called '{name}' is recognised{hint}")
        for matcher in gone:
            matcher.clear()
            self._reports.pop(matcher, None)
        self._set_matchers([matcher for matcher in self._matchers if matcher not in gone])

    def push(self, time: TimePoint, events: Iterable[Event]) -> list[Recognition]:
        """Take in *events* that happened at *time* and return what is recognised by then.

        Further events of the same instant may follow in another call. Late events are left out
        and counted in `n_late`.
        """
        now = floor_to_instant(time)
        recognised: list[Recognition] = []
        if now != self._clock:
            if self._clock is not None and now < self._clock:
                self.n_late += sum(1 for _ in events)
                return []
            if self._agenda.is_due(now):
                self._work_off(now, recognised)
            self._clock = now
            self._seen.clear()
            for matcher in self._with_counts:
                matcher.sweep(now)
        self._handle(events, now)
        if self._found:
            self._take_found(now, recognised)
        return recognised

    def advance(self, time: TimePoint) -> list[Recognition]:
        """Note that everything before *time* is known and return what is recognised by then.

        A time before the clock changes nothing.
        """
        return self.push(time, ()) if self._clock is None or time > self._clock else []

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

    def _set_matchers(self, matchers: list[Matcher]) -> None:
        self._matchers = matchers
        self._place = {matcher: i for i, matcher in enumerate(matchers)}
        self._level = _levels(matchers)
        self._with_counts = [m for m in matchers if m.keeps_counts]
        handlers: dict[str, list[tuple[str | None, Handler]]] = {}
        for matcher in matchers:
            for name, value, handler in matcher.handlers():
                handlers.setdefault(name, []).append((value, handler))
        self._routes = {name: _Route(found) for name, found in handlers.items()}

    def _handle(self, events: Iterable[Event], now: int) -> None:
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
        if self._limit is not None:
            for matcher in self._matchers:
                matcher.keep_to_limit()

    def _work_off(self, now: int, recognised: list[Recognition]) -> None:
        """Let time pass until *now*; what is recognised on the way counts at its own time."""
        due = self._agenda.due()
        while due is not None and due <= now:
            self._clock = due
            self._seen.clear()
            for _, instance in self._agenda.until(due):
                instance.stage.review(instance, due)
            if self._found:
                self._take_found(due, recognised)
            due = self._agenda.due()

    def _note(self, matcher: Matcher, instance: Instance, recognised_at: int) -> None:
        self._found.append((recognised_at, self._place[matcher], matcher, instance))

    def _note_end(self, matcher: Matcher, instance: Instance, reason: str) -> None:
        assert self._on_end is not None
        clock = self._clock or 0
        partial = partial_instance(matcher.model, instance, clock)
        self._on_end(EndedInstance(partial, reason, TimePoint(clock)))

    def _note_given_up(self, matcher: Matcher, n: int) -> None:
        name = matcher.model.name
        total = self._n_given_up[name] = self._n_given_up.get(name, 0) + n
        _logger.warning(
            "chronicle '%s' has more than %d partial instances: gave up the %d oldest (%d in all)",
            name,
            matcher.limit,
            n,
            total,
        )

    def _take_found(self, now: int, recognised: list[Recognition]) -> None:
        """Report the matches found, and let them be events at once, simple chronicles first."""
        while self._found:
            lowest = min(self._level[matcher] for _, _, matcher, _ in self._found)
            found = [f for f in self._found if self._level[f[2]] == lowest]
            self._found = [f for f in self._found if self._level[f[2]] != lowest]
            new = [
                _recognition(matcher.model, instance, recognised_at)
                for recognised_at, _, matcher, instance in sorted(found, key=_order)
                if self._is_reported(matcher, instance)
            ]
            recognised += new
            used = [one for one in new if one.chronicle in self._routes]
            if used:
                self._handle(map(event_from_recognition, used), now)

    def _is_reported(self, matcher: Matcher, instance: Instance) -> bool:
        report = self._reports.get(matcher)
        if report is None:
            return True
        assert self._clock is not None
        arguments = tuple(_arguments(matcher.model, instance).values())
        return report.admits(arguments, instance.times, self._clock)


def _levels(matchers: Sequence[Matcher]) -> dict[Matcher, int]:
    """Return how deep each chronicle is made of other chronicles.

    Raises:
        ValueError: A chronicle is made of itself.
    """
    names = {matcher.model.name for matcher in matchers}
    used = {m: {name for name, _, _ in m.handlers() if name in names} for m in matchers}
    level: dict[Matcher, int] = {}
    done: set[str] = set()
    depth = 0
    while len(level) < len(matchers):
        ready = [m for m in matchers if m not in level and used[m] <= done]
        if not ready:
            listed = ", ".join(f"'{m.model.name}'" for m in matchers if m not in level)
            raise ValueError(f"chronicles are made of themselves: {listed}")
        level.update(dict.fromkeys(ready, depth))
        done.update(matcher.model.name for matcher in ready)
        depth += 1
    return level


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

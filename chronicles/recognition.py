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
from collections.abc import Callable, Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from itertools import count
from typing import cast

from chronicles.constraints import INSTANT
from chronicles.events import LAST_TIME, Event, Recognition, event_from_recognition
from chronicles.instances import Agenda, Instance
from chronicles.matching import Listener, Matcher
from chronicles.models import Model
from chronicles.patterns import Values, projection
from chronicles.prospects import EndedInstance, PartialInstance, partial_instance
from chronicles.reporting import NonOverlapping
from chronicles.routing import Routes, route
from dyknow.source_text import did_you_mean, nearest_name
from dyknow.time import TimePoint

__all__ = ["Recogniser"]

_logger = logging.getLogger(__name__)

_Found = tuple[int, int, Matcher, Instance]
"""When it was recognised, the place of its chronicle, its matcher, and the match."""


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
        self._on_end = on_end
        self._listener = Listener(
            self._note, self._note_end if on_end else None, limit, self._note_excess
        )
        self._clock: int | None = None
        self._agenda = Agenda()
        self._found: list[_Found] = []
        self._seen: set[tuple[str, Values, str | None, str | None]] = set()
        self._untidy: dict[Matcher, None] = {}
        self._matchers: dict[str, Matcher] = {}
        self._place: dict[Matcher, int] = {}
        self._used: set[str] = set()
        self._routes: Routes | None = None
        self._level: dict[Matcher, int] = {}
        self._makers: dict[Matcher, Callable[[Instance, int], Recognition]] = {}
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
        return frozenset(self._used)

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
        added = {}
        for model in models:
            if model.name in self._matchers or model.name in added:
                raise ValueError(f"chronicle '{model.name}' is recognised already")
            added[model.name] = Matcher(model, self._agenda, self._listener)
        uses = {matcher: _names_used(matcher) for matcher in added.values()}
        used = frozenset().union(*uses.values())
        is_simple = not any(name in self._matchers or name in added for name in used)
        if is_simple and not any(name in self._used for name in added):
            level = dict.fromkeys(uses, 0)
        else:
            level = _levels({**self._uses(), **uses}, {**self._matchers, **added})
        self._used |= used
        self._level.update(level)
        self._matchers.update(added)
        self._makers.update((matcher, _maker(matcher.model)) for matcher in uses)
        self._place.update(zip(uses, count(len(self._place)), strict=False))
        for matcher in uses:
            if matcher.model.counted_interval is not None:
                interval = matcher.model.counted_interval
                self._reports[matcher] = NonOverlapping(matcher, interval)
        self._routes = None

    def withdraw(self, name: str) -> None:
        """Stop recognising a chronicle and forget its partial instances.

        Raises:
            ValueError: No chronicle of this name is recognised.
        """
        matcher = self._matchers.pop(name, None)
        if matcher is None:
            hint = did_you_mean(nearest_name(name, self._matchers))
            raise ValueError(f"no chronicle called '{name}' is recognised{hint}")
        matcher.clear()
        self._used = set().union(*self._uses().values())
        for known in (self._makers, self._level, self._reports, self._untidy):
            known.pop(matcher, None)
        self._place = {matcher: i for i, matcher in enumerate(self._matchers.values())}
        self._routes = None

    def push(self, time: TimePoint, events: Iterable[Event]) -> list[Recognition]:
        """Take in *events* that happened at *time* and return what is recognised by then.

        Further events of the same instant may follow in another call. Late events are left out
        and counted in `n_late`.

        Raises:
            ValueError: The time does not have 64 bits.
        """
        now = time - time % INSTANT
        recognised: list[Recognition] = []
        if now != self._clock:
            if self._clock is not None and now < self._clock:
                self.n_late += sum(1 for _ in events)
                return recognised
            if not -LAST_TIME <= now <= LAST_TIME:
                raise ValueError(f"expected a time of 64 bits, found {time} ns")
            if self._agenda.next <= now:
                self._work_off(now, recognised)
            self._clock = now
            self._seen.clear()
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
        listed = (
            partial_instance(matcher.model, instance, clock)
            for matcher in self._matchers.values()
            for instance in matcher.instances()
        )
        return [each for each in listed if each.is_possible(clock)]

    def size(self) -> int:
        """Return how many instances, deadlines, counted events and reports are kept."""
        n_instances = sum(
            sum(1 for _ in matcher.instances()) for matcher in self._matchers.values()
        )
        n_counted = sum(matcher.n_counted() for matcher in self._matchers.values())
        n_reports = sum(len(report) for report in self._reports.values())
        return n_instances + n_counted + n_reports + len(self._agenda)

    def _uses(self) -> dict[Matcher, frozenset[str]]:
        return {matcher: _names_used(matcher) for matcher in self._matchers.values()}

    def _route(self) -> Routes:
        """Return where events go; it is found out when the first comes after a change."""
        if self._routes is None:
            self._routes = route(self._matchers.values())
        return self._routes

    def _handle(self, events: Iterable[Event], now: int) -> None:
        seen, routes = self._seen, self._routes or self._route()
        for event in events:
            to_value = event.to_value
            by_value = routes.get(event.attribute)
            if by_value is None:
                continue
            handlers = by_value.get(to_value) or by_value[None]
            if handlers:
                fact = (event.attribute, event.arguments, event.from_value, to_value)
                if fact not in seen:
                    seen.add(fact)
                    for handle in handlers:
                        handle(event, now)
        if self._untidy:
            self._tidy()

    def _tidy(self) -> None:
        for matcher in self._untidy:
            n = matcher.tidy()
            if n:
                self._note_given_up(matcher, n)
        self._untidy.clear()

    def _work_off(self, now: int, recognised: list[Recognition]) -> None:
        """Let time pass until *now*; what is recognised on the way counts at its own time."""
        agenda = self._agenda
        while agenda.next <= now:
            due, instances = agenda.take()
            self._clock = due
            self._seen.clear()
            for instance in instances:
                instance.stage.review(instance, due)
            if self._found:
                self._take_found(due, recognised)

    def _note(self, matcher: Matcher, instance: Instance, recognised_at: int) -> None:
        self._found.append((recognised_at, self._place[matcher], matcher, instance))

    def _note_excess(self, matcher: Matcher) -> None:
        self._untidy[matcher] = None

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
            self._listener.limit,
            n,
            total,
        )

    def _take_found(self, now: int, recognised: list[Recognition]) -> None:
        """Report the matches found, and let them be events at once, simple chronicles first."""
        while self._found:
            found, self._found = self._found, []
            if len(found) > 1:
                lowest = min(self._level[matcher] for _, _, matcher, _ in found)
                self._found = [f for f in found if self._level[f[2]] != lowest]
                found = sorted((f for f in found if self._level[f[2]] == lowest), key=_order)
            new = []
            for recognised_at, _, matcher, instance in found:
                recognition = self._makers[matcher](instance, recognised_at)
                report = self._reports.get(matcher)
                if report is None or report.admits(recognition, instance.times, now):
                    new.append(recognition)
            recognised += new
            used = [one for one in new if one.chronicle in self._used]
            if used:
                self._handle(map(event_from_recognition, used), now)


def _names_used(matcher: Matcher) -> frozenset[str]:
    patterns = (pattern for pattern, _ in (*matcher.counting, *matcher.filling))
    return frozenset(pattern.event_type.name for pattern in patterns)


def _levels(
    uses: Mapping[Matcher, frozenset[str]], matchers: Mapping[str, Matcher]
) -> dict[Matcher, int]:
    """Return how deep each chronicle is made of other chronicles.

    Raises:
        ValueError: A chronicle is made of itself.
    """
    order = TopologicalSorter(
        {
            matcher: [matchers[name] for name in names if name in matchers]
            for matcher, names in uses.items()
        }
    )
    try:
        order.prepare()
    except CycleError as error:
        listed = ", ".join(sorted({f"'{matcher.model.name}'" for matcher in error.args[1]}))
        raise ValueError(f"chronicles are made of themselves: {listed}") from error
    level: dict[Matcher, int] = {}
    depth = 0
    while order.is_active():
        ready = order.get_ready()
        level.update(dict.fromkeys(ready, depth))
        order.done(*ready)
        depth += 1
    return level


def _order(found: _Found) -> tuple[int, int, int, list[int], Values]:
    recognised_at, place, _, instance = found
    return recognised_at, place, max(instance.times), instance.times, instance.values


def _maker(model: Model) -> Callable[[Instance, int], Recognition]:
    """Return what makes recognitions of the matches of *model*."""
    parameters = tuple(name.removeprefix("?") for name in model.parameters)
    values_of = projection(model.variables, model.parameters)
    names = tuple(slot.instant for slot in model.slots)
    interval = model.counted_interval

    def make(instance: Instance, recognised_at: int) -> Recognition:
        times, values = instance.times, instance.values
        instants = dict(zip(names, times, strict=False))
        for name, (at, by) in model.derived.items():
            instants[name] = times[at] + by
        return Recognition(
            model.name,
            dict(zip(parameters, values_of(values) if values_of else values, strict=True)),
            cast(dict[str, TimePoint], instants),
            cast(tuple[Event, ...], tuple(instance.events)),  # for all slots are filled
            cast(TimePoint, times[interval[0]] if interval else min(times)),
            cast(TimePoint, times[interval[1]] if interval else max(times)),
            cast(TimePoint, recognised_at),
        )

    return make

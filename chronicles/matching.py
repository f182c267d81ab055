"""Exact, incremental matching of one chronicle: its instances begin, go on, complete, or die.

How events join instances is told by `chronicles.joining`; here is what else can happen to an
instance. A forbidden event limits the instant at which its interval ends, at once and in every
instance that it concerns; the limits of the other instants follow, and the agenda lets the
instance die when the clock has passed one of them. Without this, instances would be kept until
their last event comes, only to be refused.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import itemgetter

from chronicles.constraints import INSTANT, NEVER, UNBOUNDED
from chronicles.counting import CountedEvents
from chronicles.events import Event
from chronicles.instances import Agenda, Instance, Stage, Watch
from chronicles.joining import Joiner
from chronicles.models import Counter, Model, Slot
from chronicles.patterns import Values
from chronicles.writing import Recipe

__all__ = ["Handler", "Listener", "Matcher"]

Handler = Callable[[Event, int], None]
"""Takes in an event of the right name, at an instant."""

_Notice = Callable[[Values, int], None]
"""Lets instances react to a counted event with such values, at an instant."""


@dataclass(frozen=True, slots=True)
class Listener:
    """Who is told what becomes of instances.

    Attributes:
        on_match: Called with each match and the time from when on nothing could take it back.
        on_end: Called with each instance that can no longer become complete, and why.
        limit: How many instances are kept of one chronicle; None for any number.
        on_excess: Called when there are more than that, or many stages: it is time to tidy up.
    """

    on_match: "Callable[[Matcher, Instance, int], None]"
    on_end: "Callable[[Matcher, Instance, str], None] | None"
    limit: int | None
    on_excess: "Callable[[Matcher], None]"


class Matcher:
    """The partial instances of one chronicle.

    Args:
        model: The chronicle.
        agenda: Where instances that time decides about are put.
        listener: Who is told what becomes of them.

    Attributes:
        model: The chronicle.
        counting: A handler for each counter, with the event type that it is for.
        filling: A handler for each slot likewise. An event counts before it fills a slot.
    """

    def __init__(self, model: Model, agenda: Agenda, listener: Listener) -> None:
        self.model = model
        self._agenda = agenda
        self._listener = listener
        self._notices: dict[Counter, list[_Notice]] = {c: [] for c in model.counters}
        self._counted = {c: CountedEvents(c) for c in model.counters if c.looks_back}
        self._n_instances = 0
        self._joiner = Joiner(model, self._prepare)
        self.counting = [(c.pattern, self._counting(c)) for c in model.counters]
        self.filling = [(s.pattern, self._filling(s)) for s in model.slots]

    def instances(self) -> Iterator[Instance]:
        """Yield all partial instances."""
        for stage in self._joiner.stages.values():
            yield from stage.members()

    def clear(self) -> None:
        """Forget all instances."""
        for instance in list(self.instances()):
            self._remove(instance)

    def n_counted(self) -> int:
        """Return how many counted events are kept."""
        return sum(counted.n_times for counted in self._counted.values())

    def earliest_begin(self, slot: int, clock: int, offset: int = 0) -> int:
        """Return before which time no instance, present or future, has *offset* from *slot*."""
        earliest = clock + min(offset, 0)
        for stage in self._joiner.stages.values():
            if slot >= len(self.model.slots):
                for instance in stage.members():
                    first = min([instance.times[i] for i in stage.filled])
                    earliest = min(earliest, first + offset)
            elif stage.mask & 1 << slot:
                for instance in stage.members():
                    earliest = min(earliest, instance.times[slot] + offset)
        return earliest

    def tidy(self) -> int:
        """Give up the oldest instances if there are more than the limit; return how many.

        Forgets stages without instances too. No event may be on its way through the handlers.
        """
        n = self._keep_to_limit()
        if self._joiner.is_crowded:
            self._joiner.forget_empty_stages()
            for notices in self._notices.values():
                notices.clear()
            for stage in self._joiner.stages.values():
                self._add_notices(stage)
        return n

    def _keep_to_limit(self) -> int:
        limit = self._listener.limit
        if limit is None or self._n_instances <= limit:
            return 0
        n = self._n_instances - limit + limit // 16
        oldest = sorted(self.instances(), key=_age)[:n]
        for instance in oldest:
            self._end(instance, "limit")
        return len(oldest)

    # Events that fill slots.

    def _filling(self, slot: Slot) -> Handler:
        recipes = self._joiner.recipes[slot.index]
        match = slot.pattern.match
        fill = _fill_once(match, recipes) if slot.pattern.loose else _fill(match, recipes)
        earliest = slot.earliest if slot.earliest > -UNBOUNDED else -NEVER
        latest = slot.latest if slot.latest < UNBOUNDED else NEVER
        is_windowed = earliest > -NEVER or latest < NEVER
        return _within(fill, earliest, latest) if is_windowed else fill

    # Instances.

    def _prepare(self, stage: Stage) -> None:
        """Make a new stage ready for instances."""
        self._add_notices(stage)
        if self._joiner.is_crowded:
            self._listener.on_excess(self)
        if stage.is_complete:
            stage.admit, stage.review = self._completion(), self._judge
            return
        stage.admit, stage.review = self._admission(stage), self._expiry(stage)
        looks_back = any(watch.counter.looks_back for watch in stage.watches)
        if self._listener.limit is None and not looks_back:
            stage.schedule = self._agenda.schedule

    def _add_notices(self, stage: Stage) -> None:
        for watch in stage.watches:
            self._notices[watch.counter].append(self._noticing(stage, watch))

    def _admission(self, stage: Stage) -> Callable[[Instance, int], None]:
        """Return what takes in a new instance, unless it is dead already."""
        looking_back = tuple(watch for watch in stage.watches if watch.counter.looks_back)
        earliest = _earliest_of(stage.awaited)

        def admit(instance: Instance, now: int) -> None:
            for watch in looking_back:
                if not self._look_back(watch, instance, now):
                    return
            deadline = earliest(instance.times)
            if deadline >= now:
                self._add(instance)
                if deadline < NEVER:
                    self._agenda.schedule(instance, deadline + INSTANT)

        return admit

    def _completion(self) -> Callable[[Instance, int], None]:
        """Return what decides about an instance all of whose slots have just been filled."""
        counters, on_match = self.model.counters, self._listener.on_match
        if self.model.extremes or any(counter.looks_back for counter in counters):
            return self._complete
        ends = tuple((counter.end, counter.end_offset) for counter in counters)

        def complete(instance: Instance, now: int) -> None:
            times = instance.times
            for end, offset in ends:
                if times[end] + offset > now:
                    self._complete(instance, now)
                    return
            on_match(self, instance, now)

        return complete

    def _expiry(self, stage: Stage) -> Callable[[Instance, int], None]:
        """Return what forgets an instance whose deadline has passed."""
        listener = self._listener
        if listener.on_end is None and listener.limit is None:
            remove = stage.remove
            return lambda instance, _clock: remove(instance)
        return lambda instance, _clock: self._end(instance, "deadline")

    def _look_back(self, watch: Watch, instance: Instance, now: int) -> bool:
        """Apply the events that have been counted already; return whether that leaves it alive."""
        counter = watch.counter
        begin = instance.times[counter.begin] + counter.begin_offset
        excess = self._excess(watch, instance, begin)
        return excess is None or self._limit_end(watch, instance, excess, now)

    def _limit_end(self, watch: Watch, instance: Instance, excess: int, now: int) -> bool:
        """End the interval of a counter at *excess* at the latest.

        Returns whether the instance can still become complete.
        """
        counter = watch.counter
        end = counter.end
        if watch.end_known:
            return instance.times[end] + counter.end_offset <= excess
        bound = excess - counter.end_offset
        times = instance.times
        if bound >= times[end]:
            return True
        times[end] = bound
        for i, limit in self._reach(end, instance.stage):
            times[i] = min(times[i], bound + limit)
        return min([times[i] for i in instance.stage.awaited]) >= now

    def _reach(self, end: int, stage: Stage) -> tuple[tuple[int, int], ...]:
        """Return which open slots the end of an interval limits, and how much later they are."""
        limits = self.model.limits[end]
        return tuple((i, limits[i]) for i in stage.open if i != end and limits[i] < UNBOUNDED)

    def _add(self, instance: Instance) -> None:
        instance.stage.add(instance)
        self._n_instances += 1
        limit = self._listener.limit
        if limit is not None and self._n_instances > limit:
            self._listener.on_excess(self)

    def _end(self, instance: Instance, reason: str) -> None:
        """Remove an instance that can no longer become complete."""
        if self._listener.on_end is not None:
            self._listener.on_end(self, instance, reason)
        self._remove(instance)

    def _remove(self, instance: Instance) -> None:
        self._n_instances -= 1
        instance.stage.remove(instance)
        self._agenda.withdraw(instance)

    # Events that count.

    def _counting(self, counter: Counter) -> Handler:
        pattern = counter.pattern
        match = pattern.match
        notices = self._notices[counter]
        counted = self._counted.get(counter)

        def count(event: Event, now: int) -> None:
            values = match(event)
            if values is None:
                return
            if counted is not None:
                if counted.is_full:
                    begin = self.earliest_begin(counter.begin, now, counter.begin_offset)
                    counted.forget_before(begin)
                counted.add(values, now)
            for notice in notices:
                notice(values, now)

        return count

    def _noticing(self, stage: Stage, watch: Watch) -> _Notice:
        """Return what lets the instances of *stage* react to the events of a counter."""
        index = watch.index
        if not (stage.is_complete or watch.end_known or watch.counter.looks_back):
            return self._forbidding(stage, watch)

        def notice(values: Values, now: int) -> None:
            bucket = index.get(values)
            if bucket is not None:
                for instance in list(bucket):
                    self._notice(watch, instance, now)

        return notice

    def _forbidding(self, stage: Stage, watch: Watch) -> _Notice:
        """Return what ends the intervals in which nothing may happen: the usual case."""
        index, counter = watch.index, watch.counter
        begin, begin_offset, end = counter.begin, counter.begin_offset, counter.end
        reach = self._reach(end, stage)
        earliest = _earliest_of(stage.awaited)
        schedule = self._agenda.schedule

        def forbid(values: Values, now: int) -> None:
            bucket = index.get(values)
            if bucket is None:
                return
            bound = now - counter.end_offset
            for instance in list(bucket):
                times = instance.times
                if bound >= times[end] or now < times[begin] + begin_offset:
                    continue
                times[end] = bound
                for i, limit in reach:
                    times[i] = min(times[i], bound + limit)
                due = earliest(times) + INSTANT
                if due <= now:
                    self._end(instance, _excess_of(counter))
                elif due != instance.due:
                    schedule(instance, due)

        return forbid

    def _notice(self, watch: Watch, instance: Instance, now: int) -> None:
        """Let *instance* react to a counted event at *now*."""
        counter = watch.counter
        begin = instance.times[counter.begin] + counter.begin_offset
        if now < begin:
            return
        if instance.stage.is_complete:
            self._notice_last(watch, instance, now)
            return
        excess = self._excess(watch, instance, begin) if counter.looks_back else now
        if excess is None:
            return
        if not self._limit_end(watch, instance, excess, now):
            self._end(instance, _excess_of(counter))
            return
        deadline = min([instance.times[i] for i in instance.stage.awaited])
        if deadline < NEVER and deadline + INSTANT != instance.due:
            self._agenda.schedule(instance, deadline + INSTANT)

    def _notice_last(self, watch: Watch, instance: Instance, now: int) -> None:
        """Let an instance all of whose slots are filled react to a counted event at *now*."""
        counter = watch.counter
        if counter.looks_back:
            self._judge(instance, now)
        elif now < instance.times[counter.end] + counter.end_offset:
            self._end(instance, _excess_of(counter))

    def _excess(self, watch: Watch, instance: Instance, begin: int) -> int | None:
        """Return when the first event from *begin* on came that is one too many, if it has."""
        counter = watch.counter
        assert counter.most is not None
        return self._counted[counter].nth(watch.key_of(instance), begin, counter.most)

    # Matches.

    def _complete(self, instance: Instance, now: int) -> None:
        """Decide about an instance all of whose slots are filled for the first time."""
        model = self.model
        if model.extremes:
            instance.times += [extreme.time(instance.times) for extreme in model.extremes]
            if not _pass(model.tests, instance.times):
                return
        if not model.counters:
            self._listener.on_match(self, instance, now)
            return
        self._add(instance)
        self._judge(instance, now)

    def _judge(self, instance: Instance, clock: int) -> None:
        """Recognise, keep waiting, or kill an instance all of whose slots are filled."""
        settled_at = max(instance.times)
        ends = []
        for watch in instance.stage.watches:
            settled, end = self._standing(watch, instance, clock)
            if settled is not None:
                settled_at = max(settled_at, settled)
            elif end > clock:
                ends.append(end)
            else:
                self._end(instance, self._failure(watch, instance))
                return
        if ends:
            due = min(ends)
            if due != instance.due:
                self._agenda.schedule(instance, due)
            return
        self._remove(instance)
        self._listener.on_match(self, instance, settled_at)

    def _failure(self, watch: Watch, instance: Instance) -> str:
        """Return why the counter of *watch* fails."""
        counter = watch.counter
        begin = instance.times[counter.begin] + counter.begin_offset
        end = instance.times[counter.end] + counter.end_offset
        counted = self._counted.get(counter)
        n = 0 if counted is None else counted.count(watch.key_of(instance), begin, end)
        return "too few events" if n < counter.least else _excess_of(counter)

    def _standing(self, watch: Watch, instance: Instance, clock: int) -> tuple[int | None, int]:
        """Return since when the counter is settled, and the end of its interval.

        If it is not settled, it fails unless the end is after *clock*.
        """
        counter = watch.counter
        begin = instance.times[counter.begin] + counter.begin_offset
        end = instance.times[counter.end] + counter.end_offset
        never = (None, clock)
        if end <= begin:
            return never if counter.least else (max(instance.times), end)
        key = watch.key_of(instance)
        counted = self._counted.get(counter)
        n = counted.count(key, begin, end) if counted is not None else 0
        if counter.most is None:
            enough = n >= counter.least
            if not enough or counted is None or not counter.least:
                return (max(instance.times) if enough else None, end)
            return (counted.nth(key, begin, counter.least - 1), end)
        if n > counter.most:
            return never
        if end > clock:
            return (None, end)
        return (end, end) if n >= counter.least else never


def _earliest_of(places: tuple[int, ...]) -> Callable[[list[int]], int]:
    """Return a function that finds the least of the numbers at some places of a list."""
    pick = itemgetter(*places)
    return pick if len(places) == 1 else lambda numbers: min(pick(numbers))


def _age(instance: Instance) -> int:
    return min(instance.times[i] for i in instance.stage.filled)


def _excess_of(counter: Counter) -> str:
    return "too many events" if counter.most else "forbidden event"


def _pass(tests: Iterable[tuple[int, int, int]], times: Sequence[int]) -> bool:
    """Return whether *times* are as far apart as *tests* ask for."""
    with_zero = [*times, 0]
    return all(with_zero[later] - with_zero[at] <= limit for later, at, limit in tests)


def _fill(match: Callable[[Event], Values | None], recipes: list[Recipe]) -> Handler:
    def fill(event: Event, now: int) -> None:
        values = match(event)
        if values is not None:
            for recipe in recipes:
                recipe(event, now, values)

    return fill


def _within(fill: Handler, earliest: int, latest: int) -> Handler:
    def fill_within(event: Event, now: int) -> None:
        if earliest <= now <= latest:
            fill(event, now)

    return fill_within


def _fill_once(match: Callable[[Event], Values | None], recipes: list[Recipe]) -> Handler:
    """Return a handler to which all events of one instant with the same values are one."""
    seen: set[Values] = set()
    seen_at: int | None = None

    def fill(event: Event, now: int) -> None:
        nonlocal seen_at
        values = match(event)
        if values is None:
            return
        if now != seen_at:
            seen.clear()
            seen_at = now
        if values not in seen:
            seen.add(values)
            for recipe in recipes:
                recipe(event, now, values)

    return fill

"""Exact, incremental matching of one chronicle: its instances begin, go on, complete, or die.

How events join instances is told by `chronicles.joining`; here is what else can happen to an
instance. A forbidden event limits the instant at which its interval ends, at once and in every
instance that it concerns; the limits of the other instants follow, and the agenda lets the
instance die when the clock has passed one of them. Without this, instances would be kept until
their last event comes, only to be refused.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence

from chronicles.constraints import INSTANT, UNBOUNDED
from chronicles.counting import CountedEvents
from chronicles.events import Event
from chronicles.instances import Agenda, Instance, Stage, Watch
from chronicles.joining import Joiner, Recipe
from chronicles.models import Counter, Model, Slot
from chronicles.patterns import Values, key_of

__all__ = ["Handler", "Matcher"]

Handler = Callable[[Event, int], None]
"""Takes in an event of the right name, at an instant."""

_LEAST_TO_SWEEP = 1024


class Matcher:
    """The partial instances of one chronicle.

    Args:
        model: The chronicle.
        agenda: Where instances that time decides about are put.
        on_match: Called with each match and the time from when on nothing could take it back.

    Attributes:
        model: The chronicle.
        limit: How many instances are kept; None for any number.
        on_end: Called with each instance that can no longer become complete, and why.
        on_given_up: Called with how many of the oldest instances were given up.
    """

    def __init__(
        self, model: Model, agenda: Agenda, on_match: Callable[["Matcher", Instance, int], None]
    ) -> None:
        self.model = model
        self._agenda = agenda
        self._on_match = on_match
        self._watches: dict[Counter, list[Watch]] = {c: [] for c in model.counters}
        self._counted = {c: CountedEvents(c) for c in model.counters if c.looks_back}
        self._sweep_at = _LEAST_TO_SWEEP
        self._n_instances = 0
        self.limit: int | None = None
        self.on_end: Callable[[Matcher, Instance, str], None] | None = None
        self.on_given_up: Callable[[Matcher, int], None] | None = None
        self._joiner = Joiner(model, self._new_stage, self._admit)

    def handlers(self) -> Iterator[tuple[str, str | None, Handler]]:
        """Yield a handler for each predicate with the name and value of its events.

        An event is given to the handlers in this order: it counts before it is used.
        """
        for counter in self.model.counters:
            pattern = counter.pattern
            yield pattern.event_type.name, pattern.to_value, self._counting(counter)
        for slot in self.model.slots:
            yield slot.pattern.event_type.name, slot.pattern.to_value, self._filling(slot)

    def instances(self) -> Iterator[Instance]:
        """Yield all partial instances."""
        for stage in self._joiner.stages.values():
            yield from stage.members

    def clear(self) -> None:
        """Forget all instances."""
        for instance in list(self.instances()):
            self._remove(instance)

    @property
    def keeps_counts(self) -> bool:
        """Whether `sweep` does anything."""
        return bool(self._counted)

    def n_counted(self) -> int:
        """Return how many counted events are kept."""
        return sum(counted.n_times for counted in self._counted.values())

    def earliest_begin(self, slot: int, clock: int, offset: int = 0) -> int:
        """Return before which time no instance, present or future, has *offset* from *slot*."""
        earliest = clock + min(offset, 0)
        for stage in self._joiner.stages.values():
            if slot >= len(self.model.slots):
                for instance in stage.members:
                    first = min([instance.times[i] for i in stage.filled])
                    earliest = min(earliest, first + offset)
            elif stage.mask & 1 << slot:
                for instance in stage.members:
                    earliest = min(earliest, instance.times[slot] + offset)
        return earliest

    def sweep(self, clock: int) -> None:
        """Forget counted events that no instance can ask for, once in a while."""
        if self._counted and self.n_counted() > self._sweep_at:
            for counter, counted in self._counted.items():
                begin = self.earliest_begin(counter.begin, clock, counter.begin_offset)
                counted.forget_before(begin)
            self._sweep_at = max(_LEAST_TO_SWEEP, 2 * self.n_counted())

    # Events that fill slots.

    def _filling(self, slot: Slot) -> Handler:
        recipes = self._joiner.recipes[slot.index]
        match = slot.pattern.match
        fill = _fill_once(match, recipes) if slot.pattern.loose else _fill(match, recipes)
        if slot.earliest > -UNBOUNDED or slot.latest < UNBOUNDED:
            return _within(fill, slot.earliest, slot.latest)
        return fill

    def _new_stage(self, mask: int) -> Stage:
        stage = Stage(self.model, mask, self._review)
        for watch in stage.watches:
            self._watches[watch.counter].append(watch)
        return stage

    # Instances.

    def _review(self, instance: Instance, clock: int) -> None:
        """Decide about an instance that is due."""
        if not instance.stage.is_complete:
            self._end(instance, "deadline")
        else:
            self._judge(instance, clock)

    def _admit(self, instance: Instance, now: int) -> None:
        """Take in a new instance, unless it is dead or complete already."""
        stage = instance.stage
        if stage.is_complete:
            self._complete(instance, now)
            return
        latest = instance.latest
        for watch in stage.watches:
            if watch.counter.looks_back and not self._look_back(watch, instance, now):
                return
        deadline = min([latest[i] for i in stage.awaited])
        if deadline < now:
            return
        self._add(instance)
        if deadline < UNBOUNDED:
            self._agenda.schedule(instance, deadline + INSTANT)

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
        latest = instance.latest
        bound = excess - counter.end_offset
        if bound >= latest[end]:
            return True
        latest[end] = bound
        limits = self.model.limits[end]
        for i in instance.stage.open:
            if limits[i] < UNBOUNDED and bound + limits[i] < latest[i]:
                latest[i] = bound + limits[i]
        return min([latest[i] for i in instance.stage.awaited]) >= now

    def _add(self, instance: Instance) -> None:
        self._n_instances += 1
        stage = instance.stage
        stage.add(instance)
        for watch in stage.watches:
            stage.watch(watch, watch.key(instance.values), instance)

    def keep_to_limit(self) -> None:
        """Give up the oldest instances if there are more than the limit."""
        if self.limit is None or self._n_instances <= self.limit:
            return
        n = self._n_instances - self.limit + self.limit // 16
        oldest = sorted(self.instances(), key=_age)[:n]
        for instance in oldest:
            self._end(instance, "limit")
        if self.on_given_up is not None:
            self.on_given_up(self, len(oldest))

    def _end(self, instance: Instance, reason: str) -> None:
        """Remove an instance that can no longer become complete."""
        if self.on_end is not None:
            self.on_end(self, instance, reason)
        self._remove(instance)

    def _remove(self, instance: Instance) -> None:
        self._n_instances -= 1
        instance.stage.remove(instance)
        self._agenda.withdraw(instance)

    # Events that count.

    def _counting(self, counter: Counter) -> Handler:
        pattern = counter.pattern
        match = pattern.match
        key = key_of(pattern.variables, pattern.variables)
        watches = self._watches[counter]
        counted = self._counted.get(counter)

        def count(event: Event, now: int) -> None:
            values = match(event)
            if values is None:
                return
            place = key(values)
            if counted is not None:
                counted.add(place, now)
            for watch in watches:
                bucket = watch.index.get(place)
                if bucket is not None:
                    for instance in list(bucket):
                        self._notice(watch, instance, now)

        return count

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
        due = min([instance.latest[i] for i in instance.stage.awaited]) + INSTANT
        if due < UNBOUNDED and due != instance.due:
            self._agenda.schedule(instance, due)

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
        return self._counted[counter].nth(watch.key(instance.values), begin, counter.most)

    # Matches.

    def _complete(self, instance: Instance, now: int) -> None:
        """Decide about an instance all of whose slots are filled for the first time."""
        model = self.model
        if model.extremes:
            instance.times += [extreme.time(instance.times) for extreme in model.extremes]
            if not _pass(model.tests, instance.times):
                return
        if not model.counters:
            self._on_match(self, instance, now)
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
        self._on_match(self, instance, settled_at)

    def _failure(self, watch: Watch, instance: Instance) -> str:
        """Return why the counter of *watch* fails."""
        counter = watch.counter
        begin = instance.times[counter.begin] + counter.begin_offset
        end = instance.times[counter.end] + counter.end_offset
        counted = self._counted.get(counter)
        n = 0 if counted is None else counted.count(watch.key(instance.values), begin, end)
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
        key = watch.key(instance.values)
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

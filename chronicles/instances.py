"""Partial instances: what has been seen, what is still possible and until when.

All partial instances that have seen events for the same slots are at the same *stage*. A stage
finds its instances by the values of the variables that they share with a slot they wait for, and
by the values that a counted or forbidden event must have.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from chronicles.events import Event
from chronicles.models import Counter, Model
from chronicles.patterns import Values, key_of

__all__ = [
    "Agenda",
    "Bucket",
    "Index",
    "Instance",
    "Stage",
    "Watch",
]


class Instance:
    """A partial instance as the recogniser keeps it.

    Attributes:
        stage: Which slots have been filled.
        values: Of the variables of the stage.
        times: For each slot the time of its event, 0 while it is open.
        events: For each slot its event.
        latest: For each slot the latest time at which it can be filled.
        due: When the agenda looks at it; None if it never needs to.
    """

    __slots__ = ("due", "events", "latest", "stage", "times", "values")

    def __init__(
        self,
        stage: "Stage",
        values: Values,
        times: list[int],
        events: list[Event | None],
        latest: list[int],
    ) -> None:
        self.stage = stage
        self.values = values
        self.times = times
        self.events = events
        self.latest = latest
        self.due: int | None = None


Bucket = dict[Instance, None]
"""A set of instances that keeps the order in which they came."""

Index = dict[Values | str, Bucket]
"""Instances by the values of some of their variables."""


@dataclass(frozen=True, slots=True)
class Watch:
    """How a stage reacts to the events of one counter.

    Attributes:
        counter: The counter.
        index: The instances that watch it, by the values of its variables.
        key: From the values of an instance to its key in the index.
        end_known: Whether the slot at which the interval ends is filled at this stage.
    """

    counter: Counter
    index: Index
    key: Callable[[Values], Values | str]
    end_known: bool


class Stage:
    """All partial instances that have filled the same slots.

    Attributes:
        mask: The filled slots, as a set of bits.
        near: The slots next to them, as a set of bits.
        filled: The filled slots.
        open: The other slots.
        awaited: Those of the open slots that have a variable in common with the filled ones. An
            event for one of these can only come later: had it come before, the instance would
            hold it. An event for another one may already be held by another instance.
        is_complete: Whether no slot is open.
        variables: The variables of the filled slots.
        review: What decides about an instance that is due at a time.
        watches: The counters whose events matter to these instances.
        members: The instances.
    """

    def __init__(self, model: Model, mask: int, review: Callable[["Instance", int], None]) -> None:
        slots = model.slots
        near = 0
        for slot in slots:
            if mask & 1 << slot.index:
                near |= slot.neighbours
        self.mask = mask
        self.review = review
        self.near = near
        self.filled = tuple(s.index for s in slots if mask & 1 << s.index)
        self.open = tuple(s.index for s in slots if not mask & 1 << s.index)
        self.awaited = tuple(i for i in self.open if near & 1 << i)
        self.is_complete = not self.open
        bound = {name for i in self.filled for name in slots[i].pattern.variables}
        self.variables = tuple(name for name in model.variables if name in bound)
        self.watches = tuple(
            Watch(c, {}, key_of(self.variables, c.pattern.variables), self.knows(c.end))
            for c in model.counters
            if self.knows(c.begin)
            and bound.issuperset(c.pattern.variables)
            and (self.is_complete or (c.most is not None and c.end < len(slots)))
        )
        self.members: Bucket = {}
        self._indexes: dict[tuple[str, ...], Index] = {}
        self._entries: list[tuple[Index, Callable[[Values], Values | str]]] = []

    def knows(self, place: int) -> bool:
        """Return whether the time at *place*, of a slot or an extreme, is known."""
        return self.is_complete or bool(self.mask & 1 << place)

    def index_by(self, variables: tuple[str, ...]) -> Index:
        """Return the index of the instances by the values of *variables*.

        It is made when it is first asked for, which must be before the first instance comes.
        """
        index = self._indexes.get(variables)
        if index is None:
            index = self._indexes[variables] = {}
            self._entries.append((index, key_of(self.variables, variables)))
        return index

    def add(self, instance: Instance) -> None:
        """Take in *instance*."""
        self.members[instance] = None
        for index, key in self._entries:
            _put(index, key(instance.values), instance)

    def remove(self, instance: Instance) -> None:
        """Forget *instance* and every entry about it."""
        del self.members[instance]
        for index, key in self._entries:
            _drop(index, key(instance.values), instance)
        for watch in self.watches:
            _drop(watch.index, watch.key(instance.values), instance)

    @staticmethod
    def watch(watch: Watch, key: Values | str, instance: Instance) -> None:
        """Let *instance* react to the events of the counter of *watch* that have *key*."""
        _put(watch.index, key, instance)


class Agenda:
    """The instances in the order in which time alone will decide about them."""

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, Instance]] = []
        self._n_scheduled = 0
        self._n_stale = 0

    def __len__(self) -> int:
        return len(self._heap)

    def schedule(self, instance: Instance, due: int) -> None:
        """Look at *instance* when the clock reaches *due*, and not before."""
        if instance.due is not None:
            self._n_stale += 1
        instance.due = due
        self._n_scheduled += 1
        heappush(self._heap, (due, self._n_scheduled, instance))

    def withdraw(self, instance: Instance) -> None:
        """Note that *instance* has died."""
        if instance.due is not None:
            instance.due = None
            self._n_stale += 1
            if self._n_stale > 64 + len(self._heap) // 2:
                self._tidy()

    def due(self) -> int | None:
        """Return when the next instance is due, if any is."""
        heap = self._heap
        while heap and heap[0][0] != heap[0][2].due:
            heappop(heap)
            self._n_stale -= 1
        return heap[0][0] if heap else None

    def is_due(self, clock: int) -> bool:
        """Return whether `until` has anything to look at."""
        return bool(self._heap) and self._heap[0][0] <= clock

    def until(self, clock: int) -> Iterator[tuple[int, Instance]]:
        """Yield the instances that are due up to *clock*, in order, and when they were."""
        heap = self._heap
        while heap and heap[0][0] <= clock:
            due, _, instance = heappop(heap)
            if instance.due == due:
                instance.due = None
                yield due, instance
            else:
                self._n_stale -= 1

    def _tidy(self) -> None:
        self._heap[:] = [entry for entry in self._heap if entry[2].due == entry[0]]
        heapify(self._heap)
        self._n_stale = 0


def _put(index: Index, key: Values | str, instance: Instance) -> None:
    bucket = index.get(key)
    if bucket is None:
        index[key] = {instance: None}
    else:
        bucket[instance] = None


def _drop(index: Index, key: Values | str, instance: Instance) -> None:
    bucket = index.get(key)
    if bucket is not None and instance in bucket:
        if len(bucket) == 1:
            del index[key]
        else:
            del bucket[instance]

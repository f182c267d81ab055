"""Partial instances: what has been seen, what is still possible and until when.

All partial instances that have seen events for the same slots are at the same *stage*. A stage
finds its instances by the values of the variables that they share with a slot they wait for, and
by the values that a counted or forbidden event must have.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from chronicles.constraints import NEVER
from chronicles.events import Event
from chronicles.models import Counter, Model
from chronicles.patterns import Values, projection

__all__ = ["Agenda", "Bucket", "Entry", "Index", "Instance", "Key", "Stage", "Watch"]


class Instance:
    """A partial instance as the recogniser keeps it.

    Attributes:
        stage: Which slots have been filled.
        values: Of the variables of the stage.
        times: For each slot the time of its event, or while it is open, the latest time at which
            it can be filled.
        events: For each slot its event, None while it is open.
        due: When the agenda looks at it; None if it never needs to.
    """

    __slots__ = ("due", "events", "stage", "times", "values")

    def __init__(
        self,
        stage: "Stage",
        values: Values,
        times: list[int],
        events: list[Event | None],
    ) -> None:
        self.stage = stage
        self.values = values
        self.times = times
        self.events = events
        self.due: int | None = None


Bucket = dict[Instance, None]
"""A set of instances that keeps the order in which they came."""

Index = dict[Values, Bucket]
"""Instances by the values of some of their variables."""

Key = Callable[[Values], Values]
"""From the values of an instance to those that it is found by."""

Entry = tuple[Index, Key | None]
"""An index, and how instances are found by it; None if by all their values."""

_Change = Callable[[Instance], None]


@dataclass(frozen=True, slots=True)
class Watch:
    """How a stage reacts to the events of one counter.

    Attributes:
        counter: The counter.
        index: The instances that watch it, by the values of its variables.
        key: From the values of an instance to its key in the index; None if they are the same.
        end_known: Whether the slot at which the interval ends is filled at this stage.
    """

    counter: Counter
    index: Index
    key: Key | None
    end_known: bool

    def key_of(self, instance: Instance) -> Values:
        """Return the values by which *instance* is found."""
        return self.key(instance.values) if self.key else instance.values


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
        watches: The counters whose events matter to these instances.
        add: Takes in an instance; there is none before `seal`.
        remove: Forgets an instance and every entry about it.
        entries: The indexes, each with what finds the key of an instance; none before `seal`.
        admit: Decides about a new instance; set by whom the stage belongs to.
        schedule: What a new instance is given to with the time after its deadline, if that is
            all there is to decide; set likewise.
        review: Decides about an instance that is due at a time; set likewise.
    """

    def __init__(self, model: Model, mask: int) -> None:
        slots = model.slots
        near = 0
        for slot in slots:
            if mask & 1 << slot.index:
                near |= slot.neighbours
        self.mask = mask
        self.near = near
        self.filled = tuple(s.index for s in slots if mask & 1 << s.index)
        self.open = tuple(s.index for s in slots if not mask & 1 << s.index)
        self.awaited = tuple(i for i in self.open if near & 1 << i)
        self.is_complete = not self.open
        bound = {name for i in self.filled for name in slots[i].pattern.variables}
        self.variables = tuple(name for name in model.variables if name in bound)
        self.add: _Change
        self.remove: _Change
        self.entries: tuple[Entry, ...] = ()
        self.schedule: Callable[[Instance, int], None] | None = None
        self.admit: Callable[[Instance, int], None]
        self.review: Callable[[Instance, int], None]
        self._indexes: dict[tuple[str, ...], Entry] = {}
        self.watches = tuple(
            self._watch(counter)
            for counter in model.counters
            if self.knows(counter.begin)
            and bound.issuperset(counter.pattern.variables)
            and (self.is_complete or (counter.most is not None and counter.end < len(model.slots)))
        )

    def knows(self, place: int) -> bool:
        """Return whether the time at *place*, of a slot or an extreme, is known."""
        return self.is_complete or bool(self.mask & 1 << place)

    def index_by(self, variables: tuple[str, ...]) -> Index:
        """Return the index of the instances by the values of *variables*.

        It is made when it is first asked for, which must be before `seal`.
        """
        if variables not in self._indexes:
            assert not self.entries
            self._indexes[variables] = {}, projection(self.variables, variables)
        return self._indexes[variables][0]

    @property
    def is_empty(self) -> bool:
        """Whether there are no instances."""
        return not any(index for index, _ in self.entries)

    def members(self) -> Iterator[Instance]:
        """Yield the instances."""
        for index, _ in self._indexes.values():
            for bucket in index.values():
                yield from bucket
            return

    def _watch(self, counter: Counter) -> Watch:
        variables = counter.pattern.variables
        index = self.index_by(variables)
        key = projection(self.variables, variables)
        return Watch(counter, index, key, self.knows(counter.end))

    def seal(self) -> None:
        """Make ready for the first instance: all indexes have been asked for."""
        if not self._indexes:
            self.index_by(())
        self.entries = tuple(self._indexes.values())
        self.add, self.remove = _adder(self.entries), _remover(self.entries)


class Agenda:
    """The instances in the order in which time alone will decide about them."""

    def __init__(self) -> None:
        self._instances: dict[int, list[Instance]] = {}
        self._times: list[int] = []
        self._n_entries = 0
        self._n_stale = 0

    def __len__(self) -> int:
        return self._n_entries

    @property
    def next(self) -> int:
        """When there may be something to decide: not before the next instance is due."""
        return self._times[0] if self._times else NEVER

    def schedule(self, instance: Instance, due: int) -> None:
        """Look at *instance* when the clock reaches *due*, and not before."""
        if instance.due is not None:
            self._n_stale += 1
        instance.due = due
        self._n_entries += 1
        instances = self._instances.get(due)
        if instances is None:
            self._instances[due] = [instance]
            heappush(self._times, due)
        else:
            instances.append(instance)

    def withdraw(self, instance: Instance) -> None:
        """Note that *instance* has died."""
        if instance.due is not None:
            instance.due = None
            self._n_stale += 1
            if self._n_stale > 64 + self._n_entries // 2:
                self._tidy()

    def due(self) -> int | None:
        """Return when the next instance is due, if any is."""
        while self._times:
            due = self._times[0]
            if any(instance.due == due for instance in self._instances[due]):
                return due
            self.take()
        return None

    def take(self) -> tuple[int, list[Instance]]:
        """Return the earliest time with the instances that are due at it; they no longer are."""
        due = heappop(self._times)
        found = []
        entries = self._instances.pop(due)
        for instance in entries:
            if instance.due == due:
                instance.due = None
                found.append(instance)
        self._n_entries -= len(entries)
        self._n_stale -= len(entries) - len(found)
        return due, found

    def _tidy(self) -> None:
        """Forget the entries of instances that have died or are due at another time."""
        kept: dict[int, list[Instance]] = {}
        for due, entries in self._instances.items():
            live = list(dict.fromkeys(one for one in entries if one.due == due))
            if live:
                kept[due] = live
        self._instances = kept
        self._times = list(kept)
        heapify(self._times)
        self._n_entries = sum(map(len, kept.values()))
        self._n_stale = 0


def _adder(entries: tuple[Entry, ...]) -> _Change:
    if len(entries) > 1:
        adders = [_adder((entry,)) for entry in entries]

        def add_to_all(instance: Instance) -> None:
            for add in adders:
                add(instance)

        return add_to_all
    ((index, key_from),) = entries

    def add(instance: Instance) -> None:
        key = key_from(instance.values) if key_from else instance.values
        bucket = index.get(key)
        if bucket is None:
            index[key] = {instance: None}
        else:
            bucket[instance] = None

    return add


def _remover(entries: tuple[Entry, ...]) -> _Change:
    if len(entries) > 1:
        removers = [_remover((entry,)) for entry in entries]

        def remove_from_all(instance: Instance) -> None:
            for remove in removers:
                remove(instance)

        return remove_from_all
    ((index, key_from),) = entries

    def remove(instance: Instance) -> None:
        key = key_from(instance.values) if key_from else instance.values
        bucket = index[key]
        if len(bucket) > 1:
            del bucket[instance]
        else:
            del index[key]

    return remove

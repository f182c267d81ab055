"""Stream generators: where the samples of a process come out and its streams begin."""

from collections import deque
from collections.abc import Callable
from typing import Any

from dyknow.runtime.accounts import Account
from dyknow.runtime.agenda import Agenda
from dyknow.runtime.cache import CACHE_SIZE, CachedStream
from dyknow.runtime.names import Label
from dyknow.runtime.statistics import Delays, Statistics
from dyknow.streams.policy import Policy
from dyknow.streams.process import Element
from dyknow.streams.sample import BEGINNING_OF_TIME, Heartbeat, Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["ANYTHING", "Beat", "Label", "Receive", "StreamGenerator"]

ANYTHING = Policy()
"""The policy that restricts nothing."""

Receive = Callable[[Sample[Any]], None]
"""Takes the samples of a stream as they become available."""

Beat = Callable[[Heartbeat], None]
"""Takes the heartbeats of a stream as they become available."""


class StreamGenerator(CachedStream):
    """Hands the samples of one process to everyone who has subscribed.

    Available times are unique in a stream: a sample that would become available no later than
    the one before it is given the next nanosecond. The last few samples are held for queries
    and for streams that begin in the past.

    Attributes:
        label: The name of the generator.
        depth: How many processes lie between it and the sources; 0 for a source.
        output_policy: What its process promises about all that it produces.
        account: What its process has cost and given.
        delays: The delays of all samples that have become available.
        first: The valid time of the first sample that became available.
        complete_until: The valid time up to which its last heartbeat that became available
            promises no more samples; `BEGINNING_OF_TIME` without one.
        last: The last sample that has become available.
        heartbeats: How many heartbeats have become available.
        is_waiting: Whether there are samples that are not available yet.
    """

    __slots__ = (
        "_agenda",
        "_beats",
        "_last_time",
        "_promised",
        "_receivers",
        "_waiting",
        "account",
        "complete_until",
        "delays",
        "depth",
        "first",
        "heartbeats",
        "is_waiting",
        "last",
        "output_policy",
    )

    def __init__(
        self,
        label: Label,
        depth: int,
        agenda: Agenda,
        output_policy: Policy = ANYTHING,
        capacity: int = CACHE_SIZE,
    ) -> None:
        super().__init__(label, capacity)
        self.depth = depth
        self.output_policy = output_policy
        self.account = Account()
        self.delays = Delays()
        self.heartbeats = 0
        self.is_waiting = False
        self.first: TimePoint | None = None
        self.last: Sample[Any] | None = None
        self._agenda = agenda
        self._last_time = TimePoint(-1)
        self.complete_until = BEGINNING_OF_TIME
        self._promised = BEGINNING_OF_TIME
        self._receivers: dict[object, Receive] = {}
        self._beats: dict[object, Beat] = {}
        self._waiting: deque[Element] = deque()

    @property
    def next_release(self) -> TimePoint:
        """When the next of the samples that are waiting will be available."""
        return self._waiting[0].available_time

    @property
    def is_fresh(self) -> bool:
        """Whether nothing has been handed out or promised yet."""
        return self.last is None and self.complete_until == BEGINNING_OF_TIME

    @property
    def statistics(self) -> Statistics:
        """The figures of the whole stream, no policy applied."""
        return Statistics.of(self)

    @property
    def violations(self) -> int:
        """How often its policy could not be kept: it has none."""
        return 0

    @property
    def late(self) -> int:
        """How many samples were left out: none."""
        return 0

    def connect(self, key: object, receive: Receive, beat: Beat | None = None) -> None:
        """Hand all samples from now on to *receive*, and heartbeats to *beat*, if there is one.

        What *key* was connected to before is replaced.
        """
        self._receivers[key] = receive
        self._beats.pop(key, None)
        if beat is not None:
            self._beats[key] = beat

    def disconnect(self, key: object) -> None:
        """Hand nothing more to what *key* was connected to."""
        del self._receivers[key]
        self._beats.pop(key, None)

    def check(self, element: Element) -> None:
        """Raise an error if the process may not produce this now; note what it promises."""
        if isinstance(element, Sample):
            if element.valid_time <= self._promised:
                until = text_from_duration(self._promised)
                valid_time = text_from_duration(element.valid_time)
                raise ValueError(
                    f"a sample valid at {valid_time} after the promise of none up to {until}"
                )
        elif isinstance(element, Heartbeat):
            self._promised = max(self._promised, element.until)
        else:
            raise TypeError(f"expected a sample or a heartbeat, found {element!r}")

    def put(self, element: Element, now: TimePoint) -> None:
        """Take in what the process has produced at *now*; hand it out when it is available."""
        if isinstance(element, Heartbeat):
            self._put_heartbeat(element, now)
            return
        time = element.available_time
        earliest = now if now > self._last_time else TimePoint(self._last_time + 1)
        if time < earliest:
            element = Sample(element.value, element.valid_time, earliest)
            self._agenda.extend(max(time, now), earliest)
            time = earliest
        self._last_time = time
        self.account.samples += 1
        if time <= now:
            self._hand_out(element)
        else:
            self._wait_with(element)

    def release(self, now: TimePoint) -> None:
        """Hand out the samples that have become available by *now*."""
        while self._waiting and self._waiting[0].available_time <= now:
            self._agenda.pending -= 1
            element = self._waiting.popleft()
            if isinstance(element, Heartbeat):
                self._beat(element)
            else:
                self._hand_out(element)
        self.is_waiting = bool(self._waiting)

    def clear(self) -> None:
        """Forget the samples that are not available yet."""
        self._agenda.pending -= len(self._waiting)
        self._waiting.clear()
        self.is_waiting = False

    def _put_heartbeat(self, heartbeat: Heartbeat, now: TimePoint) -> None:
        earliest = max(now, self._last_time)
        if heartbeat.available_time < earliest:
            heartbeat = Heartbeat(heartbeat.until, earliest)
        self._last_time = TimePoint(max(self._last_time, heartbeat.available_time - 1))
        if heartbeat.available_time <= now:
            self._beat(heartbeat)
        else:
            self._wait_with(heartbeat)

    def _wait_with(self, element: Element) -> None:
        self.is_waiting = True
        self._waiting.append(element)
        self._agenda.pending += 1

    def _hand_out(self, sample: Sample[Any]) -> None:
        if self.last is None:
            self.first = sample.valid_time
        self.last = sample
        self.hold(sample)
        self.delays.add(sample.available_time - sample.valid_time)
        for receive in self._receivers.values():
            receive(sample)

    def _beat(self, heartbeat: Heartbeat) -> None:
        self.heartbeats += 1
        self.complete_until = max(self.complete_until, heartbeat.until)
        for beat in self._beats.values():
            beat(heartbeat)

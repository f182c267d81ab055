"""Stream generators: where the samples of a process come out and its streams begin."""

from collections import deque
from collections.abc import Callable
from typing import Any, NewType

from dyknow.runtime.accounts import Account
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["Label", "Receive", "StreamGenerator"]

Label = NewType("Label", str)
"""The name of a stream generator as KPL writes it, such as `cars` or `percepts[vision]`."""

Receive = Callable[[Sample[Any]], None]
"""Takes the samples of a stream as they become available."""


class StreamGenerator:
    """Hands the samples of one process to everyone who has subscribed.

    Available times are unique in a stream: a sample that would become available no later than
    the one before it is given the next nanosecond.

    Attributes:
        label: The name of the generator.
        depth: How many processes lie between it and the sources; 0 for a source.
        account: What its process has cost and given.
    """

    __slots__ = ("_last", "_receivers", "_waiting", "account", "depth", "label")

    def __init__(self, label: Label, depth: int) -> None:
        self.label = label
        self.depth = depth
        self.account = Account()
        self._last = TimePoint(-1)
        self._receivers: list[Receive] = []
        self._waiting: deque[Sample[Any]] = deque()

    @property
    def next_release(self) -> TimePoint | None:
        """When the next sample that is not available yet will be."""
        return self._waiting[0].available_time if self._waiting else None

    def connect(self, receive: Receive) -> None:
        """Hand all samples from now on to *receive* too."""
        self._receivers.append(receive)

    def disconnect(self, receive: Receive) -> None:
        """Hand no more samples to *receive*."""
        self._receivers.remove(receive)

    def put(self, sample: Sample[Any], now: TimePoint) -> None:
        """Take in what the process has produced at *now*; hand it out when it is available."""
        earliest = now if now > self._last else TimePoint(self._last + 1)
        if sample.available_time < earliest:
            sample = Sample(sample.value, sample.valid_time, earliest)
        self._last = sample.available_time
        self.account.samples += 1
        if sample.available_time <= now:
            self._hand_out(sample)
        else:
            self._waiting.append(sample)

    def release(self, now: TimePoint) -> None:
        """Hand out the samples that have become available by *now*."""
        while self._waiting and self._waiting[0].available_time <= now:
            self._hand_out(self._waiting.popleft())

    def _hand_out(self, sample: Sample[Any]) -> None:
        for receive in self._receivers:
            receive(sample)

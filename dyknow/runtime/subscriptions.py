"""A stream on its way from a generator to a receiver, adapted to the receiver's policy."""

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from dyknow.runtime.agenda import Agenda
from dyknow.runtime.generators import Label, Receive, StreamGenerator
from dyknow.streams.adapter import Adapter
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import Violation
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["FilteredSubscription", "StreamViolation", "Subscription"]


@dataclass(frozen=True, slots=True)
class StreamViolation:
    """A violation and the stream in which it happened.

    Attributes:
        provider: The label of the generator.
        receiver: The label of the process that asked for the policy, or `output`.
        violation: What was violated, where, and why.
    """

    provider: Label
    receiver: Label
    violation: Violation


Publish = Callable[[StreamViolation], None]
"""Takes the violations of a stream."""


class FilteredSubscription:
    """Puts a filter between a generator and a receiver; there are no alarms to ring."""

    def __init__(
        self, provider: Label, receiver: Label, receive: Receive, adapter: Filter, publish: Publish
    ) -> None:
        self._provider = provider
        self._receiver = receiver
        self._receive = receive
        self._filter = adapter
        self._publish = publish

    def receive(self, sample: Sample[Any]) -> None:
        """Take in a sample of the generator."""
        if self._filter.push(sample):
            self._receive(sample)
        elif self._filter.violations:
            for violation in self._filter.take_violations():
                self._publish(StreamViolation(self._provider, self._receiver, violation))


class Subscription:
    """Puts an adapter between a generator and a receiver, and rings its alarms.

    Its turns come before those of the processes it can feed and after those of the process that
    feeds it, so that at one instant arrivals come before alarms.
    """

    def __init__(
        self,
        generator: StreamGenerator,
        receiver: Label,
        receive: Receive,
        adapter: Adapter,
        agenda: Agenda,
        publish: Publish,
    ) -> None:
        self._provider = generator.label
        self._receiver = receiver
        self._receive = receive
        self._adapter = adapter
        self._agenda = agenda
        self._publish = publish
        self._waiting: deque[Sample[Any]] = deque()
        self._ticket = agenda.join(self, 2 * generator.depth + 1)
        self._has_ended = False
        self._plan()

    @property
    def is_waiting(self) -> bool:
        """Whether there are samples that will be available later."""
        return bool(self._waiting)

    def end(self) -> None:
        """Hand on nothing more and let no alarm ring."""
        self._has_ended = True
        self._waiting.clear()

    def receive(self, sample: Sample[Any]) -> None:
        """Take in a sample of the generator."""
        self._hand_on(self._adapter.push(sample), sample.available_time)

    def turn(self, now: TimePoint) -> None:
        """Hand on what has become available and let the adapter's alarm ring."""
        if self._has_ended:
            return
        while self._waiting and self._waiting[0].available_time <= now:
            self._receive(self._waiting.popleft())
        due = self._adapter.due()
        produced = self._adapter.advance(now) if due is not None and due <= now else ()
        self._hand_on(produced, now)

    def _hand_on(self, samples: Iterable[Sample[Any]], now: TimePoint) -> None:
        for sample in samples:
            if sample.available_time <= now:
                self._receive(sample)
            else:
                self._waiting.append(sample)
        for violation in self._adapter.take_violations():
            self._publish(StreamViolation(self._provider, self._receiver, violation))
        self._plan()

    def _plan(self) -> None:
        due = self._adapter.due()
        if due is not None:
            self._agenda.wake(self._ticket, due)
        if self._waiting:
            self._agenda.wake(self._ticket, self._waiting[0].available_time)

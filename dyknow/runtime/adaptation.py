"""Streams on their way from a generator to their receivers, adapted to a policy.

What is asked for alike at the same moment is adapted once: as long as nothing has happened in
between, equal policies of one generator make equal streams. Such streams share an adapter until
one of them is given another policy or ends.
"""

from collections import deque
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Protocol

from dyknow.errors import PolicyNotSupportedError
from dyknow.runtime.agenda import Agenda, Ticket
from dyknow.runtime.cache import NEVER
from dyknow.runtime.generators import Beat, Receive, StreamGenerator
from dyknow.runtime.statistics import Tally
from dyknow.streams.adapter import Adapter, VariesPeriod, adapter_for
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import Approximation, Policy, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = ["END_OF_TIME", "AdaptedStream", "Member", "PlainStream"]

END_OF_TIME = TimePoint((1 << 63) - 1)
"""Later than every valid time."""


class Member(Protocol):
    """A receiver of a stream.

    Attributes:
        receive: Takes the samples.
        beat: Takes the heartbeats, if they are wanted.
    """

    receive: Receive
    beat: Beat | None

    def publish(self, violation: Violation) -> None:
        """Take a violation of the stream's policy."""


class PlainStream:
    """Everything that a generator produces from its beginning, under no policy.

    Attributes:
        tally: The figures of the stream, which are those of the generator.
    """

    def __init__(self, generator: StreamGenerator) -> None:
        self.tally = generator.tally
        self._generator = generator
        self._n_members = 0

    @property
    def last(self) -> Sample[Any] | None:
        """The last sample that was handed on."""
        return self._generator.last

    @property
    def period(self) -> None:
        """The sample period in force: there is none."""

    @property
    def is_empty(self) -> bool:
        """Whether nobody receives this stream."""
        return self._n_members == 0

    def join(self, member: Member) -> None:
        """Hand everything to *member* too."""
        self._n_members += 1
        self._generator.connect(member, member.receive, member.beat)

    def leave(self, member: Member) -> None:
        """Hand nothing more to *member*."""
        self._n_members -= 1
        self._generator.disconnect(member)


class AdaptedStream:
    """The samples that an adapter hands on, and its alarms.

    Its turns come before those of the processes it can feed and after those of the process that
    feeds it, so that at one instant arrivals come before alarms. A stream whose adapter has no
    alarms, and that is not behind with older samples, needs no turns.

    Attributes:
        policy: What the stream keeps.
        begin: The first time-point at which something is handed on.
        tally: The figures of the stream.
        last: The last sample that was handed on.
    """

    def __init__(
        self, generator: StreamGenerator, policy: Policy, agenda: Agenda, begin: TimePoint
    ) -> None:
        self.policy = policy
        self.begin = begin
        self.tally = Tally()
        self.last: Sample[Any] | None = None
        self._generator = generator
        self._agenda = agenda
        self._ticket: Ticket | None = None
        self._adapter: Adapter = adapter_for(policy, begin) or Filter(policy)
        self._members: dict[Member, Receive] = {}
        self._beats: dict[Member, Beat] = {}
        self._waiting: deque[Element] = deque()
        self._older: deque[Element] = deque()
        self._reached = TimePoint(begin - 1)
        self._heard = self._told = NEVER

    def may_hold(self, sample: Sample[Any]) -> bool:
        """Return whether *sample* may be kept here until a later time."""
        return (
            self.policy.period is not None
            and self.policy.max_delay is not None
            and sample.available_time >= self.begin
            and self.policy.allows_delay(sample.delay)
        )

    @property
    def period(self) -> Duration | None:
        """The sample period in force, if the stream is sampled."""
        return self._adapter.period if isinstance(self._adapter, VariesPeriod) else None

    def set_period(self, period: Duration, begin: TimePoint) -> None:
        """Go on with another of the sample periods that the policy allows, from *begin* on."""
        assert isinstance(self._adapter, VariesPeriod)  # whoever asks has looked at the policy
        self._hand_on(self._adapter.set_period(period, begin), TimePoint(begin - 1))
        self._plan()

    @property
    def is_empty(self) -> bool:
        """Whether nobody receives this stream."""
        return not self._members

    @property
    def is_behind(self) -> bool:
        """Whether there are older samples to be handed on before those that arrive."""
        return bool(self._older or self._waiting)

    @property
    def to_come(self) -> tuple[Element, ...]:
        """What has been adapted and will be available later."""
        return tuple(self._waiting)

    def carry_on(self, other: "AdaptedStream | PlainStream") -> None:
        """Take the place of another stream of the same generator.

        What the other stream had yet to hand on is not lost, and the order of valid times goes
        on across the change. Nothing is handed on a second time.
        """
        self.tally = other.tally.copy()
        last = other.last
        if isinstance(other, AdaptedStream):
            for element in other.to_come:
                self._wait_with(element)
                self._reached = element.available_time
                last = element if isinstance(element, Sample) else last
        if last is not None:
            self._go_on_after(last)
        for sample in self._unsettled_by(other, last):
            self._queue(sample)
        self._hear_again()

    def begin_in_the_past(self) -> None:
        """Offer the samples that the generator holds and the policy allows first.

        Raises:
            PolicyNotSupportedError: The generator does not hold all of them any more.
        """
        self._offer_past()
        self._hear_again()

    def join(self, member: Member) -> None:
        """Hand everything from now on to *member* too."""
        self._members[member] = member.receive
        if member.beat is not None:
            self._beats[member] = member.beat
        self._connect()
        self._plan()

    def leave(self, member: Member) -> None:
        """Hand nothing more to *member*; end with the last one."""
        del self._members[member]
        self._beats.pop(member, None)
        if self._members:
            return
        self._generator.disconnect(self)
        self._agenda.pending -= len(self._waiting) + len(self._older)
        self._waiting.clear()
        self._older.clear()
        if self._ticket is not None:
            self._agenda.leave(self._ticket)
            self._ticket = None

    def turn(self, now: TimePoint) -> None:
        """Hand on what has become available and let the adapter's alarm ring."""
        self._hand_on_waiting(now)
        self._take_older(now)
        due = self._adapter.due()
        if due is not None and due <= now:
            self._hand_on(self._adapter.advance(now), now)
        self._plan()

    def _offer_past(self) -> None:
        generator, policy = self._generator, self.policy
        if policy.start is None or not generator.tally.samples:
            return
        earliest = policy.start
        if policy.max_delay is not None:
            earliest = max(earliest, TimePoint(self.begin - policy.max_delay))
        if not generator.holds_all_since(earliest):
            raise PolicyNotSupportedError(
                generator.label,
                f"the stream would begin at {text_from_duration(earliest)}, and not all samples "
                f"since then are held (a cache of {generator.capacity})",
            )
        self._know_value_before(earliest)
        for sample in generator.between(earliest, END_OF_TIME):
            self._queue(sample)

    def _hear_again(self) -> None:
        """Take in the last heartbeat of the generator once more."""
        if self._generator.complete_until > NEVER:
            self._queue(Heartbeat(self._generator.complete_until, self.begin))

    def _go_on_after(self, last: Sample[Any]) -> None:
        """Let the adapter begin as if it had just handed on *last*."""
        if self._is_approximated:
            # What would have to be handed on before *last* is over.
            assert self.policy.max_delay is not None  # the policy says so itself
            beyond = TimePoint(last.valid_time + 1 + self.policy.max_delay)
            self._adapter = adapter_for(self.policy, max(self.begin, beyond)) or self._adapter
            self._know_value_before(TimePoint(last.valid_time + 1))
        else:
            # Without a delay, so that it counts whatever delay the policy allows.
            self._tell_adapter(replace(last, available_time=last.valid_time))

    def _know_value_before(self, time: TimePoint) -> None:
        """Let an adapter that approximates know the value that held before *time*."""
        known = self._generator.find_at_or_before(TimePoint(time - 1))
        if self._is_approximated and known is not None:
            self._tell_adapter(known)

    def _tell_adapter(self, sample: Sample[Any]) -> None:
        """Push a sample that is not to be handed on, and that is no violation."""
        for _ in self._adapter.push(sample):
            pass
        self._adapter.take_violations()

    @property
    def _is_approximated(self) -> bool:
        return self.policy.approximation is Approximation.MOST_RECENT

    def _unsettled_by(
        self, other: "AdaptedStream | PlainStream", last: Sample[Any] | None
    ) -> list[Sample[Any]]:
        """Return the samples that *other* has neither handed on nor left out for good."""
        if not isinstance(other, AdaptedStream):
            return []
        after = NEVER if last is None else last.valid_time
        return [
            sample
            for sample in self._generator.samples
            if sample.valid_time > after and (self._is_approximated or other.may_hold(sample))
        ]

    def _connect(self) -> None:
        receive = self._queue if self.is_behind else self._receive
        beat = self._queue if self.is_behind else self._beat
        self._generator.connect(self, receive, beat if self._beats else None)

    def _receive(self, sample: Sample[Any]) -> None:
        """Take in a sample of the generator."""
        self._hand_on(self._adapter.push(sample), sample.available_time)
        self._plan()

    def _beat(self, heartbeat: Heartbeat) -> None:
        """Take in a heartbeat of the generator."""
        self._heard = heartbeat.until
        self._tell(heartbeat.available_time)

    def _tell(self, now: TimePoint) -> None:
        """Hand on a heartbeat, as far as it holds for what the adapter has still to hand on."""
        due = self._adapter.due()
        until = self._heard
        if due is not None and self.policy.max_delay is not None:
            until = min(until, TimePoint(due - self.policy.max_delay - 1))
        if until <= self._told:
            return
        self._told = until
        if self._waiting:
            self._wait_with(Heartbeat(until, self._waiting[-1].available_time))
        else:
            self._hand_on_beat(Heartbeat(until, now))

    def _queue(self, element: Element) -> None:
        """Keep an element until the older ones before it have been taken in."""
        self._reached = max(element.available_time, TimePoint(self._reached + 1))
        self._older.append(replace(element, available_time=self._reached))
        self._agenda.pending += 1
        self._plan()

    def _take_older(self, now: TimePoint) -> None:
        if not self._older:
            return
        while self._older and self._older[0].available_time <= now:
            self._agenda.pending -= 1
            element = self._older.popleft()
            if isinstance(element, Heartbeat):
                self._beat(element)
            else:
                self._receive(element)
        if not self._older:
            self._connect()

    def _hand_on_waiting(self, now: TimePoint) -> None:
        while self._waiting and self._waiting[0].available_time <= now:
            self._agenda.pending -= 1
            element = self._waiting.popleft()
            if isinstance(element, Heartbeat):
                self._hand_on_beat(element)
            else:
                self._hand_out(element)

    def _hand_on(self, samples: Iterable[Sample[Any]], now: TimePoint) -> None:
        for sample in samples:
            if sample.available_time <= now:
                self._hand_out(sample)
            else:
                self._agenda.extend(now, sample.available_time)
                self._wait_with(sample)
        for violation in self._adapter.take_violations():
            self.tally.note_violation(violation)
            for member in self._members:
                member.publish(violation)
        if self._heard > self._told:
            self._tell(now)

    def _hand_out(self, sample: Sample[Any]) -> None:
        self.last = sample
        self.tally.note(sample)
        for receive in self._members.values():
            receive(sample)

    def _hand_on_beat(self, heartbeat: Heartbeat) -> None:
        self.tally.heartbeats += 1
        for beat in self._beats.values():
            beat(heartbeat)

    def _wait_with(self, element: Element) -> None:
        self._waiting.append(element)
        self._agenda.pending += 1

    def _plan(self) -> None:
        times = [queue[0].available_time for queue in (self._waiting, self._older) if queue]
        due = self._adapter.due()
        if due is not None:
            times.append(due)
        if times:
            if self._ticket is None:
                self._ticket = self._agenda.join(self, 2 * self._generator.depth + 1)
            self._agenda.wake(self._ticket, min(times))

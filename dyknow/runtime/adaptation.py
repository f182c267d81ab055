"""Streams on their way from a generator, plain or adapted to a policy.

A stream may have several receivers: what is asked for alike at the same moment is the same
stream, and is made once. Each sample is handed to all receivers of a stream, in the order in
which they have joined it, before it is handed to those of the next stream of the generator.
"""

from collections import deque
from collections.abc import Iterable, Sequence
from copy import deepcopy
from typing import Any, Protocol

from dyknow.runtime.agenda import Agenda, Ticket
from dyknow.runtime.beginnings import Beginning
from dyknow.runtime.generators import Beat, Receive, StreamGenerator
from dyknow.runtime.statistics import Delays
from dyknow.streams.adapter import VariesPeriod
from dyknow.streams.policy import Policy, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint

__all__ = ["AdaptedStream", "Member", "PlainStream", "Stream"]


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
    """Everything that a generator produces from its beginning, under no policy."""

    waiting: Sequence[Element] = ()
    held: Sequence[Sample[Any]] = ()
    older: Sequence[Element] = ()
    violations = 0
    late = 0
    period = None
    n_members = 1

    def __init__(self, generator: StreamGenerator) -> None:
        self._generator = generator

    @property
    def delays(self) -> Delays:
        """The delays of its samples, which are those of the generator."""
        return self._generator.delays

    @property
    def first(self) -> TimePoint | None:
        """The valid time of the first sample."""
        return self._generator.first

    @property
    def heartbeats(self) -> int:
        """How many heartbeats there were."""
        return self._generator.heartbeats

    @property
    def last(self) -> Sample[Any] | None:
        """The last sample that was handed on."""
        return self._generator.last

    def deepen(self) -> None:
        """Do nothing: a plain stream has no turns."""

    def join(self, member: Member) -> None:
        """Hand everything to *member*, who is the only one."""
        self._generator.connect(self, member.receive, member.beat)

    def leave(self, member: Member) -> None:  # noqa: ARG002, there is one
        """Hand nothing more to *member*."""
        self._generator.disconnect(self)
        self.n_members = 0


class AdaptedStream:
    """The samples that an adapter hands on, and its alarms.

    Its turns come before those of the processes it can feed and after those of the process that
    feeds it, so that at one instant arrivals come before alarms. A stream whose adapter has no
    alarms, and that is not behind with older samples, needs no turns.

    Attributes:
        policy: What the stream keeps.
        first: The valid time of the first sample that was handed on.
        last: The last sample that was handed on.
        violations: How often the policy could not be kept.
        late: How many samples were left out against the wish of the policy.
        heartbeats: How many heartbeats were handed on.
    """

    __slots__ = (
        "_adapter",
        "_agenda",
        "_beats",
        "_generator",
        "_has_alarms",
        "_is_behind",
        "_left_out",
        "_made",
        "_members",
        "_noticed",
        "_older",
        "_reached",
        "_receivers",
        "_ticket",
        "_waiting",
        "first",
        "heartbeats",
        "last",
        "late",
        "policy",
        "violations",
    )

    def __init__(
        self, generator: StreamGenerator, policy: Policy, agenda: Agenda, beginning: Beginning
    ) -> None:
        self.policy = policy
        before = beginning.predecessor
        self.first = before.first if before else None
        self.last = before.last if before else None
        self.violations = before.violations if before else 0
        self.late = before.late if before else 0
        self.heartbeats = before.heartbeats if before else 0
        # The delays are those of the generator, without the one, and with the other.
        self._left_out = None if generator.is_fresh else generator.delays.copy()
        self._made = before.delays.copy() if before else None
        self._generator = generator
        self._agenda = agenda
        self._ticket: Ticket | None = None
        self._members: dict[Member, Receive] = {}
        # The values of the members, gone through for every sample: a list takes the least time.
        self._receivers: list[Receive] = []
        self._beats: dict[Member, Beat] = {}
        self._adapter = beginning.adapter
        self._noticed = self._adapter.violations
        self._has_alarms = policy.period is not None and policy.max_delay is not None
        self._waiting: list[Element] = []
        self._older: deque[tuple[TimePoint, Element]] | None = None
        self._reached = TimePoint(beginning.begin - 1)
        self._is_behind = False
        for element in beginning.waiting:
            self._wait_with(element)
            self._reached = element.available_time
        for element in beginning.older:
            self._queue(element)

    @property
    def n_members(self) -> int:
        """How many receivers the stream has."""
        return len(self._members)

    @property
    def waiting(self) -> Sequence[Element]:
        """What the adapter has handed on already and will be available later."""
        return tuple(self._waiting)

    @property
    def held(self) -> Sequence[Sample[Any]]:
        """What the adapter keeps back."""
        return self._adapter.held

    @property
    def older(self) -> Sequence[Element]:
        """What the adapter is still to be told before what arrives."""
        return tuple(element for _, element in self._older or ())

    @property
    def period(self) -> Duration | None:
        """The sample period in force, if the stream is sampled."""
        return self._adapter.period if isinstance(self._adapter, VariesPeriod) else None

    @property
    def delays(self) -> Delays:
        """The delays of the samples that were handed on."""
        delays = self._generator.delays
        if self._made is not None:
            delays = delays.plus(self._made)
        return delays if self._left_out is None else delays.minus(self._left_out)

    def copied(self, begin: TimePoint) -> Beginning:
        """Return what a stream begins with that is the same as this one up to now."""
        adapter = deepcopy(self._adapter)
        return Beginning(begin, adapter, self.waiting, self.older, self)

    def set_period(self, period: Duration, begin: TimePoint) -> None:
        """Go on with another sample period that the policy allows, from *begin* on."""
        assert isinstance(self._adapter, VariesPeriod)  # whoever asks has looked at the policy
        for sample in self._adapter.set_period(period, begin):
            self._wait_with(sample)
        self._publish()
        self._plan()

    def join(self, member: Member) -> None:
        """Hand everything from now on to *member* too."""
        is_first, is_new = not self._members, member not in self._members
        self._members[member] = member.receive
        if is_new:
            self._receivers.append(member.receive)
        else:
            self._receivers = list(self._members.values())
        self._beats.pop(member, None)
        if member.beat is not None:
            self._beats[member] = member.beat
        if is_first:
            self._connect()
            self._plan()

    def leave(self, member: Member) -> None:
        """Hand nothing more to *member*; end with the last one."""
        del self._members[member]
        self._receivers = list(self._members.values())
        self._beats.pop(member, None)
        if not self._members:
            self._end()

    def deepen(self) -> None:
        """Have turns after those of the generator's process, which has become deeper."""
        if self._ticket is not None:
            self._agenda.move(self._ticket, 2 * self._generator.depth + 1)

    def turn(self, now: TimePoint) -> None:
        """Hand on what has become available and let the adapter's alarm ring."""
        while self._waiting and self._waiting[0].available_time <= now:
            self._agenda.pending -= 1
            self._hand_out(self._waiting.pop(0))
        if self._is_behind:
            self._take_older(now)
        due = self._adapter.due()
        if due is not None and due <= now:
            self._hand_on(self._adapter.advance(now), now)
        self._plan()

    def _connect(self) -> None:
        """Receive from the generator; in the queue, if there is something older to be done."""
        self._is_behind = bool(self._older or self._waiting)
        if self._is_behind:
            self._generator.connect(self, self._receive_behind, self._queue)
        else:
            self._generator.connect(self, self._receive, self._beat)

    def _receive(self, sample: Sample[Any]) -> None:
        """Take in a sample of the generator."""
        adapted = self._adapter.push(sample)
        if len(adapted) == 1 and adapted[0] is sample:
            # Nearly always: the shortest way, since this is done for every sample and stream.
            if self.last is None:
                self.first = sample.valid_time
            self.last = sample
            for receive in self._receivers:
                receive(sample)
        else:
            self._leave_out(sample)
            self._hand_on(adapted, sample.available_time)
        if self._noticed:
            self._publish()
        if self._has_alarms and (self._ticket is None or self._ticket.wake_at is None):
            # Else a turn is planned that is early enough: no sample brings the alarm nearer.
            self._plan()

    def _beat(self, heartbeat: Heartbeat) -> None:
        """Take in a heartbeat of the generator."""
        self._has_alarms = self.policy.period is not None
        self._hand_on(self._adapter.beat(heartbeat), heartbeat.available_time)
        self._plan()

    def _receive_behind(self, sample: Sample[Any]) -> None:
        """Take in a sample of the generator after all that is older."""
        self._leave_out(sample)
        self._queue(sample)

    def _queue(self, element: Element) -> None:
        """Keep an element until the older ones before it have been taken in."""
        self._reached = max(element.available_time, TimePoint(self._reached + 1))
        if self._older is None:
            self._older = deque()
        self._older.append((self._reached, element))
        self._agenda.pending += 1

    def _take_older(self, now: TimePoint) -> None:
        while self._older and self._older[0][0] <= now:
            self._agenda.pending -= 1
            time, element = self._older.popleft()
            if isinstance(element, Heartbeat):
                self._beat(Heartbeat(element.until, time))
            else:
                sample = Sample(element.value, element.valid_time, time)
                self._hand_on(self._adapter.push(sample), time)
        if not self._older and not self._waiting:
            self._older = None
            self._connect()

    def _leave_out(self, sample: Sample[Any]) -> None:
        """Count a sample of the generator that is not handed on, or not as it is."""
        if self._left_out is None:
            self._left_out = Delays()
        self._left_out.add(sample.available_time - sample.valid_time)

    def _hand_on(self, elements: Iterable[Element], now: TimePoint) -> None:
        for element in elements:
            if element.available_time > now:
                self._wait_for(element, now)
            else:
                self._hand_out(element)
        if self._noticed:
            self._publish()

    def _hand_out(self, element: Element) -> None:
        if isinstance(element, Heartbeat):
            self.heartbeats += 1
            for beat in self._beats.values():
                beat(element)
        else:
            if self.last is None:
                self.first = element.valid_time
            self.last = element
            if self._made is None:
                self._made = Delays()
            self._made.add(element.available_time - element.valid_time)
            for receive in self._receivers:
                receive(element)

    def _publish(self) -> None:
        for violation in self._adapter.take_violations():
            self.violations += 1
            self.late += violation.sample is not None
            for member in self._members:
                member.publish(violation)

    def _wait_for(self, element: Element, wanted: TimePoint) -> None:
        self._agenda.extend(wanted, element.available_time)
        self._wait_with(element)
        self._plan()

    def _wait_with(self, element: Element) -> None:
        self._waiting.append(element)
        self._agenda.pending += 1

    def _plan(self) -> None:
        """Plan the next turn, if there is anything to be done later."""
        time = self._adapter.due()
        if self._waiting and (time is None or self._waiting[0].available_time < time):
            time = self._waiting[0].available_time
        if self._older and (time is None or self._older[0][0] < time):
            time = self._older[0][0]
        if time is not None:
            if self._ticket is None:
                self._ticket = self._agenda.join(self, 2 * self._generator.depth + 1)
            self._agenda.wake(self._ticket, time)

    def _end(self) -> None:
        self._generator.disconnect(self)
        self._agenda.pending -= len(self._waiting) + len(self._older or ())
        self._waiting.clear()
        self._older = None
        if self._ticket is not None:
            self._agenda.leave(self._ticket)
            self._ticket = None


Stream = AdaptedStream | PlainStream
"""What a receiver can be attached to."""

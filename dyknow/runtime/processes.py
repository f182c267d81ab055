"""Sources and computational units at work: who calls them, and what their calls cost."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from dyknow.errors import ProcessError
from dyknow.runtime.agenda import Agenda
from dyknow.runtime.failures import Failure, OnFailure
from dyknow.runtime.generators import Beat, Label, Receive, StreamGenerator
from dyknow.streams.adapter import ReportsViolations
from dyknow.streams.policy import Policy, Violation
from dyknow.streams.process import ComputationalUnit, Element, HearsHeartbeats, Source
from dyknow.streams.sample import END_OF_TIME, NO_SAMPLE, Heartbeat, Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["Kind", "RunningProcess", "RunningSource", "RunningUnit", "Surroundings"]

_LAST = 1 << 40
"""The priority of asking sources for more: after all other work of an instant."""


class Kind(Enum):
    """The two kinds of knowledge process."""

    SOURCE = "source"
    UNIT = "unit"


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What all processes of a network work with.

    Attributes:
        agenda: Gives them their turns.
        meter: Tells processor seconds, for the accounts alone.
        publish: Takes a violation that the unit of this label reports itself.
        report: Takes a failure, before anything is done about it.
    """

    agenda: Agenda
    meter: Callable[[], float]
    publish: Callable[[Label, Violation], None]
    report: Callable[[Failure], None]


class RunningProcess:
    """A knowledge process of a network and its stream generator.

    Attributes:
        kind: Whether it is a source or a unit.
        process: The source or unit itself.
        generator: Where its samples come out.
        on_failure: What is done when it fails.
        failure: Its failure, if it has failed.
        has_ended: Whether it will produce nothing more.
        account: What it has cost and given.
    """

    kind: Kind

    def __init__(
        self,
        process: Source | ComputationalUnit,
        generator: StreamGenerator,
        on_failure: OnFailure,
        surroundings: Surroundings,
    ) -> None:
        self.process = process
        self.generator = generator
        self.on_failure = on_failure
        self.failure: Failure | None = None
        self.has_ended = False
        self.account = generator.account
        self._agenda = surroundings.agenda
        self._meter = surroundings.meter
        self._report = surroundings.report
        # Odd priorities, in between, belong to the streams that this process feeds.
        self._ticket = surroundings.agenda.join(self, 2 * generator.depth)

    @property
    def label(self) -> Label:
        """The label of the stream generator."""
        return self.generator.label

    @property
    def depth(self) -> int:
        """How many processes lie between this one and the sources; 0 for a source."""
        return self.generator.depth

    @property
    def output_policy(self) -> Policy:
        """What the process promises about all that it produces."""
        return self.generator.output_policy

    @property
    def inputs(self) -> Sequence[tuple[Label, Sample[Any]]]:
        """The label and the last sample of each input stream; empty for a source."""
        return ()

    def start(self, now: TimePoint) -> None:
        """Begin to work at *now*."""

    def turn(self, now: TimePoint) -> None:
        """Do what is due at *now*."""

    def deepen(self, depth: int) -> None:
        """Have turns after the processes of less than *depth* from now on."""
        self.generator.depth = depth
        self._agenda.move(self._ticket, 2 * depth)

    def withdraw(self) -> None:
        """Leave the network and forget what has not become available."""
        self.has_ended = True
        self.generator.clear()
        self._agenda.leave(self._ticket)

    def _fail(self, error: Exception, now: TimePoint) -> None:
        failure = Failure(self.label, now, tuple(self.inputs), error)
        self.failure = failure
        self.account.failures += 1
        self._report(failure)
        if self.on_failure is OnFailure.STOP:
            raise ProcessError(self.label, now, failure.text, failure.inputs) from error
        self.has_ended = True
        # Nothing more will come, so that nobody needs to wait for it.
        self.generator.put(Heartbeat(END_OF_TIME, now), now)
        self._plan_release()

    def _plan_release(self) -> None:
        if self.generator.is_waiting:
            self._agenda.wake(self._ticket, self.generator.next_release)


class RunningSource(RunningProcess):
    """A source, asked for each sample only when all that follows from the last one is done."""

    kind = Kind.SOURCE

    def __init__(
        self,
        source: Source,
        generator: StreamGenerator,
        on_failure: OnFailure,
        surroundings: Surroundings,
    ) -> None:
        super().__init__(source, generator, on_failure, surroundings)
        self._source = source
        self._elements: Iterator[Element] | None = None
        self._next: Element | None = None
        self._reached = TimePoint(-1)
        self._asking = self._agenda.join(_Asking(self), _LAST)
        self._agenda.pending += 1

    def start(self, now: TimePoint) -> None:
        """Ask for the first sample."""
        self.ask(now)

    def ask(self, now: TimePoint) -> None:
        """Read one sample and plan the turn at which it becomes available."""
        started = self._meter()
        try:
            self._next = self._read()
        except Exception as error:  # noqa: BLE001, told to all and raised unless it may be survived
            self._end()
            self._fail(error, now)
            return
        self.account.seconds += self._meter() - started
        self.account.calls += 1
        if self._next is None:
            self._end()
        else:
            self._agenda.wake(self._ticket, max(self._next.available_time, now))

    def turn(self, now: TimePoint) -> None:
        """Hand out the sample that is due and plan to ask for the next."""
        self.generator.release(now)
        if self._next is not None and self._next.available_time <= now:
            self.generator.put(self._next, now)
            self._next = None
            self._agenda.wake(self._asking, now)
        if self._next is not None:
            # A turn may have come earlier, for a sample that had to wait.
            self._agenda.wake(self._ticket, self._next.available_time)
        self._plan_release()

    def withdraw(self) -> None:
        """Leave the network; close the source if it can be closed."""
        if not self.has_ended:
            self._end()
        super().withdraw()
        self._agenda.leave(self._asking)
        close = getattr(self._elements, "close", None)
        if close is not None:
            close()

    def _end(self) -> None:
        self.has_ended = True
        self._next = None
        self._agenda.pending -= 1

    def _read(self) -> Element | None:
        if self._elements is None:
            self._elements = iter(self._source.samples())
        element = next(self._elements, None)
        if element is not None:
            self.generator.check(element)
            self._check_order(element.available_time)
        return element

    def _check_order(self, time: TimePoint) -> None:
        if time < self._reached:
            then, at = text_from_duration(time), text_from_duration(self._reached)
            raise ValueError(f"the source went back in time, from {at} to {then} ms")
        self._reached = time


class _Asking:
    """The turn at the end of an instant in which a source is asked for its next sample."""

    def __init__(self, source: RunningSource) -> None:
        self._source = source

    def turn(self, now: TimePoint) -> None:
        self._source.ask(now)


class RunningUnit(RunningProcess):
    """A computational unit with the last available sample of each of its inputs."""

    kind = Kind.UNIT

    def __init__(
        self,
        unit: ComputationalUnit,
        providers: Sequence[Label],
        generator: StreamGenerator,
        on_failure: OnFailure,
        surroundings: Surroundings,
    ) -> None:
        super().__init__(unit, generator, on_failure, surroundings)
        self._unit = unit
        self._providers: list[Label | None] = list(providers)
        self._inputs: list[Sample[Any]] = [NO_SAMPLE] * len(providers)
        self._has_news = False
        self._heartbeats: dict[int, Heartbeat] = {}
        self._due: TimePoint | None = None
        self._hears = unit if isinstance(unit, HearsHeartbeats) else None
        self._reporter = unit if isinstance(unit, ReportsViolations) else None
        self._publish = surroundings.publish

    @property
    def inputs(self) -> Sequence[tuple[Label, Sample[Any]]]:
        """The label and the last sample of each input stream."""
        both = zip(self._providers, self._inputs, strict=True)
        return tuple((label, sample) for label, sample in both if label is not None)

    def add_input(self, provider: Label) -> int:
        """Take one more stream, at the first place that is free; return its number from 0 on."""
        if None not in self._providers:
            self._providers.append(None)
            self._inputs.append(NO_SAMPLE)
        at = self._providers.index(None)
        self._providers[at] = provider
        return at

    def remove_input(self, at: int) -> None:
        """Take stream number *at*, from 0 on, no more; its place is free from now on."""
        self._providers[at] = None
        self._inputs[at] = NO_SAMPLE
        self._heartbeats.pop(at, None)

    def start(self, now: TimePoint) -> None:
        """Plan the first alarm of a unit that has one before its first input."""
        due = self._unit.due()
        if due is not None:
            self._agenda.wake(self._ticket, max(due, now))

    def receiver(self, at: int) -> Receive:
        """Return what takes the samples of input number *at*, counted from 0."""

        def receive(sample: Sample[Any]) -> None:
            self._inputs[at] = sample
            if not self._has_news:
                self._has_news = True
                self._agenda.wake(self._ticket, sample.available_time)

        return receive

    def beat(self, at: int) -> Beat | None:
        """Return what takes the heartbeats of input number *at*, if the unit listens to them."""
        if self._hears is None:
            return None

        def beat(heartbeat: Heartbeat) -> None:
            self._heartbeats[at] = heartbeat
            self._agenda.wake(self._ticket, heartbeat.available_time)

        return beat

    def turn(self, now: TimePoint) -> None:
        """Hand out what is due, call the unit, and plan the next turn."""
        generator = self.generator
        if generator.is_waiting:
            generator.release(now)
        if not self.has_ended:
            for element in self._call(now):
                generator.put(element, now)
            if self._reporter is not None:
                for violation in self._reporter.take_violations():
                    self._publish(self.label, violation)
            if self._due is not None:
                self._agenda.wake(self._ticket, self._due)
        self._plan_release()

    def _call(self, now: TimePoint) -> Iterable[Element]:
        started = self._meter()
        try:
            produced = self._tell(now)
            for element in produced:
                self.generator.check(element)
        except Exception as error:  # noqa: BLE001, told to all and raised unless it may be survived
            self._fail(error, now)
            self._due = None
            return ()
        self.account.seconds += self._meter() - started
        return produced

    def _tell(self, now: TimePoint) -> list[Element]:
        unit = self._unit
        produced: list[Element] = []
        if self._has_news:
            self._has_news = False
            self.account.calls += 1
            produced += unit.push(now, tuple(self._inputs))
        if self._heartbeats:
            produced += self._pass_heartbeats(now)
        due = unit.due()
        if due is not None and due <= now:
            self.account.calls += 1
            produced += unit.advance(now)
            due = unit.due()
            if due is not None and due <= now:
                raise ValueError("after 'advance' the unit is still due at the same time")
        self._due = due
        return produced

    def _pass_heartbeats(self, now: TimePoint) -> Iterator[Element]:
        assert self._hears is not None  # else no heartbeats are taken in
        heartbeats, self._heartbeats = self._heartbeats, {}
        for at, heartbeat in sorted(heartbeats.items()):
            self.account.calls += 1
            yield from self._hears.beat(now, at, heartbeat)

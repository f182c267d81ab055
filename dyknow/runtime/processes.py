"""Sources and computational units at work: who calls them, and what their calls cost."""

from collections.abc import Callable, Iterator
from typing import Any

from dyknow.errors import ProcessError
from dyknow.runtime.agenda import Agenda
from dyknow.runtime.generators import Receive, StreamGenerator
from dyknow.streams.adapter import ReportsViolations
from dyknow.streams.policy import Violation
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["RunningSource", "RunningUnit", "priority_of"]

_LAST = 1 << 40
"""The priority of asking sources for more: after all other work of an instant."""


def priority_of(depth: int) -> int:
    """Return the priority of a process; the odd ones in between belong to its input streams."""
    return 2 * depth


class RunningSource:
    """A source, asked for each sample only when all that follows from the last one is done."""

    def __init__(
        self,
        source: Source,
        generator: StreamGenerator,
        agenda: Agenda,
        meter: Callable[[], float],
    ) -> None:
        self._source = source
        self._generator = generator
        self._agenda = agenda
        self._meter = meter
        self._samples: Iterator[Sample[Any]] | None = None
        self._next: Sample[Any] | None = None
        self._ticket = agenda.join(self, priority_of(0))
        self._asking = agenda.join(_Asking(self), _LAST)
        self.has_ended = False

    def start(self, now: TimePoint) -> None:
        """Ask for the first sample, unless that has been done."""
        if self._samples is None:
            self.ask(now)

    def ask(self, now: TimePoint) -> None:
        """Read one sample and plan the turn at which it becomes available."""
        started = self._meter()
        try:
            if self._samples is None:
                self._samples = iter(self._source.samples())
            self._next = next(self._samples, None)
            self._check_order(now)
        except Exception as fault:
            raise ProcessError(self._generator.label, now) from fault
        self._generator.account.seconds += self._meter() - started
        self._generator.account.calls += 1
        if self._next is None:
            self.has_ended = True
        else:
            self._agenda.wake(self._ticket, max(self._next.available_time, now))

    def turn(self, now: TimePoint) -> None:
        """Hand out the sample that is due and plan to ask for the next."""
        self._generator.release(now)
        if self._next is not None and self._next.available_time <= now:
            self._generator.put(self._next, now)
            self._next = None
            self._agenda.wake(self._asking, now)
        if (release := self._generator.next_release) is not None:
            self._agenda.wake(self._ticket, release)

    def _check_order(self, now: TimePoint) -> None:
        if self._next is not None and self._next.available_time < now:
            then, at = text_from_duration(self._next.available_time), text_from_duration(now)
            raise ValueError(f"the source went back in time, from {at} to {then} ms")


class _Asking:
    """The turn at the end of an instant in which a source is asked for its next sample."""

    def __init__(self, source: RunningSource) -> None:
        self._source = source

    def turn(self, now: TimePoint) -> None:
        self._source.ask(now)


class RunningUnit:
    """A computational unit with the last available sample of each of its inputs."""

    def __init__(
        self,
        unit: ComputationalUnit,
        n_inputs: int,
        generator: StreamGenerator,
        agenda: Agenda,
        meter: Callable[[], float],
        publish: Callable[[Violation], None],
    ) -> None:
        self._unit = unit
        self._inputs: list[Sample[Any]] = [NO_SAMPLE] * n_inputs
        self._has_news = False
        self._due: TimePoint | None = None
        self._generator = generator
        self._agenda = agenda
        self._meter = meter
        self._reporter = unit if isinstance(unit, ReportsViolations) else None
        self._publish = publish
        self._ticket = agenda.join(self, priority_of(generator.depth))

    def start(self, now: TimePoint) -> None:
        """Plan the first alarm of a unit that has one before its first input."""
        due = self._unit.due()
        if due is not None:
            self._agenda.wake(self._ticket, max(due, now))

    def receiver(self, at: int) -> Receive:
        """Return what takes the samples of input number *at*."""

        def receive(sample: Sample[Any]) -> None:
            self._inputs[at] = sample
            self._has_news = True
            self._agenda.wake(self._ticket, sample.available_time)

        return receive

    def turn(self, now: TimePoint) -> None:
        """Hand out what is due, call the unit, and plan the next turn."""
        self._generator.release(now)
        for sample in self._call(now):
            self._generator.put(sample, now)
        if self._reporter is not None:
            for violation in self._reporter.take_violations():
                self._publish(violation)
        for time in (self._due, self._generator.next_release):
            if time is not None:
                self._agenda.wake(self._ticket, time)

    def _call(self, now: TimePoint) -> list[Sample[Any]]:
        started = self._meter()
        try:
            produced = self._tell(now)
        except Exception as fault:
            raise ProcessError(self._generator.label, now) from fault
        self._generator.account.seconds += self._meter() - started
        return produced

    def _tell(self, now: TimePoint) -> list[Sample[Any]]:
        produced: list[Sample[Any]] = []
        if self._has_news:
            self._has_news = False
            self._generator.account.calls += 1
            produced.extend(self._unit.push(now, tuple(self._inputs)))
        self._due = self._unit.due()
        if self._due is not None and self._due <= now:
            self._generator.account.calls += 1
            produced.extend(self._unit.advance(now))
            self._due = self._unit.due()
            if self._due is not None and self._due <= now:
                raise ValueError("after 'advance' the unit is still due at the same time")
        return produced

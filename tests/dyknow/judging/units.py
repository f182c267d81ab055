"""Small units of different kinds, for networks to be judged."""

from collections.abc import Iterable
from typing import Any

from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_SAMPLE, Heartbeat, Sample
from dyknow.time import TimePoint
from tests.support.streams import ms

__all__ = ["Counting", "Hearing", "Late", "Pairs", "Ticking"]


class Pairs(Reactive):
    """Emits the values of all inputs when one of them has something new and all have something."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Emit a tuple, valid at the latest of the valid times."""
        if NO_SAMPLE in inputs:
            return
        valid_time = max(sample.valid_time for sample in inputs)
        yield Sample(tuple(sample.value for sample in inputs), valid_time, now)


class Counting(Reactive):
    """Emits how many samples it has seen, and which; its state is never forgotten."""

    def __init__(self) -> None:
        self._count = 0

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Emit the count and the values."""
        for sample in inputs:
            if sample.available_time == now:
                self._count += 1
                yield Sample((self._count, sample.value), sample.valid_time, now)


class Late(Reactive):
    """Hands on its input 35 ms later."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Emit the sample, to be available later."""
        (sample,) = inputs
        yield Sample(sample.value, sample.valid_time, TimePoint(now + ms(35)))


class Hearing(Reactive):
    """Emits how far its input is complete, whenever a heartbeat says so."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Emit nothing."""
        return ()

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> Iterable[Sample[Any]]:
        """Emit until when the input is complete."""
        yield Sample((at, heartbeat.until), now, now)


class Ticking:
    """Emits the last value of its input every 40 ms."""

    def __init__(self) -> None:
        self._last: Any = None
        self._due = ms(40)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Take in a value."""
        self._last = inputs[0].value
        return ()

    def advance(self, now: TimePoint) -> Iterable[Sample[Any]]:
        """Emit the value for each time that has come."""
        while self._due <= now:
            yield Sample(self._last, self._due, self._due)
            self._due = TimePoint(self._due + ms(40))

    def due(self) -> TimePoint:
        """Return the next time."""
        return self._due

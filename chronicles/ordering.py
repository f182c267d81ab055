"""Samples of several streams, put into the order of their valid times."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Any

from dyknow.streams.sample import BEGINNING_OF_TIME, Heartbeat, Sample
from dyknow.time import Duration, TimePoint

__all__ = ["InputOrder"]


@dataclass(slots=True)
class _Input:
    """What is known of one stream.

    Attributes:
        max_delay: The largest delay that its samples can have; None if that is not known.
        is_ordered: Whether its samples come in monotone order of valid time.
        complete: No sample to come has a valid time up to this one, as heartbeats, and the
            order of the samples, tell.
        is_awaited: Whether samples of other streams wait for it.
    """

    max_delay: Duration | None
    is_ordered: bool
    is_awaited: bool
    complete: TimePoint = BEGINNING_OF_TIME

    def complete_at(self, now: TimePoint) -> TimePoint:
        """Return up to which valid time nothing is missing at *now*."""
        if self.max_delay is None:
            return self.complete
        return max(self.complete, TimePoint(now - self.max_delay))

    def complete_when(self, time: TimePoint, ahead: int = 0) -> TimePoint | None:
        """Return from when on nothing is missing up to *time*, if that is known.

        What order and heartbeats tell may be *ahead* of that by some nanoseconds.
        """
        if self.complete + ahead >= time:
            return BEGINNING_OF_TIME
        return None if self.max_delay is None else TimePoint(time + self.max_delay)


class InputOrder:
    """Holds samples back until no earlier one can come from a stream that is awaited.

    A stream is awaited if its delay is known to be limited, or once it has said by a heartbeat
    how far it is complete. What a stream has that says neither counts as it arrives, and nothing
    waits for it.

    The streams are those of the first call of `take`, unless `open` has named them before.

    Args:
        max_delay: The largest delay of the samples of every stream, if there is one.
        with_equals: Whether a sample is also held back until no more of the same valid time can
            come, so that they are ready together.
    """

    def __init__(self, max_delay: Duration | None = None, *, with_equals: bool = False) -> None:
        self._max_delay = max_delay
        self._ahead = 0 if with_equals else 1
        self._inputs: dict[int, _Input] = {}
        self._is_known = False
        self._waiting: list[tuple[TimePoint, int, int, Sample[Any]]] = []
        self._n_samples = 0

    def open(
        self,
        at: int,
        *,
        max_delay: Duration | None = None,
        is_ordered: bool = False,
        is_awaited: bool = False,
    ) -> None:
        """Take stream number *at*, of which more is known than of others.

        Args:
            at: The number of the stream, from 0 on.
            max_delay: The largest delay of its samples, if there is one.
            is_ordered: Whether its samples come in monotone order of valid time.
            is_awaited: Whether it is awaited before it has given a heartbeat.
        """
        one = self._input(at)
        one.max_delay = max_delay
        one.is_ordered = is_ordered
        one.is_awaited = one.is_awaited or is_awaited or max_delay is not None
        self._is_known = True

    def take(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> None:
        """Take in the new samples among *inputs*."""
        if not self._is_known:
            for at in range(len(inputs)):
                self._input(at)
            self._is_known = True
        for at, sample in enumerate(inputs):
            if sample.available_time == now:
                self.put(at, sample)
                one = self._inputs[at]
                if one.is_ordered:
                    one.complete = max(one.complete, TimePoint(sample.valid_time - 1))

    def put(self, at: int, sample: Sample[Any]) -> None:
        """Take in one sample."""
        self._n_samples += 1
        heappush(self._waiting, (sample.valid_time, self._n_samples, at, sample))

    def hear(self, at: int, heartbeat: Heartbeat) -> None:
        """Take in how far stream number *at* is complete."""
        one = self._input(at)
        one.is_awaited = True
        one.complete = max(one.complete, heartbeat.until)

    def ready(self, now: TimePoint) -> Iterator[tuple[int, Sample[Any]]]:
        """Yield the samples that nothing earlier can precede, with the number of their stream."""
        while self._waiting:
            when = self.ready_when()
            if when is None or when > now:
                return
            _, _, at, sample = heappop(self._waiting)
            yield at, sample

    def complete(self, now: TimePoint) -> TimePoint:
        """Return up to which valid time, *now* at most, all streams are complete."""
        if not self._is_known:
            return BEGINNING_OF_TIME
        return min([now, *(one.complete_at(now) for one in self._inputs.values())])

    def ready_when(self) -> TimePoint | None:
        """Return from when on the next sample need not wait, if time alone can tell."""
        if not self._waiting:
            return None
        awaited = [one for one in self._inputs.values() if one.is_awaited]
        return _latest(one.complete_when(self._waiting[0][0], self._ahead) for one in awaited)

    def complete_when(self, time: TimePoint) -> TimePoint | None:
        """Return from when on all streams are complete up to *time*, if time alone can tell."""
        if not self._is_known:
            return None
        found = _latest(one.complete_when(time) for one in self._inputs.values())
        return None if found is None else max(found, time)

    def _input(self, at: int) -> _Input:
        if at not in self._inputs:
            delay = self._max_delay
            self._inputs[at] = _Input(delay, is_ordered=False, is_awaited=delay is not None)
        return self._inputs[at]


def _latest(times: Iterable[TimePoint | None]) -> TimePoint | None:
    """Return the last of *times*, or None if one of them is not known."""
    found = list(times)
    return (
        max((each for each in found if each is not None), default=BEGINNING_OF_TIME)
        if None not in found
        else None
    )

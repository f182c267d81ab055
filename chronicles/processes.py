"""The recogniser as a knowledge process; the only module here that knows samples."""

import logging
from collections.abc import Iterable, Iterator
from heapq import heappop, heappush
from itertools import groupby
from typing import Any

from chronicles.events import Event, Recognition
from chronicles.models import Model
from chronicles.recognition import Recogniser
from dyknow.streams.sample import Sample
from dyknow.time import Duration, TimePoint

__all__ = ["ChronicleRecogniser"]

_logger = logging.getLogger(__name__)

_Recognitions = tuple[Recognition, ...]


class ChronicleRecogniser:
    """Recognises chronicles in streams of events (Heintz 2009, section 8.7.3).

    The value of each input sample is a tuple of the events at its valid time; an empty one says
    that nothing happened up to then. Streams need not
    agree in their delay: with *max_delay* each sample waits until that time after it was valid,
    so that all streams are taken in the order of valid time. Before the events of a sample are
    taken in, the clock of the recogniser moves to its valid time, which ends what could only
    have gone on before.

    One sample comes out for each time at which anything was recognised; it is valid at that
    time, and its value is the tuple of recognitions.

    Without *max_delay* samples are taken in as they arrive and only they move the clock; one
    that is valid before another was is left out, counted in `n_late`, and reported in the log.
    With *max_delay*, which promises that no sample arrives later than that after it was valid,
    the clock moves on without samples as well.

    Args:
        models: The chronicles.
        max_delay: How long after its valid time a sample may arrive.
    """

    def __init__(self, models: Iterable[Model], *, max_delay: Duration | None = None) -> None:
        self._recogniser = Recogniser(models)
        self._max_delay = max_delay
        self._waiting: list[tuple[int, int, tuple[Event, ...]]] = []
        self._n_samples = 0
        self._last_available = -1

    @property
    def n_late(self) -> int:
        """How many events were left out because they came too late."""
        return self._recogniser.n_late

    @property
    def recogniser(self) -> Recogniser:
        """The recogniser, to ask for partial instances."""
        return self._recogniser

    def push(
        self, now: TimePoint, inputs: tuple[Sample[Any], ...]
    ) -> Iterable[Sample[_Recognitions]]:
        """Take in the new samples among *inputs* and emit what is recognised."""
        for sample in inputs:
            if sample.available_time == now and isinstance(sample.value, tuple):
                self._n_samples += 1
                heappush(self._waiting, (sample.valid_time, self._n_samples, sample.value))
        return self.advance(now)

    def advance(self, now: TimePoint) -> Iterable[Sample[_Recognitions]]:
        """Emit what time alone recognises, if *max_delay* says how far time has come."""
        found = []
        while self._waiting and self._is_due(self._waiting[0][0], now):
            valid_time, _, events = heappop(self._waiting)
            found.extend(self._take_in(TimePoint(valid_time), events))
        if self._max_delay is not None:
            found.extend(self._recogniser.advance(TimePoint(now - self._max_delay)))
        return list(self._samples(now, found))

    def due(self) -> TimePoint | None:
        """Return when the next sample has waited long enough or time decides something."""
        if self._max_delay is None:
            return None
        deadline = self._recogniser.next_deadline()
        times = [self._waiting[0][0]] if self._waiting else []
        if deadline is not None:
            times.append(deadline)
        return TimePoint(min(times) + self._max_delay) if times else None

    def _is_due(self, valid_time: int, now: int) -> bool:
        return self._max_delay is None or valid_time + self._max_delay <= now

    def _take_in(self, valid_time: TimePoint, events: tuple[Event, ...]) -> list[Recognition]:
        n_late = self._recogniser.n_late
        found = self._recogniser.push(valid_time, events)
        if self._recogniser.n_late > n_late:
            _logger.warning("%d late events at %d ns left out", len(events), valid_time)
        return found

    def _samples(
        self, now: TimePoint, found: list[Recognition]
    ) -> Iterator[Sample[_Recognitions]]:
        for time, group in groupby(found, key=lambda recognition: recognition.recognised_at):
            self._last_available = max(now, self._last_available + 1)
            yield Sample(tuple(group), time, TimePoint(self._last_available))

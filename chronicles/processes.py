"""The recogniser as a knowledge process."""

import logging
from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import Any

from chronicles.events import Event, Recognition
from chronicles.models import Model
from chronicles.ordering import InputOrder
from chronicles.recognition import Recogniser
from dyknow.streams.process import Element
from dyknow.streams.sample import BEGINNING_OF_TIME, Heartbeat, Sample
from dyknow.time import Duration, TimePoint

__all__ = ["ChronicleRecogniser"]

_logger = logging.getLogger(__name__)

_Events = tuple[Event, ...]
_Recognitions = tuple[Recognition, ...]


class ChronicleRecogniser:
    """Recognises chronicles in streams of events (Heintz 2009, section 8.7.3).

    The value of each input sample is a tuple of the events at its valid time; an empty one says
    that nothing happened up to then. Streams need not
    agree in their delay: with *max_delay* each sample waits until that time after it was valid,
    so that all streams are taken in the order of valid time; it waits no longer for a stream that
    says by a heartbeat how far it is complete. Before the events of a sample are
    taken in, the clock of the recogniser moves to its valid time, which ends what could only
    have gone on before.

    One sample comes out for each time at which anything was recognised; it is valid at that
    time, and its value is the tuple of recognitions. Heartbeats say up to which time nothing more
    will be recognised.

    Without *max_delay* samples are taken in as they arrive, unless streams give heartbeats, and
    only samples and heartbeats move the clock; a sample that
    is valid before another was is left out, counted in `n_late`, and reported in the log.
    With *max_delay*, which promises that no sample arrives later than that after it was valid,
    the clock moves on without samples as well.

    Args:
        models: The chronicles.
        max_delay: How long after its valid time a sample may arrive.
        limit: How many partial instances of each chronicle are kept; None for any number.

    Attributes:
        order: Puts the samples of the streams in order.
    """

    def __init__(
        self,
        models: Iterable[Model],
        *,
        max_delay: Duration | None = None,
        limit: int | None = None,
    ) -> None:
        self.order = InputOrder(max_delay)
        self._recogniser = Recogniser(models, limit=limit)
        self._last_available = -1
        self._complete = BEGINNING_OF_TIME

    @property
    def n_late(self) -> int:
        """How many events were left out because they came too late."""
        return self._recogniser.n_late

    @property
    def recogniser(self) -> Recogniser:
        """The recogniser, to ask for partial instances."""
        return self._recogniser

    def begin(self, at: int, sample: Sample[_Events]) -> None:
        """Take in what held before the process was there, as a sample of input number *at*."""
        self.order.put(at, sample)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Element]:
        """Take in the new samples among *inputs* and emit what is recognised."""
        self.order.take(now, inputs)
        return self.advance(now)

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> list[Element]:
        """Take in how far an input is complete and emit what is recognised by that."""
        self.order.hear(at, heartbeat)
        return self.advance(now)

    def advance(self, now: TimePoint) -> list[Element]:
        """Emit what time alone recognises, as far as it is known how far time has come."""
        found: list[Recognition] = []
        for _, sample in self.order.ready(now):
            if isinstance(sample.value, tuple):
                found += self._take_in(sample.valid_time, sample.value)
        complete = self.order.complete(now)
        if complete > BEGINNING_OF_TIME:
            found += self._recogniser.advance(TimePoint(complete + 1))
        return [*self._samples(now, found), *self._heartbeats(now)]

    def due(self) -> TimePoint | None:
        """Return when the next sample has waited long enough or time decides something."""
        deadline = self._recogniser.next_deadline()
        times = [
            self.order.ready_when(),
            None if deadline is None else self.order.complete_when(deadline),
        ]
        return min((time for time in times if time is not None), default=None)

    def _take_in(self, valid_time: TimePoint, events: _Events) -> list[Recognition]:
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

    def _heartbeats(self, now: TimePoint) -> Iterator[Heartbeat]:
        """Say up to where all recognitions are out: before the instant at which the clock is."""
        clock = self._recogniser.clock
        if clock is not None and clock - 1 > self._complete:
            self._complete = TimePoint(clock - 1)
            yield Heartbeat(self._complete, now)

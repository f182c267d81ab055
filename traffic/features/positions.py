"""Percepts without a camera: the simulator's positions with the faults of a sensor.

This stands in for the cameras in `--view truth`, as in the simulations of Heintz (2009,
section 8.7.6): an ideal tracker that knows which percept is which, but not exactly where, not
always, and not at once.
"""

from collections import deque
from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint

__all__ = ["NoisyPositions"]

_LEAST_VARIANCE = 0.05**2
_AIR_TEMPERATURE = 20.0
_NO_DELAY = Duration(0)


class NoisyPositions:
    """Turns the vehicles of the simulator into vision percepts with inexact positions.

    One table of percepts comes out for each table of vehicles. The error is uniform within
    ±*error* metres, independent in x and y and from sample to sample. A vehicle is missing from
    a table with the probability *dropout*, whatever was before. Percepts are valid when the
    vehicles were, and become available *delay* later.

    Args:
        generator: Source of randomness.
        error: The largest error, metres.
        dropout: Share of the percepts that are missing; below 1.
        delay: How long the sensor takes.
    """

    def __init__(
        self,
        generator: np.random.Generator,
        *,
        error: float,
        dropout: float = 0.0,
        delay: Duration = _NO_DELAY,
    ) -> None:
        if error < 0:
            raise ValueError(f"expected a position error of at least 0 m, found {error}")
        if not 0 <= dropout < 1:
            raise ValueError(f"expected a share of dropouts of at least 0, below 1: {dropout}")
        if delay < 0:
            raise ValueError(f"expected a delay of at least 0 ns, found {delay}")
        self._generator = generator
        self._error = error
        self._dropout = dropout
        self._delay = delay
        self._waiting: deque[Sample[Table]] = deque()

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Take in the newest table of vehicles; emit what the sensor has done by now."""
        (sample,) = inputs
        percepts = self._percepts(sample.value, sample.valid_time)
        available = TimePoint(now + self._delay)
        self._waiting.append(Sample(percepts, sample.valid_time, available))
        return self.advance(now)

    def advance(self, now: TimePoint) -> Iterable[Sample[Table]]:
        """Emit what the sensor has done by now."""
        done = []
        while self._waiting and self._waiting[0].available_time <= now:
            done.append(self._waiting.popleft())
        return done

    def due(self) -> TimePoint | None:
        """Return when the sensor will have done with the oldest table that it works on."""
        return self._waiting[0].available_time if self._waiting else None

    def _percepts(self, vehicles: Table, time: TimePoint) -> Table:
        n = len(vehicles)
        noise = self._generator.uniform(-self._error, self._error, size=(n, 2))
        variance = self._error**2 / 3 + _LEAST_VARIANCE
        columns = {
            "position": vehicles["position"] + noise,
            "velocity": np.full((n, 2), np.nan),
            "covariance": np.broadcast_to(variance * np.eye(2), (n, 2, 2)),
            "length": vehicles["length"],
            "width": vehicles["width"],
            "colour": vehicles["colour"].astype(np.float32),
            "temperature": np.full(n, _AIR_TEMPERATURE, dtype=np.float32),
            "observed_at": np.full(n, time, dtype=np.int64),
        }
        percepts = Table("percept", vehicles.ids, columns)
        if not self._dropout:
            return percepts
        return percepts.select(self._generator.random(n) >= self._dropout)

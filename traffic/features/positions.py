"""Percepts without a camera: the simulator's positions with an error added.

This stands in for the cameras in `--view truth`, as in the simulations of Heintz (2009,
section 8.7.6): an ideal tracker that knows which percept is which, but not exactly where.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = ["NoisyPositions"]

_LEAST_VARIANCE = 0.05**2
_AIR_TEMPERATURE = 20.0


class NoisyPositions(Reactive):
    """Turns the vehicles of the simulator into vision percepts with inexact positions.

    One table of percepts comes out for each table of vehicles. The error is uniform within
    ±*error* metres, independent in x and y and from sample to sample.

    Args:
        error: The largest error, metres.
        generator: Source of randomness.
    """

    def __init__(self, generator: np.random.Generator, *, error: float) -> None:
        if error < 0:
            raise ValueError(f"expected a position error of at least 0 m, found {error}")
        self._generator = generator
        self._error = error

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the percepts of the newest table of vehicles."""
        (sample,) = inputs
        vehicles: Table = sample.value
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
            "observed_at": np.full(n, sample.valid_time, dtype=np.int64),
        }
        yield Sample(Table("percept", vehicles.ids, columns), sample.valid_time, now)

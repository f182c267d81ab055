"""A source of vehicles that needs no simulator."""

import numpy as np

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, TimePoint

__all__ = ["StandingCars"]


class StandingCars:
    """Three cars that stand in a crossing, for four seconds at 25 Hz."""

    def samples(self):
        """Yield them as the simulator would."""
        columns = {
            "position": np.array([[-8.0, 2.0], [5.0, -3.0], [12.0, 3.0]]),
            "heading": np.zeros(3),
            "speed": np.zeros(3),
            "length": np.full(3, 4.5),
            "width": np.full(3, 1.8),
            "height": np.full(3, 1.5),
            "colour": np.full((3, 3), 200, dtype=np.uint8),
            "vehicle_class": np.zeros(3, dtype=np.int8),
        }
        for i in range(100):
            time = TimePoint(i * 40 * MILLISECOND)
            yield Sample(Table("vehicle", np.arange(3) + 1000, columns), time, time)

"""Whether a car moves, with hysteresis against noise in its speed."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.carrying import CarriedColumns

__all__ = ["Moving"]


class Moving(Reactive):
    """Adds the column `moving` to a stream of tables with a column `speed`.

    One table comes out for each table that goes in, with the same times. A car begins to move
    when it is faster than *above* and comes to rest when it is slower than *below*; a new car
    moves if it is faster than *below*.

    Args:
        above: Speed in m/s at which a resting car counts as moving.
        below: Speed in m/s under which a moving car counts as resting; at most *above*.
    """

    def __init__(self, *, above: float, below: float) -> None:
        if not 0 <= below <= above:
            raise ValueError(f"expected 0 <= below <= above, found {below} and {above}")
        self._above = above
        self._below = below
        self._state = CarriedColumns({"moving": np.True_})

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the newest table with `moving` added."""
        (sample,) = inputs
        table: Table = sample.value
        self._state.align(table.ids)
        speed = table["speed"]
        moving = (speed > self._above) | (self._state["moving"] & (speed >= self._below))
        self._state["moving"] = moving
        yield Sample(table.with_columns(moving=moving), sample.valid_time, now)

"""Whether a car stands, with hysteresis against noise in its speed."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.carrying import CarriedColumns

__all__ = ["Standing"]


class Standing(Reactive):
    """Adds the column `standing` to a stream of tables with a column `speed`.

    One table comes out for each table that goes in. A car comes to rest when it is slower than
    *below*, and stands until it is faster than *above*; a new car does not stand.

    Args:
        below: Speed in m/s.
        above: Speed in m/s, at least *below*.
    """

    def __init__(self, *, below: float, above: float) -> None:
        if not 0 < below <= above:
            raise ValueError(f"expected 0 < below <= above, found {below} and {above}")
        self._below = below
        self._above = above
        self._state = CarriedColumns({"standing": np.False_})

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the newest table with `standing` added."""
        (sample,) = inputs
        table: Table = sample.value
        self._state.align(table.ids)
        speed = table["speed"]
        standing = (speed < self._below) | (self._state["standing"] & (speed <= self._above))
        self._state["standing"] = standing
        yield Sample(table.with_columns(standing=standing), sample.valid_time, now)

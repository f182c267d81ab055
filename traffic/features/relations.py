"""Qualitative spatial relations between two cars, relative to the road.

The relations of Heintz (2009), section 8.7.5, are taken along and across the road instead of
from the direction between the cars, so that they hold in bends too. Each relation has
hysteresis: what makes it true is stricter than what keeps it true.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.carrying import CarriedColumns

__all__ = ["RELATIONS", "CarRelations"]

RELATIONS = ("behind", "in_front", "left", "right", "beside", "close")

Floats = npt.NDArray[np.float64]


class CarRelations(Reactive):
    """Computes the qualitative relations of each pair of cars; one table out for each one in.

    For a pair (first, second), with the gap between bumpers along the road:

    * `behind`: the first car is behind the second, gap at least *gap*; holds until the cars
      are level (gap below zero);
    * `in_front`: the same with the roles exchanged;
    * `left`, `right`: the first car is to the left (right) of the second by at least
      *offset*; holds until less than half of it;
    * `beside`: neither behind nor in front, and to the left or right;
    * `close`: the gap is below *near*; holds until it is above one and a half times that.

    Args:
        gap: Metres between bumpers.
        offset: Metres between centre lines.
        near: Metres between bumpers.
    """

    def __init__(self, *, gap: float, offset: float, near: float) -> None:
        self._gap = gap
        self._offset = offset
        self._near = near
        self._state = CarriedColumns(dict.fromkeys(RELATIONS, np.False_))

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the relations of the newest table of pairs."""
        (sample,) = inputs
        pairs: Table = sample.value
        is_new = self._state.align(pairs.ids)
        gap_ahead = pairs["ahead"] - pairs["clearance"]
        gap_back = -pairs["ahead"] - pairs["clearance"]
        enter = np.where(is_new, 0.0, self._gap)
        self._hold("behind", gap_ahead, enter, 0.0)
        self._hold("in_front", gap_back, enter, 0.0)
        self._hold("left", pairs["left"], self._offset, self._offset / 2)
        self._hold("right", -pairs["left"], self._offset, self._offset / 2)
        self._hold("close", -np.maximum(gap_ahead, gap_back), -self._near, -1.5 * self._near)
        state = self._state
        apart = state["behind"] | state["in_front"]
        state["beside"] = ~apart & (state["left"] | state["right"])
        relations = {name: state[name] for name in RELATIONS}
        columns = {"first": pairs["first"], "second": pairs["second"], **relations}
        yield Sample(Table("car_relation", pairs.ids, columns), sample.valid_time, now)

    def _hold(self, name: str, value: Floats, enter: float | Floats, stay: float) -> None:
        self._state[name] = (value >= enter) | (self._state[name] & (value >= stay))

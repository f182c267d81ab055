"""Whether a car is on the side of the road on which one drives the other way."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.roads import RoadMap
from traffic.features.carrying import CarriedColumns

__all__ = ["Sides"]


class Sides(Reactive):
    """Adds the column `wrong_side` to a stream of cars.

    One table comes out for each table that goes in. A car is on the wrong side while it is on a
    lane whose direction is opposite to its own; slower than *moving* it has no direction. Off
    the lanes and outside crossings, such as where roads meet, it stays on the side where it was.

    Args:
        roads: The road network.
        moving: Speed in m/s from which one can tell which way a car goes.
    """

    def __init__(self, roads: RoadMap, *, moving: float) -> None:
        if moving <= 0:
            raise ValueError(f"expected a speed of more than 0 m/s, found {moving}")
        self._lines = roads.lane_columns.lines
        self._moving = moving
        self._state = CarriedColumns({"wrong_side": np.False_})

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the newest table with `wrong_side` added."""
        (sample,) = inputs
        cars: Table = sample.value
        self._state.align(cars.ids)
        moves, on_lane = cars["speed"] >= self._moving, cars["lane"] >= 0
        wrong = self._state["wrong_side"] & moves & ~on_lane & (cars["crossing"] < 0)
        tells = moves & on_lane
        wrong[tells] = self._goes_against(cars.select(tells))
        self._state["wrong_side"] = wrong
        yield Sample(cars.with_columns(wrong_side=wrong), sample.valid_time, now)

    def _goes_against(self, cars: Table) -> npt.NDArray[np.bool_]:
        lane = cars["lane"]
        s, _ = self._lines.project(cars["position"], lane)
        against: npt.NDArray[np.bool_] = (
            np.cos(cars["heading"] - self._lines.heading_at(lane, s)) < 0
        )
        return against

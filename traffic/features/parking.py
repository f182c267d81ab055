"""Where cars stand: at the side of the road or off it, and beside which building."""

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

__all__ = ["BesideBuilding"]

_HYSTERESIS = 0.2
"""Metres less aside at which a car that stands aside still does."""


class BesideBuilding(Reactive):
    """Tells beside which building each car stands; one table comes out for each one that goes in.

    The columns are `beside_building`, the building's index on the map, or -1 for none, and
    `observed`. A car stands beside a building that is at most *within* metres from its centre, the
    nearest if there are several, while it

    * stands: it is slower than *below* m/s, and has not been faster than *above* since;
    * is aside: its centre is at least *aside* metres, and *certainty* standard deviations of where
      it is, from the middle of the outer lane of its road, to the outer side, which is where the
      kerb is. So it is off the lane, or at the kerb; who waits in a queue is neither.

    Args:
        roads: The map, with its buildings.
        within: Metres.
        below: m/s.
        above: m/s.
        aside: Metres.
        certainty: Standard deviations.
    """

    def __init__(
        self,
        roads: RoadMap,
        *,
        within: float,
        below: float,
        above: float,
        aside: float,
        certainty: float,
    ) -> None:
        self._surroundings = roads.surroundings
        self._within = within
        self._below, self._above = below, above
        self._aside = aside
        self._certainty = certainty
        self._outwards = 1.0 if roads.left_hand else -1.0
        self._outer_lane = outer_lanes(roads)
        self._state = CarriedColumns({"stands": np.False_, "aside": np.False_})

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit where the cars of the newest table stand."""
        (sample,) = inputs
        cars: Table = sample.value
        state = self._state
        state.align(cars.ids)
        speed = cars["speed"]
        state["stands"] = (speed < self._below) | (state["stands"] & (speed <= self._above))
        outwards = self._outwards * (cars["d"] - self._outer_lane[cars["road"]])
        least = self._aside + self._certainty * np.sqrt(cars["d_variance"])
        state["aside"] = outwards >= np.where(state["aside"], self._aside - _HYSTERESIS, least)
        (rows,) = np.nonzero(state["stands"] & state["aside"])
        building = np.full(len(cars), -1, dtype=np.int32)
        building[rows] = self._surroundings.nearest_building(cars["position"][rows], self._within)
        columns = {"beside_building": building, "observed": cars["observed"]}
        yield Sample(Table("car", cars.ids, columns), sample.valid_time, now)


def outer_lanes(roads: RoadMap) -> npt.NDArray[np.float64]:
    """Return where the middle of the outer lane is across each road, metres to the left."""
    lanes = roads.lane_columns
    first = np.searchsorted(lanes.road, np.arange(len(roads.roads)))
    outer = (roads.road_width - lanes.width[first]) / 2
    middle: npt.NDArray[np.float64] = outer if roads.left_hand else -outer
    return middle

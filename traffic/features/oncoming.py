"""Who is on the side of the oncoming traffic while somebody comes, and meets them soon."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, Duration, TimePoint
from networks.roads import RoadMap
from traffic.features.decisions import Decisions
from traffic.features.pairs import pair_id

__all__ = ["FacingTraffic"]

Floats = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

_LEAST_DEVIATION = 0.25
"""Metres by which a place across the road is uncertain at least."""

_LEAST_TIME_DEVIATION = 0.1
"""Seconds by which the time until two cars meet is uncertain at least."""

_CLEARLY = 5.0
"""Standard deviations from which a car on its own side is no candidate."""

_SLOWEST = 0.1
"""m/s."""


class FacingTraffic(Reactive):
    """Pairs of active cars on one link that come towards each other, and which of them face that.

    For each table of cars one comes out that is valid *within* earlier, with the pairs whose
    first car may be beyond the middle of its link, and whose second car comes towards it, at
    most *reach* away. `facing` is true of a pair when the first car is on the side of the
    oncoming traffic and would meet the second one within *horizon*, as fast as both are.

    Args:
        roads: The road network.
        reach: Metres between centres, along the link.
        horizon: Time until two cars meet, below which one faces the other.
        active_for: How long a car counts after it was last observed.
        certainty: Standard deviations from which an estimate is believed.
        within: How long it may take to become certain.
    """

    def __init__(
        self,
        roads: RoadMap,
        *,
        reach: float,
        horizon: Duration,
        active_for: Duration,
        certainty: float,
        within: Duration,
    ) -> None:
        if reach <= 0:
            raise ValueError(f"expected a reach of more than 0 m, found {reach}")
        self._half_width: Floats = np.asarray(roads.road_width, dtype=np.float64) / 2
        self._towards_middle = -1.0 if roads.left_hand else 1.0
        self._reach = reach
        self._horizon = horizon / SECOND
        self._active_for = active_for
        self._decisions = Decisions(1, certainty=certainty, within=within)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit who faces whom, as far as the newest table of cars decides it."""
        (sample,) = inputs
        cars: Table = sample.value
        is_active = sample.valid_time - cars["observed_at"] <= self._active_for
        pairs, evidence = self._pairs(cars.select(is_active))
        for time, table, codes in self._decisions.push(sample.valid_time, pairs, evidence):
            ends = {"first": table["first"], "second": table["second"]}
            facing = Table("car_meeting", table.ids, {**ends, "facing": codes[:, 0]})
            yield Sample(facing, time, now)

    def _pairs(self, cars: Table) -> tuple[Table, Floats]:
        """Return the pairs, and the evidence that the first faces the second, shape (n, 1)."""
        beyond = self._beyond(cars)
        first, second = self._candidates(cars, beyond)
        along = cars["direction_in_link"] * cars["position_along_link"]
        other = cars["direction_in_link"][first] * cars["position_along_link"][second]
        way = other - along[first] - (cars["length"][first] + cars["length"][second]) / 2
        closing = np.maximum(cars["speed"][first] + cars["speed"][second], _SLOWEST)
        variance = cars["s_variance"][first] + cars["s_variance"][second]
        deviation = np.hypot(np.sqrt(variance) / closing, _LEAST_TIME_DEVIATION)
        soon = (self._horizon - np.maximum(way, 0.0) / closing) / deviation
        evidence: Floats = np.minimum(beyond[first], soon)
        ends = {"first": cars.ids[first], "second": cars.ids[second]}
        table = Table("car_meeting", pair_id(ends["first"], ends["second"]), ends)
        return table, evidence[:, None]

    def _beyond(self, cars: Table) -> Floats:
        """Return by how many standard deviations each car is beyond the middle of its link."""
        over = self._towards_middle * cars["d"] - self._half_width[cars["road"]]
        deviation = np.sqrt(cars["d_variance"] + _LEAST_DEVIATION**2)
        beyond: Floats = np.where(cars["link_of_road"] >= 0, over / deviation, -np.inf)
        return beyond

    def _candidates(self, cars: Table, beyond: Floats) -> tuple[Rows, Rows]:
        """Return the rows of cars that may be beyond the middle, and of all who come at them."""
        (rows,) = np.nonzero(beyond > -_CLEARLY)
        link, direction = cars["link_of_road"], cars["direction_in_link"]
        place = cars["position_along_link"]
        same_link = link[rows][:, None] == link[None, :]
        opposite = direction[rows][:, None] == -direction[None, :]
        ahead = direction[rows][:, None] * (place[None, :] - place[rows][:, None])
        found, second = np.nonzero(same_link & opposite & (ahead > 0) & (ahead <= self._reach))
        return rows[found], second

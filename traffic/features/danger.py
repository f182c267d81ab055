"""Which cars are about to collide, if they go on as they do."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint
from networks.prediction import Bodies, first_touch
from networks.roads import RoadMap
from traffic.features.pairs import pair_id

__all__ = ["CollisionCourses"]

Floats = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

_STEP = 0.05
"""Seconds from one moment that is looked at to the next."""

_ACTIVE_FOR = Duration(400 * MILLISECOND)
_MOVING = 1.0
_ALIGNED = 0.8
"""Cosine of the angle up to which two cars travel the same way."""


class CollisionCourses(Reactive):
    """Pairs of active cars near each other, and whether they are on a collision course.

    For each table of cars one table of pairs comes out: columns `first` and `second`, ids of the
    cars, the smaller one first; and `collision_course`. Two cars are on a collision course that
    would touch within *horizon* (*following*, if they travel the same way) if each kept its speed
    and its place across its road, where

    * their velocities differ by at least *closing* m/s, and *certainty* standard deviations of
      that: who brakes is slower than is known yet; and
    * both are faster than 1 m/s, or one of them follows the other on one road.

    A car is active while it was observed within 400 ms. One that is in a crossing, but beside the
    road on which it is believed to be, goes nobody knows where, and does not count. Cars count as
    smaller than they are by *certainty* standard deviations of where they are along and across
    their roads, and as slower by as many of their speed, so that noise makes no danger.

    Args:
        roads: The road network.
        reach: Metres between centres of a pair.
        horizon: How far ahead one looks.
        following: How far ahead for cars that travel the same way: one brakes later behind
            another than for one who comes from the side.
        closing: m/s.
        certainty: Standard deviations.
    """

    def __init__(
        self,
        roads: RoadMap,
        *,
        reach: float,
        horizon: Duration,
        following: Duration,
        closing: float,
        certainty: float,
    ) -> None:
        self._roads = roads
        self._reach = reach
        self._horizon, self._following = horizon / SECOND, following / SECOND
        self._closing = closing
        self._certainty = certainty
        self._times = np.arange(0.0, max(self._horizon, self._following) + _STEP / 2, _STEP)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the pairs of the newest table of cars."""
        (sample,) = inputs
        cars: Table = sample.value
        is_active = sample.valid_time - cars["observed_at"] <= _ACTIVE_FOR
        yield Sample(self._pairs(cars.select(is_active)), sample.valid_time, now)

    def _pairs(self, cars: Table) -> Table:
        first, second = near_pairs(cars["position"], self._reach)
        swapped = cars.ids[first] > cars.ids[second]
        first, second = np.where(swapped, second, first), np.where(swapped, first, second)
        columns = {
            "first": cars.ids[first],
            "second": cars.ids[second],
            "collision_course": self._collide(cars, first, second),
        }
        return Table("car_danger", pair_id(cars.ids[first], cars.ids[second]), columns)

    def _collide(self, cars: Table, first: Rows, second: Rows) -> npt.NDArray[np.bool_]:
        collide = np.zeros(len(first), dtype=np.bool_)
        speed = cars["speed"]
        velocity = cars["velocity"]
        spread = np.sqrt(cars["speed_variance"][first] + cars["speed_variance"][second])
        least = self._closing + self._certainty * spread
        closing = np.linalg.norm(velocity[second] - velocity[first], axis=1) >= least
        both = np.minimum(speed[first], speed[second]) >= _MOVING
        aligned = np.cos(cars["heading"][first] - cars["heading"][second]) > _ALIGNED
        same_road = cars["road"][first] == cars["road"][second]
        known = self._ways_are_known(cars)
        asked = closing & (both | (aligned & same_road)) & known[first] & known[second]
        (rows,) = np.nonzero(asked)
        touched = first_touch(
            self._roads, self._bodies(cars), (first[rows], second[rows]), self._times
        )
        limit = np.where(aligned[rows], self._following, self._horizon)
        collide[rows] = touched <= limit + _STEP / 2
        return collide

    def _ways_are_known(self, cars: Table) -> npt.NDArray[np.bool_]:
        """Return which cars are where their roads are; in a crossing one may be on another."""
        road = cars["road"]
        beside = np.abs(cars["d"]) > self._roads.road_width[road] / 2
        known: npt.NDArray[np.bool_] = ~(beside & (self._roads.crossing_of_road[road] >= 0))
        return known

    def _bodies(self, cars: Table) -> Bodies:
        """Return the cars as small and as slow as they may well be."""

        def less(value: Floats, variance: Floats) -> Floats:
            smaller: Floats = np.maximum(value - self._certainty * np.sqrt(variance), 0.0)
            return smaller

        return Bodies(
            road=cars["road"],
            s=cars["s"],
            d=cars["d"],
            speed=less(cars["speed"], cars["speed_variance"]),
            length=less(cars["length"], cars["s_variance"]),
            width=less(cars["width"], cars["d_variance"]),
        )


def near_pairs(position: Floats, reach: float) -> tuple[Rows, Rows]:
    """Return the rows of all pairs of points, shape (n, 2), that are at most *reach* apart."""
    if not len(position):
        none = np.empty(0, dtype=np.intp)
        return none, none
    pairs = cKDTree(position).query_pairs(reach, output_type="ndarray").astype(np.intp)
    return pairs[:, 0], pairs[:, 1]

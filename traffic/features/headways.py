"""Who drives behind whom, and with what gap, with the uncertainty that the estimates have."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint
from networks.ahead import RoadsAhead
from networks.roads import RoadMap
from traffic.features.pairs import pair_id

__all__ = ["Headways"]

Floats = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

_SLOWEST = 0.1
"""Speed in m/s below which a time gap is that of a car at this speed."""

_PLAY = 0.8
"""Metres farther aside that who is in the same lane can be where roads narrow or widen, and inside
crossings: there the middle of a road leads from the middle of one to that of another, and lanes
need not be as far beside it as before."""


class Headways(Reactive):
    """Pairs of active cars of which one is behind the other, with the gap between them.

    For each table of cars one table of pairs comes out, with each car that can get to where
    another one is within *reach*, along its road and through crossings. Inside a crossing all ways
    count that lead on from where it came, since nobody knows yet which one it takes. The first
    car of a pair is the one behind. Columns:

    * `first`, `second`: ids of the cars;
    * `ahead`: metres from the centre of the first to that of the second, along the road;
    * `gap`: metres between their bumpers;
    * `time_gap`: seconds that the first one needs for the gap at its speed;
    * `deviation`: standard deviation of the time gap, seconds;
    * `aside`: metres that they are from being one behind the other, across the road;
    * `aside_deviation`: standard deviation of that, metres;
    * `speed`, `speed_of_second`: m/s;
    * `speed_deviation`: standard deviation of the first of these, m/s.

    A car is active while it was observed within *active_for*.

    Args:
        roads: The road network.
        reach: Metres between centres.
        active_for: How long a car counts after it was last observed.
    """

    def __init__(self, roads: RoadMap, *, reach: float, active_for: Duration) -> None:
        if reach <= 0:
            raise ValueError(f"expected a reach of more than 0 m, found {reach}")
        self._ahead = RoadsAhead(roads, reach, undecided=True)
        self._width = np.asarray(roads.road_width, dtype=np.float64)
        self._in_crossing = roads.crossing_of_road >= 0
        self._active_for = active_for

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the pairs of the newest table of cars."""
        (sample,) = inputs
        cars: Table = sample.value
        is_active = sample.valid_time - cars["observed_at"] <= self._active_for
        yield Sample(self._headways(cars.select(is_active)), sample.valid_time, now)

    def _headways(self, cars: Table) -> Table:
        first, second, ahead = self._ahead.pairs(cars["road"], cars["s"])
        gap = ahead - (cars["length"][first] + cars["length"][second]) / 2
        time_gap, deviation = _time_gaps(cars, first, second, gap)
        columns = {
            "first": cars.ids[first],
            "second": cars.ids[second],
            "ahead": ahead,
            "gap": gap,
            "time_gap": time_gap,
            "deviation": deviation,
            "aside": self._aside(cars, first, second),
            "aside_deviation": np.sqrt(cars["d_variance"][first] + cars["d_variance"][second]),
            "speed": cars["speed"][first],
            "speed_of_second": cars["speed"][second],
            "speed_deviation": np.sqrt(cars["speed_variance"][first]),
        }
        return Table("headway", pair_id(cars.ids[first], cars.ids[second]), columns)

    def _aside(self, cars: Table, first: Rows, second: Rows) -> Floats:
        width, in_crossing = self._width[cars["road"]], self._in_crossing[cars["road"]]
        apart = np.abs(cars["d"][first] - cars["d"][second])
        loose = in_crossing[first] | in_crossing[second] | (width[first] != width[second])
        aside: Floats = np.maximum(apart - np.where(loose, _PLAY, 0.0), 0.0)
        return aside


def _time_gaps(cars: Table, first: Rows, second: Rows, gap: Floats) -> tuple[Floats, Floats]:
    """Return the time gaps and their standard deviations, seconds.

    Positions and speed are taken to err independently.
    """
    speed = np.maximum(cars["speed"][first], _SLOWEST)
    time_gap = gap / speed
    place = cars["s_variance"][first] + cars["s_variance"][second]
    deviation = np.sqrt(place + time_gap**2 * cars["speed_variance"][first]) / speed
    return time_gap, deviation

"""Pairs of cars near each other on the same road, with their states at one time.

The thesis makes a stream of synchronised states for each pair of active cars (Heintz 2009,
section 8.7.5). Here the cars of one table already share their valid time, so a pair is two rows
of it; and only cars that could matter to each other are paired, found by sorting along each
link instead of trying all combinations.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint

__all__ = ["NearPairs", "near_pairs_along", "pair_id"]

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

_ID_BITS = 31


def pair_id(first: npt.NDArray[np.int64], second: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return one number for each ordered pair of car ids below 2³¹."""
    return (first << _ID_BITS) | second


def near_pairs_along(
    group: npt.NDArray[np.int64], along: npt.NDArray[np.float64], distance: float
) -> tuple[Indices, Indices]:
    """Find all pairs within one group that are at most *distance* apart along it.

    Args:
        group: shape (n,), which road and direction; negative for none.
        along: shape (n,), metres along it.
        distance: metres.

    Returns:
        Two arrays of row numbers, the one behind and the one ahead (or level) of each pair.
    """
    order = np.lexsort((along, group))
    order = order[group[order] >= 0]
    # Groups are laid out on one line, further apart than any pair may be.
    span = float(np.ptp(along)) + 2 * distance + 1 if len(along) else 1.0
    line = along[order] - (along.min() if len(along) else 0.0) + group[order] * span
    ahead_until = np.searchsorted(line, line + distance, side="right")
    n_ahead = ahead_until - np.arange(len(order)) - 1
    behind = np.repeat(np.arange(len(order)), n_ahead)
    first_of_run = np.repeat(np.cumsum(n_ahead) - n_ahead, n_ahead)
    ahead = behind + 1 + np.arange(len(behind)) - first_of_run
    return order[behind], order[ahead]


class NearPairs(Reactive):
    """Pairs of active cars on roads of one link in one direction, at most *distance* apart.

    For each table of cars one table of pairs comes out, both orders of each pair: columns
    `first` and `second` (car ids), `ahead` (metres that the second car's centre is ahead of the
    first one's along the link), `left` (metres that the first car is to the left of the
    second), `clearance` (half of both lengths, metres).

    A car is active while it was observed within *active_for*.

    Args:
        distance: Metres along the road.
        active_for: How long a car counts after it was last observed.
    """

    def __init__(self, *, distance: float, active_for: Duration) -> None:
        self._distance = distance
        self._active_for = active_for

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the pairs of the newest table of cars."""
        (sample,) = inputs
        cars: Table = sample.value
        is_active = sample.valid_time - cars["observed_at"] <= self._active_for
        yield Sample(self._pairs(cars.select(is_active)), sample.valid_time, now)

    def _pairs(self, cars: Table) -> Table:
        direction, link = cars["direction_in_link"], cars["link_of_road"].astype(np.int64)
        along = direction * cars["position_along_link"]
        group = np.where(link >= 0, 2 * link + (direction > 0), -1)
        behind, ahead = near_pairs_along(group, along, self._distance)
        first = np.concatenate([behind, ahead])
        second = np.concatenate([ahead, behind])
        columns = {
            "first": cars.ids[first],
            "second": cars.ids[second],
            "ahead": along[second] - along[first],
            "left": cars["d"][first] - cars["d"][second],
            "clearance": (cars["length"][first] + cars["length"][second]) / 2,
            "ahead_deviation": _deviation(cars["s_variance"], first, second),
            "left_deviation": _deviation(cars["d_variance"], first, second),
        }
        return Table("car_pair", pair_id(cars.ids[first], cars.ids[second]), columns)


def _deviation(variance: Floats, first: Indices, second: Indices) -> Floats:
    """Return the standard deviations of differences between two rows, metres."""
    deviation: Floats = np.sqrt(variance[first] + variance[second])
    return deviation

"""Qualitative relations between two cars from the direction between them, to compare with.

These are the relations of Heintz (2009, section 8.7.5): the direction from the second car to the
first is compared with the forward direction of the first.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.pairs import pair_id

__all__ = ["AngularRelations"]

_QUARTER = np.pi / 4


class AngularRelations(Reactive):
    """Computes the relations of all pairs of cars; one table out for each table of cars in.

    For a pair (first, second), the first is `in_front` of the second if the direction from the
    second to the first is within 45° of the first one's `forward`, `behind` if it is within 45° of
    the opposite, and `left` or `right` otherwise. Exactly one of them holds, without hysteresis.

    Args:
        distance: Cars further apart are no pair, metres.
    """

    def __init__(self, *, distance: float) -> None:
        self._distance = distance

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the relations of the newest table of cars."""
        (sample,) = inputs
        cars: Table = sample.value
        position, forward = cars["position"], cars["forward"]
        apart = position[:, None, :] - position[None, :, :]
        near = np.hypot(apart[..., 0], apart[..., 1]) <= self._distance
        np.fill_diagonal(near, val=False)
        first, second = np.nonzero(near)
        offset = position[first] - position[second]
        ahead = (offset * forward[first]).sum(axis=1)
        left = forward[first, 0] * offset[:, 1] - forward[first, 1] * offset[:, 0]
        angle = np.arctan2(left, ahead)
        in_front = np.abs(angle) <= _QUARTER
        behind = np.abs(angle) >= np.pi - _QUARTER
        aside = ~in_front & ~behind
        columns = {
            "first": cars.ids[first],
            "second": cars.ids[second],
            "behind": behind,
            "in_front": in_front,
            "left": aside & (angle > 0),
            "right": aside & (angle < 0),
        }
        pairs = Table("car_relation", pair_id(cars.ids[first], cars.ids[second]), columns)
        yield Sample(pairs, sample.valid_time, now)

"""Cars as they are measured, without any filter, to compare with.

The overtake experiment of Heintz (2009, section 8.7.6) took the measured positions as they were,
and the direction of a car from the difference of two of them.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.roads import RoadMap
from traffic.features.carrying import CarriedColumns

__all__ = ["UnfilteredCars"]

_NEVER = -1


class UnfilteredCars(Reactive):
    """Turns percepts into cars, one for each percept; one table out for each one in.

    A car is where it was measured. Its `velocity` is the difference of its two last positions over
    the time between them, zero after the first. Its `forward` direction is that of the road on
    which it is, along it or against it, whichever is nearer to the velocity; unit vectors, shape
    (n, 2). Further columns: `position`, `speed`, `observed` (true), `observed_at`.

    Args:
        roads: The road network.
        distance: Metres beside a road up to which a car is on it; beyond, `forward` is the
            direction of the velocity.
    """

    def __init__(self, roads: RoadMap, *, distance: float = 20.0) -> None:
        self._roads = roads
        self._distance = distance
        self._state = CarriedColumns(
            {"x": np.float64(0), "y": np.float64(0), "seen": np.int64(_NEVER)}
        )

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the newest percepts as cars."""
        (sample,) = inputs
        percepts: Table = sample.value
        state = self._state
        state.align(percepts.ids)
        position, seen = percepts["position"], percepts["observed_at"]
        before = np.column_stack((state["x"], state["y"]))
        elapsed = (seen - state["seen"]) / SECOND
        known = (state["seen"] != _NEVER) & (elapsed > 0)
        step = np.where(known[:, None], position - before, 0.0)
        velocity = step / np.where(known, elapsed, 1.0)[:, None]
        state["x"], state["y"], state["seen"] = position[:, 0], position[:, 1], seen
        columns = {
            "position": position,
            "velocity": velocity,
            "speed": np.hypot(*velocity.T),
            "forward": self._forward(position, velocity),
            "observed": np.ones(len(percepts), dtype=np.bool_),
            "observed_at": seen,
        }
        yield Sample(Table("car", percepts.ids, columns), sample.valid_time, now)

    def _forward(self, position: Any, velocity: Any) -> Any:
        road = self._roads.match(position, np.zeros_like(velocity), self._distance)
        s, _ = self._roads.project(position, road)
        heading = self._roads.heading_at(road, s)
        along = np.column_stack((np.cos(heading), np.sin(heading)))
        against = (along * velocity).sum(axis=1) < 0
        along = np.where(against[:, None], -along, along)
        speed = np.hypot(*velocity.T)[:, None]
        free = np.divide(velocity, speed, out=np.zeros_like(velocity), where=speed > 0)
        return np.where((road >= 0)[:, None], along, free)

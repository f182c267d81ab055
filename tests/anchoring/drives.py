"""Synthetic drives over a road map, and the percepts that a perfect tracker makes of them."""

from collections.abc import Callable, Sequence

import numpy as np

from dyknow.streams.table import Table
from dyknow.time import SECOND


class Drive:
    """A vehicle that goes along given roads.

    Args:
        roads: The road map.
        route: Indices of roads that follow one another.
        speed: Metres per second at each second of time.
        start: Where on the first road it is at time 0, metres.
        beside: Metres to the left of the centre line at each second of time.
    """

    def __init__(
        self,
        roads,
        route: Sequence[int],
        speed: Callable[[float], float],
        start: float = 5.0,
        beside: Callable[[float], float] = lambda _: 0.0,
    ) -> None:
        self._roads, self._route, self._beside = roads, np.array(route), beside
        self._begins = np.concatenate(([0.0], np.cumsum(roads.road_length[self._route])))
        self._times = np.arange(0.0, 60.0, 0.02)
        steps = [0.02 * speed(t) for t in self._times[:-1]]
        self._way = start + np.concatenate(([0.0], np.cumsum(steps)))

    def place(self, time: float) -> tuple[int, float]:
        """Return road and s."""
        way = np.interp(time, self._times, self._way)
        at = min(np.searchsorted(self._begins, way, side="right") - 1, len(self._route) - 1)
        return int(self._route[at]), float(way - self._begins[at])

    def position(self, time: float) -> np.ndarray:
        """Return x and y."""
        road, s = self.place(time)
        return self._roads.point_at([road], np.array([s]), self._beside(time))[0]

    def ahead(self, time: float) -> np.ndarray:
        """Return the direction of travel as a unit vector."""
        road, s = self.place(time)
        heading = self._roads.heading_at([road], np.array([s]))[0]
        return np.array([np.cos(heading), np.sin(heading)])


def straight_on(roads, road: int, count: int = 30) -> list[int]:
    """Return *road* and the roads on which it goes straight on."""
    route = [road]
    while len(route) < count and roads.successors(route[-1]):
        route.append(roads.successors(route[-1])[0])
    return route


def percepts(ids, position, time: int, half_width: float = 0.0, rng=None) -> Table:
    """Return percepts at *position*, off by up to *half_width* metres on each axis."""
    n = len(ids)
    position = np.asarray(position, dtype=float).reshape(n, 2)
    if half_width:
        position = position + rng.uniform(-half_width, half_width, (n, 2))
    return Table(
        "percept",
        ids,
        {
            "position": position,
            "velocity": np.zeros((n, 2)),
            "covariance": np.tile(np.eye(2) * half_width**2 / 3, (n, 1, 1)),
            "length": np.full(n, 4.5),
            "width": np.full(n, 1.8),
            "colour": np.full((n, 3), 128.0, dtype=np.float32),
            "temperature": np.full(n, 20.0, dtype=np.float32),
            "observed_at": np.full(n, time, dtype=np.int64),
        },
    )


def nanoseconds(time: float) -> int:
    """Return seconds as a time point."""
    return round(time * SECOND)

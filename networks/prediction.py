"""Where bodies will be that go on along their roads, and when two of them would touch."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from networks.geometry import Floats, Points
from networks.roads import RoadMap

__all__ = ["Bodies", "first_touch"]

Rows = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """Rectangles that travel along roads, each a row.

    Attributes:
        road: shape (n,), index of the road, never -1.
        s: shape (n,), metres of the centre along it.
        d: shape (n,), metres of the centre to the left of its middle.
        speed: shape (n,), m/s along it.
        length: shape (n,), metres.
        width: shape (n,), metres.
    """

    road: npt.NDArray[np.int32]
    s: Floats
    d: Floats
    speed: Floats
    length: Floats
    width: Floats

    def at(self, roads: RoadMap, time: float) -> tuple[Points, Floats]:
        """Return position and heading after *time* seconds, straight on where roads part."""
        moved = roads.move(self.road, self.s + self.speed * time)
        return roads.point_at(moved.road, moved.s, self.d), roads.heading_at(moved.road, moved.s)


def first_touch(roads: RoadMap, bodies: Bodies, pairs: tuple[Rows, Rows], times: Floats) -> Floats:
    """Return when the two bodies of each pair touch for the first time, or infinity.

    Every body keeps its speed and its distance from the middle of its road.

    Args:
        roads: The map.
        bodies: All of them.
        pairs: Two arrays of row numbers, shape (p,).
        times: Seconds at which it is looked, in order.

    Returns:
        shape (p,), one of *times*.
    """
    first, second = pairs
    touched = np.full(len(first), np.inf)
    if not len(first):
        return touched
    for time in times.tolist():
        position, heading = bodies.at(roads, time)
        apart = position[second] - position[first]
        meets = _overlap(apart, (heading[first], heading[second]), bodies, pairs)
        touched = np.where(meets & np.isinf(touched), time, touched)
    return touched


def _overlap(
    apart: Points, heading: tuple[Floats, Floats], bodies: Bodies, pairs: tuple[Rows, Rows]
) -> Flags:
    """Return which pairs of rectangles overlap: no side of either one parts them."""
    forward = [np.column_stack([np.cos(angle), np.sin(angle)]) for angle in heading]
    left = [np.column_stack([-along[:, 1], along[:, 0]]) for along in forward]
    overlaps = np.ones(len(apart), dtype=np.bool_)
    for axis in (*forward, *left):
        reach = sum(
            bodies.length[rows] * np.abs((along * axis).sum(axis=1))
            + bodies.width[rows] * np.abs((across * axis).sum(axis=1))
            for rows, along, across in zip(pairs, forward, left, strict=True)
        )
        overlaps &= np.abs((apart * axis).sum(axis=1)) <= reach / 2
    return overlaps

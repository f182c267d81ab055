"""Where vehicles are on the road map, by the lane on which the simulator has them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from networks.roads import RoadMap
from traffic.sumo.simulation import Frame

__all__ = ["PlaceReader", "TruePlaces"]

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class TruePlaces:
    """Where the vehicles of a frame are, row by row.

    Attributes:
        link: shape (n,), the link on which the front bumper is, or -1.
        crossing: shape (n,), the crossing in which the front bumper is, or -1.
        direction: shape (n,), 1 if the vehicle travels along its link, -1 if against it.
        progress: shape (n,), metres of the body's centre along the link, in the direction of
            travel; NaN off the links.
        road: shape (n,), the road on which the vehicle travels, or -1.
        s: shape (n,), metres of the body's centre along that road; negative while the front bumper
            alone is on it. NaN off the roads.
        d: shape (n,), metres of the body's centre to the left of the middle of that road, or NaN.
    """

    link: Indices
    crossing: Indices
    direction: Floats
    progress: Floats
    road: Indices
    s: Floats
    d: Floats


class PlaceReader:
    """Finds vehicles on a road map.

    A vehicle that overtakes is, for the simulator, on a lane of the other direction; here it
    counts as being on the road that it travels along.

    Args:
        road_map: The map of the simulated network.
        lanes: The simulator's name of each lane number; may grow.
    """

    def __init__(self, road_map: RoadMap, lanes: Sequence[str]) -> None:
        self._map = road_map
        self._lanes = lanes
        self._index = {name: i for i, name in enumerate(road_map.lanes)}
        self._known = np.empty((4, 0), dtype=np.int32)

    def read(self, frame: Frame) -> TruePlaces:
        """Return the places of all vehicles of *frame*."""
        lane = frame.hidden["lane"]
        self._learn()
        on_lane = lane >= 0
        found = (
            np.where(on_lane, self._known[:, lane], np.int32(-1))
            if self._known.size
            else (np.full((4, len(lane)), -1, dtype=np.int32))
        )
        link, crossing, road, opposite = found
        position = frame.vehicles["position"]
        s, d = self._map.project(position, road)
        along = self._map.heading_at(road, s)
        against = np.cos(frame.vehicles["heading"] - along) < 0  # false where it is NaN
        crossed = against & (opposite >= 0)
        if crossed.any():
            road = np.where(crossed, opposite, road)
            s[crossed], d[crossed] = self._map.project(position[crossed], road[crossed])
        sign = np.where(against & ~crossed, -1.0, 1.0)
        direction = self._map.direction_in_link[road] * sign
        progress = direction * self._map.position_along_link(road, s)
        return TruePlaces(link, crossing, direction, progress, road, s, d)

    def _learn(self) -> None:
        """Look up the lanes that the simulator has named since the last frame."""
        fresh = self._lanes[self._known.shape[1] :]
        if fresh:
            rows = np.array([self._look_up(name) for name in fresh], dtype=np.int32)
            self._known = np.hstack([self._known, rows.T])

    def _look_up(self, lane: str) -> tuple[int, int, int, int]:
        """Return link, crossing, road and opposite road of a lane of the simulator, or -1."""
        edge = lane.rpartition("_")[0]
        columns = self._map.lane_columns
        index = self._index.get(lane, -1)
        road = int(columns.road[index]) if index >= 0 else -1
        beside = int(columns.opposite[index]) if index >= 0 else -1
        opposite = int(columns.road[beside]) if beside >= 0 else -1
        link = self._map.link_of_edge.get(edge, -1)
        crossing = self._map.crossing_of_edge.get(edge, -1)
        return link, crossing, road, opposite

"""Who truly drives against the direction."""

import math

import numpy as np
import numpy.typing as npt

from dyknow.time import SECOND, Duration
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces
from traffic.truth.stretches import Stretch, Stretches

__all__ = ["WrongWayWatcher"]

_WRONG_WAY = Duration(5 * SECOND)
"""How long one drives against the direction at least."""

_AGAINST = math.cos(math.radians(120.0))
_MOVING = 1.0
_REACH = 60.0


class WrongWayWatcher:
    """Watches who drives against the direction of the lane that they are on.

    A vehicle does so while its body's centre is on a lane whose direction differs from its
    heading by more than 120°, and it is faster than 1 m/s. It drives the wrong way if it does so
    for at least 5 s and draws level with nobody who travels the same way on the same link: with
    nobody that was up to 60 m ahead of it, clear of it, at some time of the stretch. Who
    overtakes, even if it is broken off beside the other, is on the other side for a reason.

    Args:
        road_map: The map.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._stretches: Stretches[int] = Stretches()
        self._ahead: dict[int, set[int]] = {}
        self._passing: set[int] = set()

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return who drove the wrong way until the one before it."""
        rows = np.flatnonzero(self._goes_against(frame))
        ids = frame.vehicles.ids[rows].tolist()
        found = self._told(self._stretches.observe(frame.time, ids))
        self._ahead = {one: self._ahead.get(one, set()) for one in ids}
        self._passing &= set(ids)
        for vehicle, row in zip(ids, rows.tolist(), strict=True):
            self._look_ahead(vehicle, row, frame, places)
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return who drives the wrong way at the end."""
        return self._told(self._stretches.finish())

    def _goes_against(self, frame: Frame) -> npt.NDArray[np.bool_]:
        vehicles = frame.vehicles
        position = vehicles["position"]
        lane = self._map.locate(position).lane
        against = np.zeros(len(vehicles), dtype=np.bool_)
        (on_lane,) = np.nonzero((lane >= 0) & (vehicles["speed"] > _MOVING))
        lines = self._map.lane_columns.lines
        s, _ = lines.project(position[on_lane], lane[on_lane])
        along = lines.heading_at(lane[on_lane], s)
        against[on_lane] = np.cos(vehicles["heading"][on_lane] - along) < _AGAINST
        return against

    def _look_ahead(self, vehicle: int, row: int, frame: Frame, places: TruePlaces) -> None:
        """Note whom the vehicle in *row* follows, and whether it has drawn level with one."""
        same_way = (places.link == places.link[row]) & (places.link >= 0)
        same_way &= places.direction == places.direction[row]
        same_way[row] = False
        gap = places.progress - places.progress[row]
        length = frame.vehicles["length"]
        clear = (length + length[row]) / 2
        ids = frame.vehicles.ids
        ahead = set(ids[same_way & (gap > clear) & (gap <= _REACH)].tolist())
        level = set(ids[same_way & (gap <= clear)].tolist())
        if self._ahead[vehicle] & level:
            self._passing.add(vehicle)
        self._ahead[vehicle] |= ahead

    def _told(self, stretches: list[Stretch[int]]) -> list[TrueManoeuvre]:
        return [
            TrueManoeuvre("wrong_way", (vehicle,), (), begin, end)
            for vehicle, begin, end in stretches
            if end - begin >= _WRONG_WAY and vehicle not in self._passing
        ]

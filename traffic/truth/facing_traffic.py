"""Who truly overtakes in the face of oncoming traffic."""

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from dyknow.time import SECOND, Duration, TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.overtakes import OvertakeWatcher
from traffic.truth.places import TruePlaces

__all__ = ["FacingTrafficWatcher"]

_HORIZON = 4.0
_BEFORE = Duration(8 * SECOND)
_AGAINST = math.cos(math.radians(120.0))
_SLOWEST = 0.1

_Pair = tuple[int, int]


class FacingTrafficWatcher:
    """Watches who overtakes while somebody comes, on whose side it is, and whom it meets soon.

    A vehicle is on the other side while its body's centre is on a lane whose direction differs
    from its heading by more than 120°. It *faces* another one while it is there and that one
    comes towards it on the same link, so that at the speeds of both their bumpers would touch
    within 4 s. An `overtake_facing_traffic` is an overtake of A and B (`OvertakeWatcher`) with
    every C that A begins to face from 8 s before the begin of the overtake to its end; it takes
    as long as the overtake. The vehicles are A, B and C.

    Args:
        road_map: The map.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._overtakes = OvertakeWatcher.on(road_map)
        self._facing: frozenset[_Pair] = frozenset()
        self._began: dict[_Pair, list[TimePoint]] = {}

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return who overtook like this until now."""
        facing = frozenset(self._pairs(frame, places))
        for pair in facing - self._facing:
            self._began.setdefault(pair, []).append(frame.time)
        self._facing = facing
        overtakes = self._overtakes.observe(frame, places)
        return [one for each in overtakes if each.kind == "overtake" for one in self._told(each)]

    def finish(self) -> list[TrueManoeuvre]:
        """Return nothing: who is beside another at the end has not overtaken it yet."""
        return []

    def _told(self, overtake: TrueManoeuvre) -> Iterator[TrueManoeuvre]:
        driver = overtake.vehicles[0]
        for (one, other), times in self._began.items():
            first, last = overtake.begin - _BEFORE, overtake.end
            if one == driver and any(first <= time <= last for time in times):
                vehicles = (*overtake.vehicles, other)
                yield TrueManoeuvre(
                    "overtake_facing_traffic", vehicles, (), overtake.begin, overtake.end
                )

    def _pairs(self, frame: Frame, places: TruePlaces) -> Iterator[_Pair]:
        """Yield who faces whom in a frame."""
        vehicles = frame.vehicles
        half, speed = vehicles["length"] / 2, vehicles["speed"]
        for row in np.flatnonzero(self._goes_against(frame) & (places.link >= 0)).tolist():
            comes = (places.link == places.link[row]) & (
                places.direction == -places.direction[row]
            )
            # Progress counts in the direction of travel: of who comes, the other way.
            way = -places.progress - places.progress[row]
            gap = np.maximum(way - half - half[row], 0.0)
            soon = gap < _HORIZON * np.maximum(speed + speed[row], _SLOWEST)
            for other in np.flatnonzero(comes & (way > 0) & soon).tolist():
                yield int(vehicles.ids[row]), int(vehicles.ids[other])

    def _goes_against(self, frame: Frame) -> npt.NDArray[np.bool_]:
        position = frame.vehicles["position"]
        lane = self._map.locate(position).lane
        against = np.zeros(len(frame.vehicles), dtype=np.bool_)
        (on_lane,) = np.nonzero(lane >= 0)
        lines = self._map.lane_columns.lines
        s, _ = lines.project(position[on_lane], lane[on_lane])
        along = lines.heading_at(lane[on_lane], s)
        against[on_lane] = np.cos(frame.vehicles["heading"][on_lane] - along) < _AGAINST
        return against

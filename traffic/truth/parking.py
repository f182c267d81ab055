"""Who truly parks beside a building."""

import numpy as np
import numpy.typing as npt
import shapely

from dyknow.time import SECOND, Duration, TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces

__all__ = ["ParkingWatcher"]

_WITHIN = 8.0
_STANDING = 0.1
_ASIDE = 0.6
_LONG_ENOUGH = Duration(20 * SECOND)

_FAR = 30.0


class ParkingWatcher:
    """Looks at all vehicles that stand.

    A vehicle parks beside a building if for at least 20 s it is slower than 0.1 m/s, the nearest
    building is at most 8 m from its centre, and its centre is at least 0.6 m from the middle of
    the outer lane of the nearest road, to the outer side: at the kerb, or off the lane. The place
    is the building.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._stands: dict[int, tuple[int, TimePoint, TimePoint]] = {}

    def observe(self, frame: Frame, _: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return the parking that is over with it."""
        (rows,) = np.nonzero(frame.vehicles["speed"] < _STANDING)
        position = frame.vehicles["position"][rows]
        aside = self._are_aside(position, frame.vehicles["heading"][rows])
        buildings = self._map.surroundings.buildings
        found: list[TrueManoeuvre] = []
        still: dict[int, tuple[int, TimePoint, TimePoint]] = {}
        for row, where, is_aside in zip(rows, position, aside, strict=True):
            if not is_aside or not len(buildings):
                continue
            distance = shapely.distance(buildings, shapely.Point(where))
            building = int(np.argmin(distance))
            if distance[building] > _WITHIN:
                continue
            vehicle = int(frame.vehicles.ids[row])
            before = self._stands.get(vehicle)
            since = before[1] if before is not None and before[0] == building else frame.time
            still[vehicle] = (building, since, frame.time)
        for vehicle, was in self._stands.items():
            if vehicle not in still or still[vehicle][0] != was[0]:
                found += self._told(vehicle, *was)
        self._stands = still
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return the parking that still goes on."""
        return [each for item, was in self._stands.items() for each in self._told(item, *was)]

    def _are_aside(
        self, position: npt.NDArray[np.float64], heading: npt.NDArray[np.float64]
    ) -> npt.NDArray[np.bool_]:
        """Return who is at least 0.6 m from the middle of the outer lane of the nearest road."""
        forward = np.column_stack([np.cos(heading), np.sin(heading)])
        road = self._map.match(position, forward, _FAR)
        _, d = self._map.project(position, road)
        lanes, outwards = self._map.lane_columns, 1 if self._map.left_hand else -1
        outer = [lanes.width[lanes.road == each][0] if each >= 0 else 0.0 for each in road]
        middle = outwards * (self._map.road_width[road] - np.array(outer)) / 2
        aside: npt.NDArray[np.bool_] = (road >= 0) & (outwards * (d - middle) >= _ASIDE)
        return aside

    def _told(
        self, vehicle: int, building: int, begin: TimePoint, end: TimePoint
    ) -> list[TrueManoeuvre]:
        if end - begin < _LONG_ENOUGH:
            return []
        place = (self._map.surroundings.names[building],)
        return [TrueManoeuvre("parking_beside_building", (vehicle,), place, begin, end)]

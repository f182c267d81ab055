"""Who truly nearly collides."""

from dataclasses import dataclass

import numpy as np

from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint
from networks.prediction import Bodies, first_touch
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces

__all__ = ["NearCollisionWatcher"]

_HORIZON = 1.0
_FOLLOWING = 0.85
_STEP = 0.05
_TIMES = np.arange(0.0, _HORIZON + _STEP / 2, _STEP)
_CLOSING = 4.0
_MOVING = 1.0
_ALIGNED = 0.8
_REACH = 40.0
_LONG_ENOUGH = Duration(200 * MILLISECOND)
_BREAK = Duration(100 * MILLISECOND)
_APART = Duration(3 * SECOND)


@dataclass(slots=True)
class _Episode:
    """A collision course of two vehicles, with short breaks."""

    begin: TimePoint
    end: TimePoint
    since: TimePoint
    is_long_enough: bool = False


class NearCollisionWatcher:
    """Looks ahead along the roads of all vehicles that are near each other.

    Two vehicles nearly collide if for at least 0.2 s their bodies would touch within 1 s, or
    within 0.85 s if they travel the same way, were each to keep its speed and its distance from
    the middle of its road; their velocities differ by at least 4 m/s; and both are faster than
    1 m/s, or one of them follows the other on one road. Drivers who brake by 4.5 m/s² and leave
    2.5 m to a vehicle that stands never come nearer to it than 1.05 s. What is less than 3 s
    apart is one near collision.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._going_on: dict[tuple[int, int], _Episode] = {}

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return the near collisions that are over with it."""
        now = frame.time
        for pair in self._on_collision_course(frame, places):
            episode = self._going_on.setdefault(pair, _Episode(now, now, now))
            if now - episode.end > _BREAK:
                episode.since = now
            episode.end = now
            episode.is_long_enough |= now - episode.since >= _LONG_ENOUGH
        over = [pair for pair, each in self._going_on.items() if now - each.end > _APART]
        return [found for pair in over for found in _told(pair, self._going_on.pop(pair))]

    def finish(self) -> list[TrueManoeuvre]:
        """Return the near collisions that may still go on."""
        return [found for pair, each in self._going_on.items() for found in _told(pair, each)]

    def _on_collision_course(self, frame: Frame, places: TruePlaces) -> list[tuple[int, int]]:
        (rows,) = np.nonzero(places.road >= 0)
        vehicles = frame.vehicles.select(rows)
        road, speed, heading = places.road[rows], vehicles["speed"], vehicles["heading"]
        forward = np.column_stack([np.cos(heading), np.sin(heading)])
        velocity, position = speed[:, None] * forward, vehicles["position"]
        first, second = np.triu_indices(len(rows), k=1)
        near = np.linalg.norm(position[first] - position[second], axis=1) <= _REACH
        closing = np.linalg.norm(velocity[first] - velocity[second], axis=1) >= _CLOSING
        aligned = (forward[first] * forward[second]).sum(axis=1) > _ALIGNED
        follows = aligned & (road[first] == road[second])
        both = np.minimum(speed[first], speed[second]) >= _MOVING
        (asked,) = np.nonzero(near & closing & (follows | both))
        pairs = first[asked], second[asked]
        length, width = vehicles["length"], vehicles["width"]
        bodies = Bodies(road, places.s[rows], places.d[rows], speed, length, width)
        touched = first_touch(self._map, bodies, pairs, _TIMES)
        soon = touched <= np.where(aligned[asked], _FOLLOWING, _HORIZON) + _STEP / 2
        ids = np.sort(np.column_stack([vehicles.ids[each[soon]] for each in pairs]), axis=1)
        return [(one, other) for one, other in ids.tolist()]


def _told(pair: tuple[int, int], episode: _Episode) -> list[TrueManoeuvre]:
    if not episode.is_long_enough:
        return []
    return [TrueManoeuvre("near_collision", pair, (), episode.begin, episode.end)]

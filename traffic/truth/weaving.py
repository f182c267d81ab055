"""Who truly weaves."""

from collections import deque
from dataclasses import dataclass, field

from dyknow.time import SECOND, Duration, TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces

__all__ = ["WeavingWatcher"]

_LEAST = 0.7
_MOST = 2.6
_ENOUGH = 4
_REST = Duration(6 * SECOND)
_WITHIN = Duration(20 * SECOND)
_MOVING = 3.0


class WeavingWatcher:
    """Follows where each vehicle is across its road.

    A swing is a movement of the body's centre to one side by at least 0.7 m and at most 2.6 m,
    which is narrower than a change of lanes; it counts from the moment at which it has been going
    for 0.7 m, and ends where the vehicle has come back by as much. A vehicle weaves that makes
    at least four swings within 20 s, to the left and to the right in turn. It goes on weaving
    until it has not begun a swing for 6 s, changes lanes, is slower than 3 m/s, or leaves the
    link. The manoeuvre lasts from its first swing to its last one.
    """

    def __init__(self) -> None:
        self._tracks: dict[int, _Track] = {}

    @classmethod
    def on(cls, _: RoadMap) -> "WeavingWatcher":
        """Return a watcher, which is the same for every map."""
        return cls()

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return the weaving that is over with it."""
        found: list[TrueManoeuvre] = []
        vehicles = frame.vehicles
        here = set(vehicles.ids.tolist())
        for gone in self._tracks.keys() - here:
            found += _told(gone, self._tracks.pop(gone))
        rows = zip(
            vehicles.ids.tolist(),
            (vehicles["speed"] >= _MOVING).tolist(),
            places.link.tolist(),
            places.direction.tolist(),
            places.road.tolist(),
            places.d.tolist(),
            strict=True,
        )
        for vehicle, moves, link, direction, road, d in rows:
            track = self._tracks.setdefault(vehicle, _Track())
            way = (link, direction) if moves and link >= 0 else None
            if track.is_over(way, frame.time):
                found += _told(vehicle, track)
                track = self._tracks[vehicle] = _Track(way=way)
            if way is not None:
                track.go_on(frame.time, road, d)
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return the weaving that still goes on."""
        return [each for item in self._tracks.items() for each in _told(*item)]


@dataclass(slots=True)
class _Track:
    """How one vehicle has been swinging on one link.

    Attributes:
        way: The link and the direction along it; None while the vehicle stands or is elsewhere.
        road: The road on which it is.
        offset: What is added to places across that road, so that they go on from the last one.
        across: Where it is, metres to the left.
        side: 1 if it last swung to the left, -1 to the right, 0 if it has not.
        furthest: How far it has got to that side.
        began: Where that swing began.
        low: While it has not swung: the place furthest to the right.
        high: While it has not swung: the place furthest to the left.
        swings: When its swings were 0.7 m wide.
        is_enough: Whether four of them came within 20 s.
    """

    way: tuple[int, float] | None = None
    road: int = -1
    offset: float = 0.0
    across: float = 0.0
    side: int = 0
    furthest: float = 0.0
    began: float = 0.0
    low: float = float("inf")
    high: float = float("-inf")
    swings: list[TimePoint] = field(default_factory=list)
    latest: deque[TimePoint] = field(default_factory=lambda: deque(maxlen=_ENOUGH))
    is_enough: bool = False

    def is_over(self, way: tuple[int, float] | None, time: TimePoint) -> bool:
        """Whether nothing that comes belongs to what has been."""
        has_rested = bool(self.swings) and time - self.swings[-1] > _REST
        return way != self.way or has_rested or abs(self.furthest - self.began) > _MOST

    def go_on(self, time: TimePoint, road: int, d: float) -> None:
        """Take in where the vehicle is now."""
        if self.road not in (-1, road):
            self.offset += self.across - (d + self.offset)
        self.road, self.across = road, d + self.offset
        across = self.across
        if self.side == 0:
            self.low, self.high = min(self.low, across), max(self.high, across)
            for side, began in ((1, self.low), (-1, self.high)):
                if side * (across - began) >= _LEAST:
                    self._turn(side, began, time)
        elif self.side * (self.furthest - across) >= _LEAST:
            self._turn(-self.side, self.furthest, time)
        elif self.side * (across - self.furthest) > 0:
            self.furthest = across

    def _turn(self, side: int, began: float, time: TimePoint) -> None:
        self.side, self.began, self.furthest = side, began, self.across
        self.swings.append(time)
        self.latest.append(time)
        self.is_enough |= len(self.latest) == _ENOUGH and time - self.latest[0] <= _WITHIN


def _told(vehicle: int, track: _Track) -> list[TrueManoeuvre]:
    if not track.is_enough:
        return []
    return [TrueManoeuvre("weaving", (vehicle,), (), track.swings[0], track.swings[-1])]

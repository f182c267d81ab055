"""Who truly stands inside a crossing."""

import numpy as np

from dyknow.time import SECOND, Duration
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces
from traffic.truth.stretches import Stretch, Stretches

__all__ = ["StandingWatcher"]

_STANDING = Duration(5 * SECOND)
"""How long one stands at least."""

_RESTS = 0.3
_MOVES = 1.0


class StandingWatcher:
    """Watches who stands inside a crossing, for whatever reason.

    A vehicle stands from when it is slower than 0.3 m/s until it is faster than 1 m/s. It stops
    in a crossing if it stands for at least 5 s while its body's centre is in the area of the
    crossing. The place is the crossing.

    Args:
        road_map: The map.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._map = road_map
        self._standing: set[int] = set()
        self._stretches: Stretches[tuple[int, int]] = Stretches()

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return who stopped standing in a crossing before it."""
        del places  # where the front bumper is says nothing of the centre
        vehicles = frame.vehicles
        speed = vehicles["speed"]
        was = np.array([one in self._standing for one in vehicles.ids.tolist()], dtype=np.bool_)
        stands = (speed < _RESTS) | (was & (speed <= _MOVES))
        self._standing = set(vehicles.ids[stands].tolist())
        rows = np.flatnonzero(stands)
        crossing = self._map.locate(vehicles["position"][rows]).crossing
        inside = rows[crossing >= 0]
        keys = zip(vehicles.ids[inside].tolist(), crossing[crossing >= 0].tolist(), strict=True)
        return self._told(self._stretches.observe(frame.time, keys))

    def finish(self) -> list[TrueManoeuvre]:
        """Return who stands in a crossing at the end."""
        return self._told(self._stretches.finish())

    def _told(self, stretches: list[Stretch[tuple[int, int]]]) -> list[TrueManoeuvre]:
        return [
            TrueManoeuvre(
                "stop_in_crossing", (vehicle,), (self._map.crossings[crossing],), begin, end
            )
            for (vehicle, crossing), begin, end in stretches
            if end - begin >= _STANDING
        ]

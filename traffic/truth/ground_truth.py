"""All that is known for certain about what vehicles did."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from dyknow.time import Duration, TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.overtakes import OvertakeWatcher, TrueOvertake
from traffic.truth.places import PlaceReader
from traffic.truth.turns import TrueTurn, TurnWatcher
from traffic.truth.visibility import Visibility, inside

__all__ = ["GroundTruth", "Manoeuvre"]

Manoeuvre = TrueTurn | TrueOvertake
Points = npt.NDArray[np.float64]

_NO_MARGIN = Duration(0)


class GroundTruth:
    """Watches the simulator's vehicles and knows every turn and every overtake.

    What a turn and an overtake are stands at `TurnWatcher` and `OvertakeWatcher`. A manoeuvre is
    in view if all of its vehicles were inside the footprint in every frame from *margin* before
    its begin to *margin* after its end.

    Args:
        road_map: The map of the simulated network.
        lanes: The simulator's name of each lane number; may grow.
        margin: See above.
    """

    def __init__(
        self, road_map: RoadMap, lanes: Sequence[str], margin: Duration = _NO_MARGIN
    ) -> None:
        self._places = PlaceReader(road_map, lanes)
        self._turn_watcher = TurnWatcher(road_map.turns)
        self._overtake_watcher = OvertakeWatcher()
        self._visibility = Visibility()
        self._margin = margin
        self._judged: list[Manoeuvre] = []
        self._pending: list[Manoeuvre] = []

    def observe(self, frame: Frame, footprint: Points | None = None) -> None:
        """Take in the next frame.

        Args:
            frame: Of the simulation; all frames of it, in order.
            footprint: The ground that the camera sees, shape (k, 2), metres in the world frame;
                without it everything is in view.
        """
        ids, position = frame.vehicles.ids, frame.vehicles["position"]
        places = self._places.read(frame)
        self._visibility.observe(frame.time, ids, in_view=inside(position, footprint))
        self._pending += self._turn_watcher.observe(frame.time, ids, places)
        self._pending += self._overtake_watcher.observe(frame.time, frame.vehicles, places)
        self._judge(frame.time)

    def turns(self) -> list[TrueTurn]:
        """Return all turns so far, in order of their ends."""
        return [found for found in self._all() if isinstance(found, TrueTurn)]

    def overtakes(self) -> list[TrueOvertake]:
        """Return all overtakes so far, in order of their ends."""
        return [found for found in self._all() if isinstance(found, TrueOvertake)]

    def _all(self) -> list[Manoeuvre]:
        """Return all manoeuvres; those that ended too late to be judged are not in view."""
        return [*self._judged, *(replace(found, in_view=False) for found in self._pending)]

    def _judge(self, now: TimePoint) -> None:
        """Decide which manoeuvres were in view, as soon as their margin is over."""
        due = [found for found in self._pending if found.end + self._margin <= now]
        self._pending = [found for found in self._pending if found.end + self._margin > now]
        self._judged += [replace(found, in_view=self._was_in_view(found)) for found in due]

    def _was_in_view(self, found: Manoeuvre) -> bool:
        needed = found.begin - self._margin
        since = [self._visibility.since(vehicle) for vehicle in found.vehicles]
        return all(began is not None and began <= needed for began in since)

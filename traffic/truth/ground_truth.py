"""All that is known for certain about what vehicles did."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from dyknow.time import TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import PlaceReader
from traffic.truth.visibility import Visibility, inside
from traffic.truth.watchers import WATCHERS, Definition

__all__ = ["GroundTruth"]

Points = npt.NDArray[np.float64]


class GroundTruth:
    """Watches the simulator's vehicles and knows every manoeuvre of certain kinds.

    What a manoeuvre of a kind is stands at its watcher. It is in view if all of its vehicles were
    inside the footprint in every frame from the margin of its kind before its begin to so long
    after its end.

    Args:
        road_map: The map of the simulated network.
        lanes: The simulator's name of each lane number; may grow.
        kinds: What is to be known; by default everything.
    """

    def __init__(
        self,
        road_map: RoadMap,
        lanes: Sequence[str],
        kinds: Mapping[str, Definition] = WATCHERS,
    ) -> None:
        self._places = PlaceReader(road_map, lanes)
        makers = dict.fromkeys(definition.watcher for definition in kinds.values())
        self._watchers = [make(road_map) for make in makers]
        self._visibility = Visibility()
        self._kinds = kinds
        self._judged: list[TrueManoeuvre] = []
        self._pending: list[TrueManoeuvre] = []

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
        for watcher in self._watchers:
            self._pending += self._wanted(watcher.observe(frame, places))
        self._judge(frame.time)

    def manoeuvres(self) -> list[TrueManoeuvre]:
        """Return all manoeuvres so far, in order of their ends.

        Those that go on, or ended too late to be judged, are not in view.
        """
        going_on = [
            found for watcher in self._watchers for found in self._wanted(watcher.finish())
        ]
        unseen = [replace(found, in_view=False) for found in (*self._pending, *going_on)]
        return sorted([*self._judged, *unseen], key=lambda found: found.end)

    def _wanted(self, found: Sequence[TrueManoeuvre]) -> list[TrueManoeuvre]:
        return [each for each in found if each.kind in self._kinds]

    def _judge(self, now: TimePoint) -> None:
        """Decide which manoeuvres were in view, as soon as their margin is over."""
        due = [found for found in self._pending if self._is_due(found, now)]
        self._pending = [found for found in self._pending if not self._is_due(found, now)]
        self._judged += [replace(found, in_view=self._was_in_view(found)) for found in due]

    def _is_due(self, found: TrueManoeuvre, now: TimePoint) -> bool:
        return found.end + self._kinds[found.kind].margin <= now

    def _was_in_view(self, found: TrueManoeuvre) -> bool:
        needed = found.begin - self._kinds[found.kind].margin
        since = [self._visibility.since(vehicle) for vehicle in found.vehicles]
        return all(began is not None and began <= needed for began in since)

"""All that is known for certain about what vehicles did."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

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
    after its end. Of a kind that says which part is enough, so long a part must have been in view,
    with the margin before and after; it may go on at the end.

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
        self._found: list[TrueManoeuvre] = []

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
            self._found += self._wanted(watcher.observe(frame, places))

    def manoeuvres(self) -> list[TrueManoeuvre]:
        """Return all manoeuvres so far, in order of their ends."""
        going_on = [
            found for watcher in self._watchers for found in self._wanted(watcher.finish())
        ]
        judged = [
            *(replace(found, in_view=self._was_in_view(found)) for found in self._found),
            *(replace(found, in_view=self._has_been_in_view(found)) for found in going_on),
        ]
        return sorted(judged, key=lambda found: found.end)

    def _wanted(self, found: Sequence[TrueManoeuvre]) -> list[TrueManoeuvre]:
        return [each for each in found if each.kind in self._kinds]

    def _has_been_in_view(self, going_on: TrueManoeuvre) -> bool:
        part = self._kinds[going_on.kind].part
        return part is not None and self._was_in_view(going_on)

    def _was_in_view(self, found: TrueManoeuvre) -> bool:
        definition = self._kinds[found.kind]
        lasted = found.end - found.begin
        needed = lasted if definition.part is None else min(lasted, definition.part)
        return any(
            min(last - definition.margin, found.end) - max(first + definition.margin, found.begin)
            >= needed
            for first, last in self._visibility.common_spans(found.vehicles)
        )

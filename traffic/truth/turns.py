"""The true passages of vehicles through crossings."""

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Ids
from dyknow.time import TimePoint
from networks.roads import RoadMap
from networks.turns import Turns
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces

__all__ = ["TurnWatcher"]


class TurnWatcher:
    """Follows vehicles through crossings.

    The kinds are `turn_left`, `turn_right`, `turn_straight` and `turn_uturn`.
    The place of a turn is the link from which the vehicle came, the crossing, and the link on
    which it went on, which may be the same. It begins in the first frame in which the front
    bumper is in the crossing and ends in the first in which it is on the second link.

    A vehicle makes a turn when it is on a link, then for one or more frames in one crossing, then
    on a link, and in no frame of these nowhere or missing; the simulator's lanes decide which
    link or crossing it is in. If the steps are so long that a vehicle is never found in the
    crossing, it counts as having been there at the first frame on the second link, provided that
    only one crossing lies between the links. Turns that the road map does not know are left out.

    Args:
        turns: How one turns, by link, crossing and link.
        links: Names of the links.
        crossings: Names of the crossings.
    """

    def __init__(self, turns: Turns, links: Sequence[str], crossings: Sequence[str]) -> None:
        self._turns = turns
        self._links = links
        self._crossings = crossings
        self._between: dict[tuple[int, int], set[int]] = {}
        for link1, crossing, link2 in turns:
            self._between.setdefault((link1, link2), set()).add(crossing)
        self._frame = 0
        self._link, self._crossing = np.full((2, 0), -1, dtype=np.int64)
        self._entered, self._last = np.full((2, 0), -1, dtype=np.int64)

    @classmethod
    def on(cls, road_map: RoadMap) -> "TurnWatcher":
        """Return a watcher of the turns that a map knows."""
        return cls(road_map.turns, road_map.links, road_map.crossings)

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return the turns that end in it."""
        time, ids = frame.time, frame.vehicles.ids
        self._frame += 1
        self._make_room(ids)
        broken = (self._last[ids] != self._frame - 1) | ((places.link < 0) & (places.crossing < 0))
        self._link[ids[broken]] = self._crossing[ids[broken]] = -1
        self._last[ids] = self._frame
        self._enter(time, ids, places)
        return list(self._leave(time, ids, places))

    def finish(self) -> list[TrueManoeuvre]:
        """Return nothing: where a vehicle in a crossing will go is not known."""
        return []

    def _enter(self, time: TimePoint, ids: Ids, places: TruePlaces) -> None:
        entering = (places.crossing >= 0) & (places.crossing != self._crossing[ids])
        who = ids[entering]
        self._link[who[self._crossing[who] >= 0]] = -1  # from one crossing straight to another
        self._crossing[who] = places.crossing[entering]
        self._entered[who] = time

    def _leave(self, time: TimePoint, ids: Ids, places: TruePlaces) -> Iterator[TrueManoeuvre]:
        link = places.link
        before, through = self._link[ids], self._crossing[ids]
        leaving = (link >= 0) & (before >= 0) & ((through >= 0) | (before != link))
        for row in np.flatnonzero(leaving):
            vehicle, ways = int(ids[row]), (int(before[row]), int(link[row]))
            crossing, entered = int(through[row]), int(self._entered[vehicle])
            if crossing < 0:
                candidates = self._between.get(ways, set())
                crossing, entered = (min(candidates), time) if len(candidates) == 1 else (-1, time)
            turn = self._turns.get((ways[0], crossing, ways[1]))
            if turn is not None:
                yield TrueManoeuvre(
                    f"turn_{turn.value}",
                    (vehicle,),
                    (self._links[ways[0]], self._crossings[crossing], self._links[ways[1]]),
                    TimePoint(entered),
                    time,
                )
        on_link = link >= 0
        self._link[ids[on_link]] = link[on_link]
        self._crossing[ids[on_link]] = -1

    def _make_room(self, ids: Ids) -> None:
        missing = int(ids.max(initial=-1)) + 1 - len(self._last)
        if missing > 0:
            room: npt.NDArray[np.int64] = np.full(missing + 64, -1, dtype=np.int64)
            self._link = np.append(self._link, room)
            self._crossing = np.append(self._crossing, room)
            self._entered = np.append(self._entered, room)
            self._last = np.append(self._last, room)

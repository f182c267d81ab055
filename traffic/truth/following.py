"""Who truly tailgates, drives in a convoy, or is followed."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from dyknow.time import SECOND, Duration
from networks.ahead import RoadsAhead
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces
from traffic.truth.stretches import Stretch, Stretches
from traffic.truth.turns import TurnWatcher

__all__ = ["CONVOY", "TAILGATING", "FollowedWatcher", "FollowingWatcher"]

TAILGATING = Duration(4 * SECOND)
"""How long tailgating lasts at least."""

CONVOY = Duration(20 * SECOND)
"""How long a convoy lasts at least."""

_REACH = 90.0
_HALF_LANE = 1.6
_PLAY = 0.8
_DETOUR = 1.0
_NEAR = 2.5
_CLOSE = 0.7
_MOVING = 3.0
_FAST = 8.0
_SLACK = 1.25
_SLOWEST = 0.1

_BEHIND = Duration(15 * SECOND)
_ASIDE = frozenset({"turn_left", "turn_right"})

Floats = npt.NDArray[np.float64]
Pair = tuple[int, int]
Three = tuple[int, int, int]


class FollowingWatcher:
    """Measures the time gap between each vehicle and the next one ahead on its lane.

    The roads lead from the one to the other, through crossings too, within 90 m; it is at most
    1.6 m aside (0.8 m more inside crossings and between roads of different widths, where lanes
    shift); and nobody else drives on the way between them. Where ways part there may be one on
    each of them. The time gap is the gap between the bumpers, divided by the speed of the one
    behind.

    * `tailgating`, (who does it, the one ahead): the time gap is less than 0.7 s at more than
      8 m/s, for at least 4 s.
    * `convoy`, (first, second, third): the third follows the second and the second the first, for
      at least 20 s. Who is at most 2.5 s behind follows, if both drive more than 3 m/s.

    What goes on stays so up to a time gap one and a quarter times as long and down to speeds one
    and a quarter times lower, because a state that is left for a moment and by little has not
    ended. A manoeuvre lasts from the first frame to the last, however long.

    Args:
        road_map: The map.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._ahead = RoadsAhead(road_map, _REACH)
        self._width = np.asarray(road_map.road_width, dtype=np.float64)
        self._in_crossing = road_map.crossing_of_road >= 0
        self._follows: Stretches[Pair] = Stretches()
        self._tailgates: Stretches[Pair] = Stretches()
        self._convoys: Stretches[Three] = Stretches()

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return the manoeuvres that ended before it."""
        gaps = list(self._gaps(frame, places))
        follows = {gap.pair for gap in gaps if gap.follows(gap.pair in self._follows)}
        tailgates = {gap.pair for gap in gaps if gap.tailgates(gap.pair in self._tailgates)}
        self._follows.observe(frame.time, follows)
        return [
            *_lasting("tailgating", TAILGATING, self._tailgates.observe(frame.time, tailgates)),
            *_lasting("convoy", CONVOY, self._convoys.observe(frame.time, _threes(follows))),
        ]

    def finish(self) -> list[TrueManoeuvre]:
        """Return what goes on in the last frame."""
        return [
            *_lasting("tailgating", TAILGATING, self._tailgates.finish()),
            *_lasting("convoy", CONVOY, self._convoys.finish()),
        ]

    def _gaps(self, frame: Frame, places: TruePlaces) -> Iterator["_Gap"]:
        """Yield the gaps between vehicles and the next ones ahead."""
        vehicles = frame.vehicles
        first, second, distance = self._ahead.pairs(places.road, places.s)
        width, in_crossing = self._width[places.road], self._in_crossing[places.road]
        loose = in_crossing[first] | in_crossing[second] | (width[first] != width[second])
        allowed = _HALF_LANE + np.where(loose, _PLAY, 0.0)
        in_lane = np.abs(places.d[first] - places.d[second]) <= allowed
        first, second, distance = first[in_lane], second[in_lane], distance[in_lane]
        rows = _next_ones(first.tolist(), second.tolist(), distance.tolist())
        behind, ahead = first[rows], second[rows]
        length, speed = vehicles["length"], vehicles["speed"]
        gap = distance[rows] - (length[behind] + length[ahead]) / 2
        columns = (
            vehicles.ids[behind],
            vehicles.ids[ahead],
            gap / np.maximum(speed[behind], _SLOWEST),
            speed[behind],
            speed[ahead],
        )
        for one, other, time_gap, *speeds in zip(*(c.tolist() for c in columns), strict=True):
            yield _Gap((one, other), time_gap, speeds[0], min(speeds))


class _Gap(NamedTuple):
    """How a vehicle is behind the next one.

    Attributes:
        pair: The one behind and the one ahead.
        time_gap: Between them, seconds.
        speed: Of the one behind, m/s.
        slower: The lower speed of both, m/s.
    """

    pair: Pair
    time_gap: float
    speed: float
    slower: float

    def follows(self, before: bool) -> bool:  # noqa: FBT001, whether it did so before
        slack = _SLACK if before else 1.0
        return self.time_gap <= slack * _NEAR and slack * self.slower > _MOVING

    def tailgates(self, before: bool) -> bool:  # noqa: FBT001, whether it did so before
        slack = _SLACK if before else 1.0
        return self.time_gap < slack * _CLOSE and slack * self.speed > _FAST


def _next_ones(first: list[int], second: list[int], distance: list[float]) -> list[int]:
    """Return the numbers of the pairs on whose way nobody else is."""
    ahead_of: dict[int, dict[int, float]] = {}
    for one, other, apart in zip(first, second, distance, strict=True):
        ahead_of.setdefault(one, {})[other] = apart
    return [
        i
        for i, (one, other, apart) in enumerate(zip(first, second, distance, strict=True))
        if not any(
            near + ahead_of.get(third, {}).get(other, np.inf) <= apart + _DETOUR
            for third, near in ahead_of[one].items()
        )
    ]


def _threes(follows: Iterable[Pair]) -> list[Three]:
    """Return first, second and third of all that follow one another."""
    behind: dict[int, list[int]] = {}
    for one, ahead in sorted(follows):
        behind.setdefault(ahead, []).append(one)
    return [
        (first, second, third)
        for first, seconds in behind.items()
        for second in seconds
        for third in behind.get(second, ())
    ]


def _lasting(
    kind: str, at_least: Duration, ended: Iterable[Stretch[Pair] | Stretch[Three]]
) -> Iterator[TrueManoeuvre]:
    for vehicles, begin, end in ended:
        if end - begin >= at_least:
            yield TrueManoeuvre(kind, vehicles, (), begin, end)


class FollowedWatcher:
    """Compares the turns of all vehicles.

    A vehicle is *followed* by another if it turns left or right in a crossing and then in the next
    one it comes to, and the other does exactly the same, from and onto the same links, and gets
    onto each of the two links at most 15 s after it. The vehicles are the one ahead and the one
    behind; it begins when the one ahead begins its first turn, and ends when the one behind has
    ended its second.

    Args:
        turns: Finds all turns.
    """

    def __init__(self, turns: TurnWatcher) -> None:
        self._turns = turns
        self._last: dict[int, TrueManoeuvre] = {}
        self._doubles: dict[tuple[str, ...], list[tuple[TrueManoeuvre, TrueManoeuvre]]] = {}

    @classmethod
    def on(cls, road_map: RoadMap) -> Self:
        """Return a watcher on a map."""
        return cls(TurnWatcher.on(road_map))

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return who was followed through a second turn that ended in it."""
        found: list[TrueManoeuvre] = []
        for turn in self._turns.observe(frame, places):
            (vehicle,) = turn.vehicles
            before = self._last.get(vehicle)
            self._last[vehicle] = turn
            if before is not None and _is_double(before, turn):
                found += self._followed(before, turn)
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return nothing: who has not turned twice yet is not followed yet."""
        return []

    def _followed(self, one: TrueManoeuvre, two: TrueManoeuvre) -> Iterator[TrueManoeuvre]:
        way = one.place + two.place
        earlier = self._doubles.setdefault(way, [])
        earlier[:] = [turns for turns in earlier if two.end - turns[1].end <= _BEHIND]
        for first, second in earlier:
            is_behind = second.end < two.end and 0 < one.end - first.end <= _BEHIND
            if is_behind and first.vehicles != two.vehicles:
                vehicles = first.vehicles + two.vehicles
                yield TrueManoeuvre("followed", vehicles, (), first.begin, two.end)
        earlier.append((one, two))


def _is_double(one: TrueManoeuvre, two: TrueManoeuvre) -> bool:
    """Tell whether two turns lead left or right, the second from where the first led."""
    return {one.kind, two.kind} <= _ASIDE and one.place[2] == two.place[0]

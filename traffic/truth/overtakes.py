"""The true overtakes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Table
from dyknow.time import MINUTE, Duration, TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces

__all__ = ["OvertakeWatcher", "aside_of", "neighbours"]

Floats = npt.NDArray[np.float64]
Positions = npt.NDArray[np.intp]

_REACH = 60.0
_CLEARANCE = 1.0
_MOVING = 3.0
_LONGEST: Duration = MINUTE
_KEY_SHIFT = 32
_LATTER = (1 << _KEY_SHIFT) - 1


class OvertakeWatcher:
    """Compares all vehicles that are near each other on a link and travel the same way.

    One of them is *behind* the other if its centre is behind the other's by at least half of both
    lengths and 1 m, along the link; it is *in front* likewise. An overtake begins in the last
    frame in which A is behind B and ends in the first in which A is in front of B, at most 60 s
    later. In all frames from one to the other both are on the same link, travel in the same
    direction at more than 3 m/s, and are within 60 m of each other. So the changes of order in
    queues are none, and neither is passing a vehicle that stands.

    Each is told twice: as an `overtake`, and as an `overtake_left` or an `overtake_right`, by the
    side on which A was of B, seen in the direction of travel, when their centres were nearest to
    each other along the link. On the right, where one drives on the right, and on the left
    elsewhere, it is an `overtake_wrong_side` as well. The vehicles are A and B.

    Args:
        left_hand: Whether one drives on the left.
    """

    def __init__(self, *, left_hand: bool = False) -> None:
        self._pairs = _Pairs.none()
        self._wrong = "left" if left_hand else "right"

    @classmethod
    def on(cls, road_map: RoadMap) -> "OvertakeWatcher":
        """Return a watcher for a map."""
        return cls(left_hand=road_map.left_hand)

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return the overtakes that end in it."""
        time, vehicles = frame.time, frame.vehicles
        now = _near_pairs(time, vehicles, places)
        before, known = _matched(self._pairs, now)
        ended = self._ended(time, before, now, known)
        found = list(self._told(time, before, now, np.flatnonzero(ended)))
        self._pairs = _carried(before, now, known)
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return nothing: who is beside another at the end has not overtaken it yet."""
        return []

    @staticmethod
    def _ended(
        time: TimePoint, before: "_Pairs", now: "_Pairs", known: npt.NDArray[np.bool_]
    ) -> npt.NDArray[np.bool_]:
        swapped = before.order * now.order == -1
        steady = before.moving & now.moving & (time - before.since <= _LONGEST)
        ended: npt.NDArray[np.bool_] = known & swapped & steady
        return ended

    def _told(
        self, time: TimePoint, before: "_Pairs", now: "_Pairs", ended: Positions
    ) -> Iterator[TrueManoeuvre]:
        for row in ended:
            first, second = int(now.key[row] >> _KEY_SHIFT), int(now.key[row]) & _LATTER
            was_behind = 0 if before.order[row] > 0 else 1
            vehicles = (second, first) if was_behind else (first, second)
            closest = before if before.gap[row] <= now.gap[row] else now
            larger_is_left = closest.aside[row] > 0
            side = "left" if larger_is_left == (was_behind == 1) else "right"
            kinds = ["overtake", f"overtake_{side}"]
            if side == self._wrong:
                kinds.append("overtake_wrong_side")
            begin = TimePoint(int(before.since[row]))
            yield from (TrueManoeuvre(kind, vehicles, (), begin, time) for kind in kinds)


@dataclass(slots=True)
class _Pairs:
    """Pairs of vehicles near each other, in order of key.

    Attributes:
        key: The smaller id, shifted, and the larger.
        way: The link of both, doubled, and 1 more if they travel along it.
        order: 1 if the vehicle with the larger id is in front, -1 if it is behind, 0 beside.
        since: The last frame in which one of them was in front.
        moving: Whether both have been moving since then.
        gap: The smallest distance along the link since then, metres.
        aside: How far the larger id was to the left of the smaller at that moment, metres.
    """

    key: npt.NDArray[np.int64]
    way: npt.NDArray[np.int64]
    order: npt.NDArray[np.int8]
    since: npt.NDArray[np.int64]
    moving: npt.NDArray[np.bool_]
    gap: Floats
    aside: Floats

    @classmethod
    def none(cls) -> "_Pairs":
        """Return no pairs."""
        none = np.empty(0, dtype=np.int64)
        empty = np.empty(0)
        return cls(
            none,
            none,
            none.astype(np.int8),
            none,
            none.astype(np.bool_),
            empty,
            empty,
        )

    def take(self, rows: Positions) -> "_Pairs":
        """Return the pairs at *rows*."""
        return _Pairs(
            self.key[rows],
            self.way[rows],
            self.order[rows],
            self.since[rows],
            self.moving[rows],
            self.gap[rows],
            self.aside[rows],
        )


def _matched(before: _Pairs, now: _Pairs) -> tuple[_Pairs, npt.NDArray[np.bool_]]:
    """Return, row by row of *now*, the same pair before, and whether there is one.

    A pair that was on another link, or travelled the other way, is not the same.
    """
    if not len(before.key):
        return now, np.zeros(len(now.key), dtype=np.bool_)
    at = np.minimum(np.searchsorted(before.key, now.key), len(before.key) - 1)
    matched = before.take(at)
    return matched, (matched.key == now.key) & (matched.way == now.way)


def _near_pairs(time: TimePoint, vehicles: Table, places: TruePlaces) -> _Pairs:
    """Return the pairs of a frame as if nothing had been before."""
    behind, in_front = neighbours(places, _REACH)
    ids = vehicles.ids
    larger_in_front = ids[in_front] > ids[behind]
    first = np.where(larger_in_front, behind, in_front)
    second = np.where(larger_in_front, in_front, behind)
    gap = places.progress[in_front] - places.progress[behind]
    clear = gap >= (vehicles["length"][first] + vehicles["length"][second]) / 2 + _CLEARANCE
    fast = vehicles["speed"] > _MOVING
    key = ids[first] << _KEY_SHIFT | ids[second]
    pairs = _Pairs(
        key=key,
        way=_ways(places)[first],
        order=np.where(clear, np.where(larger_in_front, 1, -1), 0).astype(np.int8),
        since=np.full(len(key), time, dtype=np.int64),
        moving=fast[first] & fast[second],
        gap=gap,
        aside=aside_of(vehicles, first, second),
    )
    return pairs.take(np.argsort(key))


def neighbours(places: TruePlaces, reach: float) -> tuple[Positions, Positions]:
    """Return the rows of all pairs on one link and one way, at most *reach* metres apart.

    Returns:
        The rows of those behind, and the rows of those in front of them.
    """
    (rows,) = np.nonzero((places.link >= 0) & np.isfinite(places.progress))
    way = _ways(places)[rows]
    order = np.lexsort((places.progress[rows], way))
    rows, way, progress = rows[order], way[order], places.progress[rows[order]]
    behind, in_front = [rows[:0]], [rows[:0]]
    for shift in range(1, len(rows)):
        near = (way[shift:] == way[:-shift]) & (progress[shift:] - progress[:-shift] <= reach)
        if not near.any():
            break
        behind.append(rows[:-shift][near])
        in_front.append(rows[shift:][near])
    return np.concatenate(behind), np.concatenate(in_front)


def _ways(places: TruePlaces) -> npt.NDArray[np.int64]:
    ways: npt.NDArray[np.int64] = places.link.astype(np.int64) * 2 + (places.direction > 0)
    return ways


def aside_of(vehicles: Table, first: Positions, second: Positions) -> Floats:
    """Return how far each *second* is to the left of its *first*, metres."""
    heading, position = vehicles["heading"], vehicles["position"]
    east = np.cos(heading[first]) + np.cos(heading[second])
    north = np.sin(heading[first]) + np.sin(heading[second])
    offset = position[second] - position[first]
    left: Floats = (east * offset[:, 1] - north * offset[:, 0]) / np.hypot(east, north)
    return left


def _carried(before: _Pairs, now: _Pairs, known: npt.NDArray[np.bool_]) -> _Pairs:
    """Return the pairs of now, where those beside each other keep what was before."""
    beside = known & (now.order == 0)
    closer = now.gap <= before.gap
    return _Pairs(
        key=now.key,
        way=now.way,
        order=np.where(beside, before.order, now.order),
        since=np.where(beside, before.since, now.since),
        moving=np.where(beside, before.moving & now.moving, now.moving),
        gap=np.where(beside, np.minimum(before.gap, now.gap), now.gap),
        aside=np.where(beside & ~closer, before.aside, now.aside),
    )

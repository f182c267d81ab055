"""What is ahead of what along the roads, also on the roads that follow."""

import heapq
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from networks.geometry import Floats, group_ranges
from networks.roads import RoadMap

__all__ = ["Ahead", "RoadsAhead"]

Rows = npt.NDArray[np.intp]

_UNKNOWN = -1


class Ahead(NamedTuple):
    """Pairs of points, one ahead of the other.

    Attributes:
        behind: shape (k,), row of the one behind; in rising order.
        ahead: shape (k,), row of the one ahead.
        distance: shape (k,), metres from the one to the other along the shortest way; positive.
    """

    behind: Rows
    ahead: Rows
    distance: Floats


class RoadsAhead:
    """Finds, for a whole frame at once, the points that are ahead of others on the roads.

    The roads that one can get to from a road are looked up when it is asked for the first time,
    so that large maps cost no more than what is used of them.

    Args:
        road_map: The map.
        reach: How far ahead to look, metres.
        undecided: Whether a point on a way through a junction may as well be as far along on any
            other way that begins where this one does.
    """

    def __init__(self, road_map: RoadMap, reach: float, *, undecided: bool = False) -> None:
        self._lengths = road_map.road_length
        self._graph = road_map.graph
        self._reach = reach
        self._undecided = undecided
        n = len(road_map.roads)
        self._begin = np.full(n, _UNKNOWN, dtype=np.intp)
        self._count = np.zeros(n, dtype=np.intp)
        self._target = np.empty(0, dtype=np.intp)
        self._offset = np.empty(0)

    def pairs(self, road: npt.ArrayLike, s: Floats) -> Ahead:
        """Return all pairs of which one can get from the first to the second within reach.

        Args:
            road: shape (n,), indices of roads; points whose road is -1 are in no pair.
            s: shape (n,), metres along it.
        """
        roads = np.asarray(road, dtype=np.intp)
        (rows,) = np.nonzero(roads >= 0)
        roads, s = roads[rows], np.asarray(s, dtype=np.float64)[rows]
        self._learn(np.unique(roads))
        entry = group_ranges(self._begin[roads], self._count[roads])
        asking = np.repeat(np.arange(len(roads)), self._count[roads])
        # The point that asks, in metres along the road on which others are looked for.
        start = s[asking] - self._offset[entry]
        near = start >= -self._reach
        asking, target, start = asking[near], self._target[entry[near]], start[near]
        order, first, last = self._between(roads, s, target, start)
        ahead = order[group_ranges(first, last - first)]
        behind = np.repeat(asking, last - first)
        distance = s[ahead] - np.repeat(start, last - first)
        return Ahead(rows[behind], rows[ahead], distance)

    def _between(
        self, roads: Rows, s: Floats, target: Rows, start: Floats
    ) -> tuple[Rows, Rows, Rows]:
        """Return points in order along the roads, and which of them are ahead on each target."""
        if not len(s):
            return (np.empty(0, dtype=np.intp),) * 3
        least, most = float(s.min()) - 1, float(s.max()) + 1
        span = most - least + 1  # roads are laid out on one line, one after another
        order = np.lexsort((s, roads))
        line = s[order] + roads[order] * span
        from_ = np.clip(start, least, most) + target * span
        until = np.clip(start + self._reach, least, most) + target * span
        first = np.searchsorted(line, from_, side="right")
        return order, first, np.maximum(first, np.searchsorted(line, until, side="right"))

    def _learn(self, roads: Rows) -> None:
        unknown = roads[self._begin[roads] == _UNKNOWN]
        found = [self._roads_from(int(road)) for road in unknown]
        counts = np.array([len(each) for each in found], dtype=np.intp)
        self._count[unknown] = counts
        self._begin[unknown] = len(self._target) + np.cumsum(counts) - counts
        self._target = np.append(self._target, _column(found, 0)).astype(np.intp)
        self._offset = np.append(self._offset, _column(found, 1))

    def _roads_from(self, road: int) -> list[tuple[int, float]]:
        """Return the roads within reach of the end of *road*, and where they begin (Dijkstra).

        A begin is metres from the begin of *road*, which is among them.
        """
        starts = self._alternatives(road) if self._undecided else (road,)
        begins = dict.fromkeys(starts, 0.0)
        queue = [(0.0, start) for start in starts]
        limit = max(float(self._lengths[start]) for start in starts) + self._reach
        while queue:
            begin, here = heapq.heappop(queue)
            if begin > begins[here]:
                continue
            end = begin + float(self._lengths[here])
            for onward in self._graph.successors[here]:
                if end <= limit and end < begins.get(onward, np.inf):
                    begins[onward] = end
                    heapq.heappush(queue, (end, onward))
        return list(begins.items())

    def _alternatives(self, road: int) -> tuple[int, ...]:
        """Return the ways through a junction that begin where *road* does, and *road* itself."""
        if road < self._graph.edge_count:
            return (road,)
        (before,) = self._graph.predecessors[road]
        return self._graph.successors[before]


def _column(found: Iterable[list[tuple[int, float]]], index: int) -> list[float]:
    return [entry[index] for each in found for entry in each]

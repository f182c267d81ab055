"""Stretches: edges side by side between two junctions, and how many roads meet at a place."""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import shapely
from scipy.cluster.hierarchy import DisjointSet

from networks.geometry import Floats, Points, wrapped_angle
from networks.parts import Edge, NetworkParts

__all__ = ["CARRIAGEWAY_GAP", "Stretch", "Stretches", "lie_together"]

CARRIAGEWAY_GAP = 25.0
"""Carriageways farther apart than this, in metres, are different roads."""

_SAME_DIRECTION = math.radians(30.0)
_ARM_LENGTH = 15.0
"""Metres of a road that tell in which direction it leaves a junction."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """Edges side by side between the same two junctions.

    Attributes:
        ends: The two junctions; twice the same one for a loop.
        edges: Names of the edges, of both directions.
        length: Of the shortest edge, metres.
    """

    ends: tuple[str, str]
    edges: tuple[str, ...]
    length: float


@dataclass(frozen=True, slots=True)
class _Arm:
    """A stretch as seen from a junction: where it goes, and which ways it is driven."""

    direction: float
    leads_here: bool
    leads_away: bool


class Stretches:
    """All stretches of a network.

    Attributes:
        all: Every stretch.
        at: The stretches at each junction, by their position in `all`.
        lines: The centre line of each edge.
    """

    __slots__ = ("_edges", "all", "at", "lines")

    def __init__(self, parts: NetworkParts) -> None:
        self._edges = parts.edges
        self.lines: Mapping[str, Points] = {
            edge.id: edge.centre_line() for edge in parts.edges.values()
        }
        self.all: tuple[Stretch, ...] = tuple(self._found())
        self.at: dict[str, list[int]] = defaultdict(list)
        for number, stretch in enumerate(self.all):
            for junction in dict.fromkeys(stretch.ends):
                self.at[junction].append(number)

    def roads_meeting(self, junctions: Iterable[str], without: Collection[int] = ()) -> int:
        """Return how many roads meet at *junctions* taken as one place.

        A stretch that only leads here and one that only leads away, in nearly the same
        direction, are the carriageways of one road.

        Args:
            junctions: The junctions.
            without: Stretches that do not count.
        """
        arms = [
            arm
            for junction in junctions
            for number in self.at[junction]
            if number not in without
            for arm in self._arms(self.all[number], junction)
        ]
        return len(arms) - _carriageway_pairs(arms)

    def _found(self) -> Iterable[Stretch]:
        between: dict[tuple[str, ...], list[str]] = defaultdict(list)
        for edge in self._edges.values():
            between[tuple(sorted((edge.start, edge.end)))].append(edge.id)
        for (one, other), edges in between.items():
            groups = DisjointSet(edges)
            for a, b in combinations(edges, 2):
                if lie_together([self.lines[a]], [self.lines[b]]):
                    groups.merge(a, b)
            for members in groups.subsets():
                together = tuple(edge for edge in edges if edge in members)
                length = min(shapely.LineString(self.lines[edge]).length for edge in together)
                yield Stretch((one, other), together, length)

    def _arms(self, stretch: Stretch, junction: str) -> list[_Arm]:
        if stretch.ends[0] == stretch.ends[1]:
            return [_Arm(0.0, leads_here=True, leads_away=True)] * 2
        edges = [self._edges[edge] for edge in stretch.edges]
        towards = np.sum([self._direction_away(edge, junction) for edge in edges], axis=0)
        return [
            _Arm(
                math.atan2(towards[1], towards[0]),
                leads_here=any(edge.end == junction for edge in edges),
                leads_away=any(edge.start == junction for edge in edges),
            )
        ]

    def _direction_away(self, edge: Edge, junction: str) -> Floats:
        line = self.lines[edge.id] if edge.start == junction else self.lines[edge.id][::-1]
        ahead = shapely.line_interpolate_point(shapely.LineString(line), _ARM_LENGTH)
        step = np.array([ahead.x, ahead.y]) - line[0]
        return np.asarray(step / (np.hypot(*step) or 1.0))


def lie_together(one: list[Points], other: list[Points]) -> bool:
    """Tell whether the shorter of two roads stays within `CARRIAGEWAY_GAP` of the longer."""
    roads = sorted(
        (shapely.MultiLineString(one), shapely.MultiLineString(other)),
        key=lambda road: road.length,
    )
    corners = shapely.points(shapely.get_coordinates(shapely.segmentize(roads[0], 10.0)))
    return bool(np.max(shapely.distance(corners, roads[1])) <= CARRIAGEWAY_GAP)


def _carriageway_pairs(arms: list[_Arm]) -> int:
    arriving = [arm for arm in arms if arm.leads_here and not arm.leads_away]
    leaving = [arm for arm in arms if arm.leads_away and not arm.leads_here]
    pairs = 0
    for arm in arriving:
        beside = [
            other
            for other in leaving
            if abs(wrapped_angle(arm.direction - other.direction)) < _SAME_DIRECTION
        ]
        if beside:
            pairs += 1
            leaving.remove(beside[0])
    return pairs

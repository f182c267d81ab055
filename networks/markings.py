"""What is painted on roads: edges, lines between lanes, and the centre line."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import shapely

from networks.geometry import Points, offset_line, without_repetitions
from networks.parts import Edge, Lane, NetworkParts

__all__ = ["Marking", "MarkingKind", "markings_of"]

_BESIDE = 1.0
"""The other direction begins where the lanes of this one end, within so many metres."""


class MarkingKind(StrEnum):
    """The kinds of lines on roads."""

    EDGE = "edge"
    LANE = "lane"
    CENTRE_DASHED = "centre_dashed"
    CENTRE_SOLID = "centre_solid"


@dataclass(frozen=True, slots=True, eq=False)
class Marking:
    """A line painted on the road.

    Attributes:
        kind: Lines between lanes and dashed centre lines may be crossed.
        points: shape (k, 2), metres.
    """

    kind: MarkingKind
    points: Points


def markings_of(parts: NetworkParts) -> tuple[Marking, ...]:
    """Return all lines on the edges of a network."""
    inward = -1.0 if parts.left_hand else 1.0
    inner = {edge.id: _border(edge.lanes[-1], inward) for edge in parts.edges.values()}
    opposed: dict[tuple[str, str], list[str]] = {}
    for edge in parts.edges.values():
        opposed.setdefault((edge.start, edge.end), []).append(edge.id)
    return tuple(
        marking
        for edge in parts.edges.values()
        for marking in _markings(edge, inward, inner, opposed.get((edge.end, edge.start), []))
    )


def _markings(
    edge: Edge, inward: float, inner: Mapping[str, Points], opposed: list[str]
) -> Iterator[Marking]:
    yield Marking(MarkingKind.EDGE, _border(edge.lanes[0], -inward))
    for lane in edge.lanes[:-1]:
        yield Marking(MarkingKind.LANE, _border(lane, inward))
    line = inner[edge.id]
    beside = [other for other in opposed if _touch(line, inner[other])]
    if not beside:
        yield Marking(MarkingKind.EDGE, line)
    elif edge.id < min(beside):
        may_overtake = edge.lanes[-1].opposite is not None
        kind = MarkingKind.CENTRE_DASHED if may_overtake else MarkingKind.CENTRE_SOLID
        yield Marking(kind, line)


def _border(lane: Lane, side: float) -> Points:
    return offset_line(without_repetitions(lane.shape), side * lane.width / 2)


def _touch(line: Points, other: Points) -> bool:
    middle = shapely.line_interpolate_point(shapely.LineString(line), 0.5, normalized=True)
    return bool(np.less(shapely.distance(middle, shapely.LineString(other)), _BESIDE))

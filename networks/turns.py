"""Which way one turns: left, right, straight on or back, from link through crossing to link.

The relations are those of Heintz (2009), section 8.7.4: a set of triples (link, crossing, link)
for each way of turning. Only what the connections of the network permit is a triple.

How far a way turns is the angle between the direction in which the incoming road leads 20 to 5
metres before the crossing and the direction in which the outgoing road leads 5 to 20 metres
behind it; roads that are shorter are followed back or on within their link. Up to 45° to
either side is straight on. Back (`UTURN`) is every way that ends on the link on which it began;
only a link that both begins and ends at this crossing, such as a block, must be left at more than
120° for that. A way that turns by more than 150° onto a road less than 25 m beside the one it
came from is a U-turn as well, even where map-makers gave the two carriageways different ends.
If the connections offer several ways for one triple, the shortest counts.
"""

import heapq
import math
from collections.abc import Iterator, Mapping
from enum import StrEnum

import numpy as np

from networks.geometry import Floats, Points, resampled, wrapped_angle
from networks.graph import RoadGraph
from networks.stretches import CARRIAGEWAY_GAP

__all__ = ["Turn", "Turns", "turns_of"]

_NEAR, _FAR = 5.0, 20.0
_STRAIGHT = math.radians(45.0)
_BACK_ON_LOOP = math.radians(120.0)
_BACK = math.radians(150.0)


class Turn(StrEnum):
    """The way one turns in a crossing."""

    LEFT = "left"
    RIGHT = "right"
    STRAIGHT = "straight"
    UTURN = "uturn"


Turns = Mapping[tuple[int, int, int], Turn]
"""From (link, crossing, link) to the turn."""


def turns_of(graph: RoadGraph) -> dict[tuple[int, int, int], Turn]:
    """Return the turn of every way from a link through a crossing to a link."""
    shortest: dict[tuple[int, int, int], tuple[float, int, int]] = {}
    for road in range(len(graph.names)):
        if graph.link[road] < 0:
            continue
        for length, crossing, onward in _ways(graph, road):
            triple = (int(graph.link[road]), crossing, int(graph.link[onward]))
            way = (length, road, onward)
            shortest[triple] = min(shortest.get(triple, way), way)
    return {
        triple: _turn(graph, road, onward, triple[1])
        for triple, (_, road, onward) in sorted(shortest.items())
    }


def _ways(graph: RoadGraph, road: int) -> Iterator[tuple[float, int, int]]:
    """Yield length, crossing and outgoing road of every way on from *road* (Dijkstra)."""
    queue = [
        (0.0, int(graph.crossing[inside]), inside)
        for inside in graph.successors[road]
        if graph.crossing[inside] >= 0
    ]
    done: set[int] = set()
    while queue:
        length, crossing, inside = heapq.heappop(queue)
        if inside in done:
            continue
        done.add(inside)
        for onward in graph.successors[inside]:
            travelled = length + float(graph.lines.lengths[inside])
            if graph.link[onward] >= 0:
                yield travelled, crossing, onward
            else:
                heapq.heappush(queue, (travelled, crossing, onward))


def _leads_back(graph: RoadGraph, road: int, crossing: int) -> bool:
    """Tell whether the link that begins with *road* ends at the crossing where it began."""
    last = graph.chain_in_link(road)[-1]
    return any(graph.crossing[inside] == crossing for inside in graph.successors[last])


def _turn(graph: RoadGraph, road: int, onward: int, crossing: int) -> Turn:
    before = graph.line_of(graph.chain_in_link(road, backwards=True)[::-1])[::-1]
    after = graph.line_of(graph.chain_in_link(onward))
    angle = float(wrapped_angle(_heading(after) - _heading(before) - math.pi))
    if graph.link[road] == graph.link[onward]:
        is_back = abs(angle) > _BACK_ON_LOOP or not _leads_back(graph, onward, crossing)
    else:
        gap = float(np.hypot(*(_point(before, _FAR / 2) - _point(after, _FAR / 2))))
        is_back = abs(angle) > _BACK and gap < CARRIAGEWAY_GAP
    if is_back:
        return Turn.UTURN
    if abs(angle) <= _STRAIGHT:
        return Turn.STRAIGHT
    return Turn.LEFT if angle > 0 else Turn.RIGHT


def _heading(line: Points) -> float:
    """Return the direction in which *line* leads a little behind its start."""
    step = _point(line, _FAR) - _point(line, _NEAR)
    if np.hypot(*step) < 1.0:
        step = line[-1] - line[0]
    return math.atan2(step[1], step[0])


def _point(line: Points, distance: float) -> Floats:
    length = float(np.sum(np.hypot(*np.diff(line, axis=0).T)))
    return resampled(line, np.array([min(1.0, distance / length)])).ravel()

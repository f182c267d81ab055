"""Small made-up networks for tests and tutorials.

A network is a set of places and the roads that join them; every road has a carriageway for each
direction, beside its axis, and at every place where roads meet all of them are connected. The
edge from place `a` to place `b` is called `a_b`.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import shapely

from networks.assembling import road_map_from_parts
from networks.geometry import Points, offset_line
from networks.parts import Connection, Edge, Junction, Lane, NetworkParts
from networks.roads import RoadMap

__all__ = ["Road", "bend", "four_arm_crossing", "network_parts", "ring", "straight_road"]

_LANE_WIDTH = 3.2
_CORNER = 4.0
"""From the side of one road to where the edges of the other begin, metres."""


@dataclass(frozen=True, slots=True)
class Road:
    """A road between two places.

    Attributes:
        start: A place.
        end: Another place.
        lanes: Lanes of each direction.
        corners: Points of the axis between the places.
        may_overtake: Whether one may overtake on the innermost lane of the other direction.
        one_way: Whether there is only the carriageway from start to end.
    """

    start: str
    end: str
    lanes: int = 1
    corners: tuple[tuple[float, float], ...] = ()
    may_overtake: bool = False
    one_way: bool = False


def straight_road(length: float = 200.0, lanes: int = 1, *, left_hand: bool = False) -> RoadMap:
    """Return a road from `west` at the origin to `east`, along the x axis."""
    places = {"west": (0.0, 0.0), "east": (length, 0.0)}
    road = Road("west", "east", lanes, may_overtake=True)
    return road_map_from_parts(network_parts(places, [road], left_hand=left_hand))


def four_arm_crossing(
    arm: float = 100.0, lanes: int = 1, *, u_turns: bool = False, left_hand: bool = False
) -> RoadMap:
    """Return a crossing `centre` at the origin, with arms to `east`, `north`, `west`, `south`."""
    places = {
        "centre": (0.0, 0.0),
        "east": (arm, 0.0),
        "north": (0.0, arm),
        "west": (-arm, 0.0),
        "south": (0.0, -arm),
    }
    roads = [Road("centre", name, lanes) for name in places if name != "centre"]
    return road_map_from_parts(network_parts(places, roads, u_turns=u_turns, left_hand=left_hand))


def bend(radius: float = 60.0, angle: float = math.pi / 2, approach: float = 100.0) -> RoadMap:
    """Return a road that leads east, turns left by *angle*, and leads on as far as before."""
    turned = np.linspace(0.0, angle, max(3, round(angle * radius / 4.0)))
    arc = np.column_stack([np.sin(turned), 1 - np.cos(turned)]) * radius
    onward = arc[-1] + approach * np.array([math.cos(angle), math.sin(angle)])
    places = {"start": (-approach, 0.0), "end": (float(onward[0]), float(onward[1]))}
    corners = tuple((float(x), float(y)) for x, y in arc)
    return road_map_from_parts(network_parts(places, [Road("start", "end", 1, corners)]))


def ring(radius: float = 60.0, quarters: int = 4) -> RoadMap:
    """Return a road that leads once round the origin, in *quarters* pieces; it has no end."""
    angles = np.linspace(0.0, 2 * np.pi, 8 * quarters + 1)
    circle = [
        (float(x), float(y)) for x, y in radius * np.column_stack([np.cos(angles), np.sin(angles)])
    ]
    places = {f"q{i}": circle[8 * i] for i in range(quarters)}
    roads = [
        Road(f"q{i}", f"q{(i + 1) % quarters}", corners=tuple(circle[8 * i + 1 : 8 * i + 8]))
        for i in range(quarters)
    ]
    return road_map_from_parts(network_parts(places, roads))


def network_parts(
    places: Mapping[str, tuple[float, float]],
    roads: Sequence[Road],
    *,
    u_turns: bool = False,
    left_hand: bool = False,
) -> NetworkParts:
    """Return the parts of a network of *roads* between *places*.

    Args:
        places: Name to position, metres.
        roads: No two between the same places.
        u_turns: Whether one may turn back where roads meet.
        left_hand: Whether one drives on the left.
    """
    at_place: dict[str, list[Road]] = defaultdict(list)
    for road in roads:
        at_place[road.start].append(road)
        at_place[road.end].append(road)
    reach = {name: _reach(meeting) for name, meeting in at_place.items()}
    edges = {
        edge.id: edge
        for road in roads
        for edge in _carriageways(road, places, reach, left_hand=left_hand)
    }
    connections = [
        connection
        for place in at_place
        for connection in _connections(place, edges, u_turns=u_turns)
    ]
    return NetworkParts(
        {name: _junction(name, places[name], edges, reach[name]) for name in at_place},
        edges,
        tuple(connections),
        left_hand,
    )


def _reach(meeting: Sequence[Road]) -> float:
    """Return how far the junction of some roads reaches along each of them."""
    if len(meeting) == 1:
        return 0.0
    return max(road.lanes for road in meeting) * _LANE_WIDTH + _CORNER


def _carriageways(
    road: Road,
    places: Mapping[str, tuple[float, float]],
    reach: Mapping[str, float],
    *,
    left_hand: bool,
) -> Iterator[Edge]:
    axis = shapely.LineString([places[road.start], *road.corners, places[road.end]])
    cut = _between(axis, reach[road.start], axis.length - reach[road.end])
    ways = [(road.start, road.end, cut)]
    if not road.one_way:
        ways.append((road.end, road.start, cut[::-1]))
    for start, end, line in ways:
        yield Edge(
            f"{start}_{end}",
            start,
            end,
            tuple(
                Lane(
                    f"{start}_{end}_{i}",
                    offset_line(line, _lane_offset(road, i, left_hand=left_hand)),
                    _LANE_WIDTH,
                    _opposite(road, start, end, i),
                )
                for i in range(road.lanes)
            ),
        )


def _between(axis: shapely.LineString, start: float, end: float) -> Points:
    along = [axis.project(shapely.Point(corner)) for corner in axis.coords]
    inner = [s for s in along[1:-1] if start + 0.1 < s < end - 0.1]
    return shapely.get_coordinates(shapely.line_interpolate_point(axis, [start, *inner, end]))


def _lane_offset(road: Road, lane: int, *, left_hand: bool) -> float:
    outward = (road.lanes - lane - 0.5) * _LANE_WIDTH
    return outward if left_hand else -outward


def _opposite(road: Road, start: str, end: str, lane: int) -> str | None:
    innermost = road.lanes - 1
    return f"{end}_{start}_{innermost}" if road.may_overtake and lane == innermost else None


def _connections(place: str, edges: Mapping[str, Edge], *, u_turns: bool) -> Iterator[Connection]:
    incoming = [edge for edge in edges.values() if edge.end == place]
    outgoing = [edge for edge in edges.values() if edge.start == place]
    for number, (before, after) in enumerate(product(incoming, outgoing)):
        if before.start == after.end and not u_turns:
            continue
        inside = f":{place}_{number}"
        for i, lane in enumerate(before.lanes):
            onto = after.lanes[min(i, len(after.lanes) - 1)]
            curve = Lane(f"{inside}_{i}", _curve(lane.shape, onto.shape), _LANE_WIDTH)
            yield Connection(before.id, after.id, (curve,), (inside,))


def _curve(before: Points, after: Points) -> Points:
    """Return a smooth line (cubic Bézier) from the end of one lane to the start of another."""
    start, end = before[-1], after[0]
    gap = float(np.hypot(*(end - start)))
    ahead = before[-1] - before[-2]
    behind = after[1] - after[0]
    pull = 0.4 * gap
    corners = np.array(
        [
            start,
            start + pull * ahead / np.hypot(*ahead),
            end - pull * behind / np.hypot(*behind),
            end,
        ]
    )
    t = np.linspace(0.0, 1.0, 9)[:, None]
    weights = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    return np.asarray(weights @ corners)


def _junction(
    name: str, position: tuple[float, float], edges: Mapping[str, Edge], reach: float
) -> Junction:
    sides = [
        offset_line(lane.shape, side * lane.width / 2)[-1 if edge.end == name else 0]
        for edge in edges.values()
        if name in (edge.start, edge.end)
        for lane in edge.lanes
        for side in (-1, 1)
    ]
    hull = shapely.convex_hull(shapely.MultiPoint(sides))
    outline = shapely.get_coordinates(hull)[:-1] if reach else np.empty((0, 2))
    return Junction(name, np.array(position), outline)

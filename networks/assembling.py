"""From the parts of a network to its road map."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from networks.geometry import (
    Indices,
    Points,
    Polylines,
    middle_line,
    resampled,
    without_repetitions,
    wrapped_angle,
)
from networks.graph import RoadGraph
from networks.links import LinkPositions, link_positions
from networks.markings import markings_of
from networks.parts import Connection, Lane, NetworkParts
from networks.regions import NONE, Areas, strip, united
from networks.roads import Lanes, RoadMap
from networks.signals import Signals, signals_of
from networks.topology import Topology, topology_of
from networks.turns import turns_of

__all__ = ["road_map_from_parts"]

_SHORTEST_WAY = 0.01
"""A way through a junction that has no length gets this one, metres."""


@dataclass(frozen=True, slots=True)
class _Way:
    """All connections from one edge to another, as one directed road."""

    name: str
    from_edge: str
    to_edge: str
    line: Points
    lanes: tuple[Lane, ...]
    edge_ids: tuple[str, ...]


def road_map_from_parts(parts: NetworkParts) -> RoadMap:
    """Return the map of a network that has at least one edge."""
    topology = topology_of(parts)
    ways = _ways(parts)
    graph = _graph(parts, topology, ways)
    lanes = _lanes(parts, ways)
    positions = link_positions(graph, len(topology.links))
    link_of_edge, crossing_of_edge = _places_of_edges(graph, ways)
    return RoadMap(
        links=_link_names(parts, topology, positions, graph),
        crossings=tuple(junctions[0] for junctions in topology.crossings),
        graph=graph,
        lane_columns=lanes,
        areas=_areas(parts, topology, graph, lanes),
        positions=positions,
        link_of_edge=link_of_edge,
        crossing_of_edge=crossing_of_edge,
        crossing_of_junction=topology.crossing_of_junction,
        turns=turns_of(graph),
        markings=markings_of(parts),
        signals=_signals(parts, topology, graph, lanes),
        left_hand=parts.left_hand,
    )


def _ways(parts: NetworkParts) -> list[_Way]:
    between: dict[tuple[str, str], list[Connection]] = defaultdict(list)
    for connection in parts.connections:
        between[connection.from_edge, connection.to_edge].append(connection)
    centre = {edge.id: edge.centre_line() for edge in parts.edges.values()}
    ways, names = [], set(parts.edges)
    for (before, after), connections in between.items():
        edge_ids = tuple(dict.fromkeys(e for c in connections for e in c.edge_ids))
        name = edge_ids[0] if edge_ids and edge_ids[0] not in names else f"{before}>{after}"
        names.add(name)
        line = _way_line(connections, centre[before], centre[after])
        lanes = {lane.id: lane for c in connections for lane in c.lanes}
        if not lanes:
            lanes = {name: Lane(name, line)}
        ways.append(_Way(name, before, after, line, tuple(lanes.values()), edge_ids))
    return ways


def _way_line(connections: list[Connection], before: Points, after: Points) -> Points:
    """Return a line from the end of one to the start of another, in the form of the lanes."""
    start, end = before[-1], after[0]
    if np.hypot(*(end - start)) < _SHORTEST_WAY:
        step = before[-1] - without_repetitions(before)[-2]
        return np.vstack([start, start + _SHORTEST_WAY * step / np.hypot(*step)])
    inner = [line for line in (c.line() for c in connections) if line is not None]
    if not inner:
        return np.vstack([start, end])
    line = inner[0] if len(inner) == 1 else middle_line(inner[0], inner[-1])
    fractions = np.linspace(0.0, 1.0, max(len(line), 9))[:, None]
    line = resampled(line, fractions[:, 0])
    bridged: Points = line + (1 - fractions) * (start - line[0]) + fractions * (end - line[-1])
    return bridged


def _graph(parts: NetworkParts, topology: Topology, ways: list[_Way]) -> RoadGraph:
    edges = list(parts.edges.values())
    link_of = {edge: i for i, link in enumerate(topology.links) for edge in link}
    crossing_at = topology.crossing_of_junction
    crossing = [topology.crossing_of_edge.get(edge.id, NONE) for edge in edges]
    crossing += [crossing_at.get(parts.edges[way.from_edge].end, NONE) for way in ways]
    link = [link_of.get(edge.id, NONE) for edge in edges]
    link += [
        link_of[way.from_edge] if inside == NONE else NONE
        for way, inside in zip(ways, crossing[len(edges) :], strict=True)
    ]
    lines = Polylines([*(edge.centre_line() for edge in edges), *(way.line for way in ways)])
    width = [edge.width() for edge in edges]
    width += [_way_width(parts, way) for way in ways]
    names = (*(edge.id for edge in edges), *(way.name for way in ways))
    return RoadGraph(
        names=names,
        edge_count=len(edges),
        lines=lines,
        width=np.array(width),
        link=np.array(link, dtype=np.int32),
        crossing=np.array(crossing, dtype=np.int32),
        successors=_successors(names, ways, lines),
    )


def _way_width(parts: NetworkParts, way: _Way) -> float:
    return min(parts.edges[way.from_edge].width(), parts.edges[way.to_edge].width())


def _successors(
    names: Sequence[str], ways: list[_Way], lines: Polylines
) -> tuple[tuple[int, ...], ...]:
    index = {name: i for i, name in enumerate(names)}
    following: list[list[int]] = [[] for _ in names]
    for way in ways:
        following[index[way.from_edge]].append(index[way.name])
        following[index[way.name]].append(index[way.to_edge])
    every = np.arange(len(names))
    entering = lines.heading_at(every, np.zeros(len(every)))
    leaving = lines.heading_at(every, lines.lengths)
    target = {index[way.name]: index[way.to_edge] for way in ways}

    def straightest_first(road: int) -> tuple[int, ...]:
        onward = [target.get(successor, successor) for successor in following[road]]
        bend = np.abs(wrapped_angle(entering[onward] - leaving[road]))
        return tuple(following[road][i] for i in np.argsort(bend, kind="stable"))

    return tuple(map(straightest_first, range(len(names))))


def _lanes(parts: NetworkParts, ways: list[_Way]) -> Lanes:
    of_road = [edge.lanes for edge in parts.edges.values()] + [way.lanes for way in ways]
    lanes = [lane for members in of_road for lane in members]
    index = {lane.id: i for i, lane in enumerate(lanes)}
    return Lanes(
        names=tuple(lane.id for lane in lanes),
        lines=Polylines([lane.shape for lane in lanes]),
        width=np.array([lane.width for lane in lanes]),
        road=np.repeat(np.arange(len(of_road), dtype=np.int32), [len(m) for m in of_road]),
        opposite=np.array([index.get(lane.opposite or "", NONE) for lane in lanes], np.int32),
    )


def _signals(parts: NetworkParts, topology: Topology, graph: RoadGraph, lanes: Lanes) -> Signals:
    """Return where signals are; only lanes of edges can have one."""
    ends = [parts.edges[name].end for name in graph.names[: graph.edge_count]]
    ahead = [topology.crossing_of_junction.get(junction, NONE) for junction in ends]
    crossing = np.full(len(graph.names), NONE, dtype=np.int32)
    crossing[: graph.edge_count] = ahead
    return signals_of(parts, lanes.names, lanes.lines, crossing[lanes.road])


def _areas(parts: NetworkParts, topology: Topology, graph: RoadGraph, lanes: Lanes) -> Areas:
    strips = strip([lanes.lines.line(i) for i in range(len(lanes.names))], lanes.width)
    crossing_of_lane, link_of_lane = graph.crossing[lanes.road], graph.link[lanes.road]
    crossings = [
        united([*(parts.junctions[j].area() for j in junctions), *strips[crossing_of_lane == i]])
        for i, junctions in enumerate(topology.crossings)
    ]
    on_link = np.flatnonzero(link_of_lane >= 0).astype(np.int32)
    return Areas(
        crossings=np.array(crossings, dtype=np.object_),
        lanes=(strips[on_link], on_link, link_of_lane[on_link]),
        joints=_joints(parts, topology),
        lane_lines=lanes.lines,
    )


def _joints(parts: NetworkParts, topology: Topology) -> tuple[np.ndarray, Indices]:
    """Return the areas of the junctions that are no crossings, and the link of each."""
    link_of = {
        junction: i
        for i, link in enumerate(topology.links)
        for edge in link
        for junction in (parts.edges[edge].start, parts.edges[edge].end)
        if junction not in topology.crossing_of_junction
    }
    shapes = np.array(
        [united([parts.junctions[junction].area()]) for junction in link_of], dtype=np.object_
    )
    links = np.array(list(link_of.values()), dtype=np.int32)
    solid = shapely.area(shapes) > 0
    return shapes[solid], links[solid]


def _places_of_edges(graph: RoadGraph, ways: list[_Way]) -> tuple[dict[str, int], dict[str, int]]:
    roads: list[tuple[str, int]] = [(graph.names[i], i) for i in range(graph.edge_count)]
    for number, way in enumerate(ways, start=graph.edge_count):
        roads += [(edge, number) for edge in way.edge_ids]
    links = {name: int(graph.link[i]) for name, i in roads if graph.link[i] >= 0}
    crossings = {name: int(graph.crossing[i]) for name, i in roads if graph.crossing[i] >= 0}
    return links, crossings


def _link_names(
    parts: NetworkParts, topology: Topology, positions: LinkPositions, graph: RoadGraph
) -> tuple[str, ...]:
    """Name each link by what is at its two ends, and if need be by its first edge."""

    def place(junction: str) -> str:
        crossing = topology.crossing_of_junction.get(junction, NONE)
        return junction if crossing == NONE else topology.crossings[crossing][0]

    names: list[str] = []
    for chain in positions.chains:
        edges = [parts.edges[graph.names[r]] for r in chain if r < graph.edge_count]
        name = f"{place(edges[0].start)}-{place(edges[-1].end)}"
        names.append(f"{name} ({edges[0].id})" if name in names else name)
    return tuple(names)

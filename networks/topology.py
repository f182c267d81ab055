"""Which junctions are crossings, and which edges make up the link between two of them.

The terms are those of Heintz (2009), *DyKnow: A Stream-Based Knowledge Processing Middleware
Framework*, section 8.7.4: a *link* is all road between two crossings, in both directions. The
thesis takes crossings as given; here they follow from the network:

- Edges between the same two junctions that lie together are one *stretch* of road.
- A junction is a crossing where at least three roads meet. A road that only leads here and a
  road that only leads away, in nearly the same direction, are two carriageways of one road. So
  dead ends, edge splits, and places where a median begins are no crossings.
- Crossings with less than `SHORTEST_LINK` of road between them are one crossing, which swallows
  that road. If fewer than three roads meet at the result, it is none.
- Two one-way links that lie together and lead opposite ways between the same crossings are the
  carriageways of one link.
"""

import heapq
import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations

import shapely
from scipy.cluster.hierarchy import DisjointSet

from networks.parts import NetworkParts
from networks.stretches import Stretches, lie_together

__all__ = ["ROADS_OF_CROSSING", "SHORTEST_LINK", "Topology", "topology_of"]

ROADS_OF_CROSSING = 3
"""So many roads make a crossing."""

SHORTEST_LINK = 30.0
"""Crossings with less road than this between them, in metres, are one crossing."""


@dataclass(frozen=True, slots=True)
class Topology:
    """Crossings and links of a network.

    Attributes:
        crossings: The junctions of each crossing, the one with the largest area first.
        links: The edges of each link, in the order of the file.
        crossing_of_junction: For every junction of a crossing.
        crossing_of_edge: For every edge that a crossing swallowed.
    """

    crossings: tuple[tuple[str, ...], ...]
    links: tuple[tuple[str, ...], ...]
    crossing_of_junction: Mapping[str, int]
    crossing_of_edge: Mapping[str, int]


def topology_of(parts: NetworkParts) -> Topology:
    """Find the crossings and links of a network."""
    stretches = Stretches(parts)
    refused: set[str] = set()
    while True:
        nodes = [
            junction
            for junction in stretches.at
            if junction not in refused and stretches.roads_meeting([junction]) >= ROADS_OF_CROSSING
        ]
        chains = _chains(stretches, set(nodes))
        clusters, swallowed = _clusters(stretches, nodes, chains)
        false = [c for c in clusters if stretches.roads_meeting(c, swallowed) < ROADS_OF_CROSSING]
        if not false:
            break
        refused.update(junction for cluster in false for junction in cluster)
    crossings = tuple(_largest_first(parts, cluster) for cluster in clusters)
    crossing_of = {junction: i for i, members in enumerate(crossings) for junction in members}
    remaining = [chain for chain in chains if not swallowed.keys() & chain]
    edges = [_edges_of(stretches, parts, chain) for chain in remaining]
    return Topology(
        crossings=crossings,
        links=_with_both_carriageways(parts, stretches, edges, crossing_of),
        crossing_of_junction=crossing_of,
        crossing_of_edge={
            edge: crossing_of[junction]
            for number, junction in swallowed.items()
            for edge in stretches.all[number].edges
        },
    )


def _chains(stretches: Stretches, nodes: set[str]) -> list[set[int]]:
    """Join the stretches that meet where there is no crossing."""
    groups = DisjointSet(range(len(stretches.all)))
    for junction, numbers in stretches.at.items():
        if junction not in nodes:
            for number in numbers:
                groups.merge(numbers[0], number)
    return list(groups.subsets())


def _clusters(
    stretches: Stretches, nodes: list[str], chains: list[set[int]]
) -> tuple[list[list[str]], dict[int, str]]:
    """Join the crossings that are too near; return also the stretches that this swallows."""
    groups = DisjointSet(nodes)
    swallowed: dict[int, str] = {}
    for chain in chains:
        touched = dict.fromkeys(end for number in chain for end in stretches.all[number].ends)
        ends = [junction for junction in touched if junction in groups]
        if ends and _is_short(stretches, chain, ends):
            for end in ends:
                groups.merge(ends[0], end)
            swallowed.update(dict.fromkeys(chain, ends[0]))
    order = {node: i for i, node in enumerate(nodes)}
    clusters = [sorted(members, key=order.__getitem__) for members in groups.subsets()]
    return clusters, swallowed


def _is_short(stretches: Stretches, chain: set[int], ends: list[str]) -> bool:
    if len(ends) > 1:
        return all(
            _road_between(stretches, chain, a, b) < SHORTEST_LINK for a, b in combinations(ends, 2)
        )
    touched = [end for number in chain for end in stretches.all[number].ends]
    is_loop = all(touched.count(end) > 1 for end in touched)
    return is_loop and sum(stretches.all[number].length for number in chain) < SHORTEST_LINK


def _road_between(stretches: Stretches, chain: set[int], start: str, end: str) -> float:
    """Return the length of the shortest way inside *chain* (Dijkstra)."""
    queue = [(0.0, start)]
    done: set[str] = set()
    while queue:
        travelled, junction = heapq.heappop(queue)
        if junction == end:
            return travelled
        if junction in done:
            continue
        done.add(junction)
        for stretch in (stretches.all[n] for n in stretches.at[junction] if n in chain):
            other = stretch.ends[0] if stretch.ends[1] == junction else stretch.ends[1]
            heapq.heappush(queue, (travelled + stretch.length, other))
    return math.inf


def _largest_first(parts: NetworkParts, junctions: Iterable[str]) -> tuple[str, ...]:
    def size(junction: str) -> float:
        return float(shapely.area(parts.junctions[junction].area()))

    return tuple(sorted(junctions, key=size, reverse=True))


def _edges_of(stretches: Stretches, parts: NetworkParts, chain: set[int]) -> tuple[str, ...]:
    chosen = {edge for number in chain for edge in stretches.all[number].edges}
    return tuple(edge for edge in parts.edges if edge in chosen)


def _with_both_carriageways(
    parts: NetworkParts,
    stretches: Stretches,
    links: list[tuple[str, ...]],
    crossing_of: Mapping[str, int],
) -> tuple[tuple[str, ...], ...]:
    ways: dict[tuple[int, int], list[int]] = defaultdict(list)
    for number, link in enumerate(links):
        starts = {parts.edges[edge].start for edge in link}
        ends = {parts.edges[edge].end for edge in link}
        sources = {crossing_of.get(junction, -1) for junction in starts - ends}
        sinks = {crossing_of.get(junction, -1) for junction in ends - starts}
        if len(sources) == len(sinks) == 1 and sources != sinks:
            ways[sources.pop(), sinks.pop()].append(number)
    groups = DisjointSet(range(len(links)))
    for (source, sink), numbers in ways.items():
        for one in numbers:
            for other in ways.get((sink, source), []) if source < sink else []:
                lines = [[stretches.lines[edge] for edge in links[n]] for n in (one, other)]
                if lie_together(lines[0], lines[1]):
                    groups.merge(one, other)
    merged = sorted(sorted(members) for members in groups.subsets())
    return tuple(tuple(edge for number in members for edge in links[number]) for members in merged)

"""Positions along links: one line for both directions of each link.

Where a car is on a link is told by its position along the link's reference line, so that cars
that go opposite ways, or on different edges of the link, can be compared.
"""

from dataclasses import dataclass

import numpy as np

from networks.geometry import Floats, Polylines
from networks.graph import RoadGraph

__all__ = ["LinkPositions", "link_positions"]


@dataclass(frozen=True, slots=True, eq=False)
class LinkPositions:
    """How positions along roads become positions along links.

    Attributes:
        chains: For each link, the roads along which it is measured.
        length: shape (l,), of the reference lines, metres.
        offset: shape (r,), for each road, metres.
        direction: shape (r,), 1 if a road leads along the reference line, -1 if against it; then
            position along the link is `offset + direction * s`. For roads inside crossings 1.
    """

    chains: tuple[tuple[int, ...], ...]
    length: Floats
    offset: Floats
    direction: Floats


def link_positions(graph: RoadGraph, links: int) -> LinkPositions:
    """Choose a reference line for each link and place all roads along it.

    The longest chain of roads is the reference. Every other road is placed by its middle, so
    that differences in length between the two sides of a bend are shared between its ends.
    """
    chains = tuple(_longest_chain(graph, np.flatnonzero(graph.link == i)) for i in range(links))
    references = Polylines([graph.line_of(chain) for chain in chains])
    lengths = graph.lines.lengths
    offset = np.zeros(len(graph.names))
    direction = np.ones(len(graph.names))
    roads = np.flatnonzero(graph.link >= 0)
    middle = lengths[roads] / 2
    at, _ = references.project(graph.lines.at(roads, middle), graph.link[roads])
    turned = graph.lines.heading_at(roads, middle) - references.heading_at(graph.link[roads], at)
    direction[roads] = np.where(np.cos(turned) < 0, -1.0, 1.0)
    offset[roads] = at - direction[roads] * middle
    for chain in chains:
        before = np.concatenate(([0.0], np.cumsum(lengths[list(chain)])[:-1]))
        offset[list(chain)] = before
        direction[list(chain)] = 1.0
    return LinkPositions(chains, references.lengths, offset, direction)


def _longest_chain(graph: RoadGraph, roads: np.ndarray) -> tuple[int, ...]:
    members = set(roads.tolist())
    starts = [r for r in members if members.isdisjoint(graph.predecessors[r])] or list(members)[:1]
    chains = [tuple(graph.chain_in_link(start)) for start in sorted(starts)]
    return max(chains, key=lambda chain: float(np.sum(graph.lines.lengths[list(chain)])))

"""Directed roads and how they follow one another."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from networks.geometry import Floats, Indices, Points, Polylines, wrapped_angle

__all__ = ["RoadGraph"]

_ROUND = math.radians(150.0)


@dataclass(frozen=True)
class RoadGraph:
    """The directed roads of a network: every edge, and every way through a junction.

    Attributes:
        names: shape (r,), the edges first.
        edge_count: How many of them are edges.
        lines: The centre line of each road; a road begins where the one before it ends.
        width: shape (r,), of all lanes together, metres.
        link: shape (r,), the link to which each road belongs, or -1.
        crossing: shape (r,), the crossing in which each road lies, or -1.
        successors: The roads on which each one goes on, the straightest first.
    """

    names: tuple[str, ...]
    edge_count: int
    lines: Polylines
    width: Floats
    link: Indices
    crossing: Indices
    successors: tuple[tuple[int, ...], ...]

    @cached_property
    def predecessors(self) -> tuple[tuple[int, ...], ...]:
        """The roads that go on as each one, the straightest first."""
        before: list[list[int]] = [[] for _ in self.names]
        for road, following in enumerate(self.successors):
            for successor in following:
                before[successor].append(road)
        bends = self.bends
        return tuple(tuple(sorted(roads, key=lambda r: abs(bends[r]))) for roads in before)

    @cached_property
    def bends(self) -> Floats:
        """How far each way through a junction turns left, edge to edge, radians; 0 for edges."""
        every = np.arange(len(self.names))
        entering = self.lines.heading_at(every, np.zeros(len(every)))
        leaving = self.lines.heading_at(every, self.lines.lengths)
        bends = np.zeros(len(every))
        for road, following in enumerate(self.successors[: self.edge_count]):
            for way in following:
                (onward,) = self.successors[way]
                bends[way] = wrapped_angle(entering[onward] - leaving[road])
        return bends

    def chain_in_link(self, road: int, *, backwards: bool = False) -> list[int]:
        """Return the roads of the same link on which *road* goes straight on, *road* first.

        The chain does not turn round at a dead end.
        """
        neighbours: Sequence[tuple[int, ...]] = self.predecessors if backwards else self.successors
        chain = [road]
        while following := [
            other
            for other in neighbours[chain[-1]]
            if self.link[other] == self.link[road]
            and other not in chain
            and not self._turns_round(other)
        ]:
            chain.append(following[0])
        return chain

    def line_of(self, chain: Sequence[int]) -> Points:
        """Return the centre line of roads that follow one another."""
        return np.vstack([self.lines.line(road) for road in chain])

    def _turns_round(self, road: int) -> bool:
        return abs(float(self.bends[road])) > _ROUND

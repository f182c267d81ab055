"""Where signals are: at the stop lines of lanes, and what they can show.

A lane has a signal if every way out of it is controlled. It shows what the most permissive of them
does: who drives past a red signal had no way on which that would have been allowed.
"""

from collections import defaultdict
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from networks.geometry import Floats, Indices, Points, Polylines
from networks.parts import NetworkParts

__all__ = ["SignalState", "Signals", "permissive", "signals_of"]

_FORBIDDING = "ruyYsgG"
"""SUMO's letters of signal states, the more permissive the later; others are no signal at all."""


class SignalState(IntEnum):
    """What a signal shows; the numbers stand in columns."""

    OFF = 0
    GREEN = 1
    YELLOW = 2
    RED = 3
    RED_YELLOW = 4


_STATE_BY_LETTER = {
    "r": SignalState.RED,
    "u": SignalState.RED_YELLOW,
    "y": SignalState.YELLOW,
    "Y": SignalState.YELLOW,
    "s": SignalState.GREEN,
    "g": SignalState.GREEN,
    "G": SignalState.GREEN,
}


@dataclass(frozen=True, slots=True, eq=False)
class Signals:
    """The signals of a network, each a column; a signal has the name of its lane.

    Attributes:
        names: Of the lanes.
        lane: shape (n,), the lane of each.
        crossing: shape (n,), the crossing before which it stands, or -1.
        lines: shape (n, 2, 2), the right and the left end of each stop line, as one drives towards
            it, metres.
        heading: shape (n,), radians, direction of travel at the line.
    """

    names: tuple[str, ...]
    lane: Indices
    crossing: Indices
    lines: Points
    heading: Floats

    def __len__(self) -> int:
        return len(self.names)


def permissive(letters: str) -> SignalState:
    """Return what a signal shows whose ways have these states, in SUMO's letters."""
    if not letters or any(letter not in _FORBIDDING for letter in letters):
        return SignalState.OFF
    return _STATE_BY_LETTER[max(letters, key=_FORBIDDING.index)]


def signals_of(
    parts: NetworkParts, names: tuple[str, ...], lines: Polylines, crossing: Indices
) -> Signals:
    """Return the signals of a network.

    Args:
        parts: The network.
        names: Of the lanes.
        lines: The centre lines of the lanes.
        crossing: shape (l,), the crossing to which each lane leads, or -1.
    """
    ways: dict[str, list[bool]] = defaultdict(list)
    for connection in parts.connections:
        ways[connection.from_lane].append(connection.is_controlled)
    lane = np.array([i for i, name in enumerate(names) if all(ways.get(name, [False]))], np.int32)
    width = {each.id: each.width for edge in parts.edges.values() for each in edge.lanes}
    half = np.array([width[names[i]] / 2 for i in lane])
    end = lines.lengths[lane]
    return Signals(
        names=tuple(names[i] for i in lane),
        lane=lane,
        crossing=crossing[lane],
        lines=np.stack([lines.at(lane, end, -half), lines.at(lane, end, half)], axis=1),
        heading=lines.heading_at(lane, end),
    )

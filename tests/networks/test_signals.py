"""Where signals are, and what they show."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.geometry import Polylines
from networks.parts import Connection, Edge, Junction, Lane, NetworkParts
from networks.reading import read_road_map
from networks.signals import SignalState, permissive, signals_of

CROSSING = Path(__file__).parents[2] / "data" / "networks" / "crossing" / "crossing.net.xml"


def test_signals_stand_at_the_ends_of_controlled_lanes() -> None:
    """In the town, all eight lanes that lead to the middle have one, across the whole lane."""
    road_map = read_road_map(CROSSING)
    signals, lanes = road_map.signals, road_map.lane_columns

    arms = ("east", "north", "south", "west")
    assert signals.names == tuple(f"{arm}_centre_{lane}" for arm in arms for lane in (0, 1))
    assert {road_map.crossings[i] for i in signals.crossing} == {"centre"}
    right, left = signals.lines[:, 0], signals.lines[:, 1]
    assert np.allclose(np.hypot(*(left - right).T), 3.2)
    ends = lanes.lines.at(signals.lane, lanes.lines.lengths[signals.lane])
    assert np.allclose((left + right) / 2, ends)
    across = (left - right) / 3.2
    forward = np.column_stack([np.cos(signals.heading), np.sin(signals.heading)])
    assert np.allclose(forward[:, 0] * across[:, 1] - forward[:, 1] * across[:, 0], 1.0)


def test_a_lane_with_a_free_way_out_has_no_signal() -> None:
    """It would be red, and still one might drive on."""
    shape = np.array([[0.0, 0.0], [50.0, 0.0]])
    lanes = tuple(Lane(f"a_{i}", shape + np.array([0.0, 3.0 * i])) for i in range(3))
    edges = {"a": Edge("a", "w", "m", lanes), "b": Edge("b", "m", "e", (Lane("b_0", shape),))}
    junctions = {name: Junction(name, np.zeros(2), np.zeros((0, 2))) for name in "wme"}
    ways = [("a_0", True), ("a_1", True), ("a_1", False)]
    connections = tuple(
        Connection("a", "b", from_lane=lane, is_controlled=controlled) for lane, controlled in ways
    )
    parts = NetworkParts(junctions, edges, connections)
    names = ("a_0", "a_1", "a_2")

    found = signals_of(parts, names, Polylines([lane.shape for lane in lanes]), np.zeros(3, int))

    assert found.names == ("a_0",)
    assert len(found) == 1


@pytest.mark.parametrize(
    ("letters", "state"),
    [
        ("r", SignalState.RED),
        ("rrG", SignalState.GREEN),
        ("ry", SignalState.YELLOW),
        ("ru", SignalState.RED_YELLOW),
        ("rs", SignalState.GREEN),
        ("ro", SignalState.OFF),
        ("O", SignalState.OFF),
        ("", SignalState.OFF),
    ],
)
def test_a_signal_shows_the_most_permissive_of_its_ways(letters: str, state: SignalState) -> None:
    """Red only if no way is free; a way without a working light makes it no signal."""
    assert permissive(letters) is state


@given(st.text("ruyYsgGoO", max_size=6))
@settings(derandomize=True, deadline=None, max_examples=200)
def test_red_is_only_what_is_red_for_all(letters: str) -> None:
    """Whatever the ways are, one of them that is not red makes the signal not red."""
    assert (permissive(letters) is SignalState.RED) == (set(letters) == {"r"})

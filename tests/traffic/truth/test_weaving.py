"""The definition of weaving, on hand-made paths and against its naive reading."""

from collections.abc import Sequence

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.weaving import WeavingWatcher

SWAYING = [0.0, 0.8, -0.2, 0.8, -0.2, 0.8]


def watch(
    d: Sequence[float], *, speed: Sequence[float] | None = None, road: Sequence[int] | None = None
) -> list[TrueManoeuvre]:
    """Return the weaving of a vehicle that is at these places across its road, each second."""
    watcher, found = WeavingWatcher(), []
    for i, across in enumerate(d):
        fast = np.array([10.0 if speed is None else speed[i]])
        places = true_places(
            1,
            link=np.array([3], dtype=np.int32),
            road=np.array([0 if road is None else road[i]], dtype=np.int32),
            d=np.array([across]),
        )
        frame = Frame(
            TimePoint(i * SECOND),
            Table("vehicle", [7], {"speed": fast}),
            Table("vehicle", [7], {}),
        )
        found += watcher.observe(frame, places)
    return found + watcher.finish()


def test_four_swings_are_weaving() -> None:
    """From the first swing to the last, to the left and to the right in turn."""
    assert watch(SWAYING) == [
        TrueManoeuvre("weaving", (7,), (), TimePoint(SECOND), TimePoint(5 * SECOND))
    ]


def test_three_swings_are_not() -> None:
    """One who goes around something and comes back with a swing too many does not weave."""
    assert watch([0.0, 1.5, -0.2, 0.6, 0.2, 0.2]) == []


def test_changes_of_lanes_are_no_swings() -> None:
    """Four of them in a row, by 3.2 m, are no weaving."""
    slalom = [0.0, 1.6, 3.2, 1.6, 0.0, 1.6, 3.2, 1.6, 0.0, 0.0]

    assert watch(slalom) == []


def test_a_pause_parts_what_was_swung_before() -> None:
    """After more than six seconds without a swing everything begins anew."""
    assert watch([0.0, 0.8, -0.2, *[-0.2] * 7, 0.8, -0.2]) == []


def test_standing_ends_it() -> None:
    """A vehicle that stops has stopped weaving."""
    assert watch(SWAYING, speed=[9, 9, 9, 0, 9, 9]) == []


def test_the_middle_of_the_next_road_is_no_swing() -> None:
    """Where roads join, places across them are taken together."""
    path = [0.0, 0.8, -0.2, -0.2 + 1.6, -0.2 + 1.6, -0.2 + 1.6]

    assert watch(path, road=[0, 0, 0, 1, 1, 1]) == []


def naive(path: Sequence[float]) -> list[tuple[int, int]]:
    """Return begin and end of each weaving, by cutting the path into its swings."""
    turns: list[int] = []
    chains: list[list[int]] = [turns]
    side, start = 0, 0
    for i, across in enumerate(path):
        if turns and i - turns[-1] > 6:
            turns, side, start = [], 0, i
            chains.append(turns)
        since = path[start : i + 1]
        if side <= 0 and across - min(since) >= 0.7:
            side, start = 1, i
            turns.append(i)
        elif side >= 0 and max(since) - across >= 0.7:
            side, start = -1, i
            turns.append(i)
    return [
        (chain[0], chain[-1])
        for chain in chains
        if any(chain[k + 3] - chain[k] <= 20 for k in range(len(chain) - 3))
    ]


@settings(derandomize=True, deadline=None, max_examples=300)
@given(path=st.lists(st.integers(-4, 4).map(lambda x: x * 0.3), min_size=1, max_size=40))
def test_weaving_is_that_of_the_naive_reading(path: list[float]) -> None:
    """As by cutting the path at its turns."""
    found = [(each.begin // SECOND, each.end // SECOND) for each in watch(path)]

    assert found == naive(path)

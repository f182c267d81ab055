"""The definition of parking beside a building."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.reading import read_road_map
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.parking import ParkingWatcher

STREET = read_road_map(Path(__file__).parents[3] / "data/networks/high_street/high_street.net.xml")
BAY, LANE, NOWHERE = (-80.0, -4.8), (-80.0, -1.75), (-15.0, -4.8)


def watch(
    places: Sequence[tuple[float, float]], speeds: Sequence[float] | None = None
) -> list[TrueManoeuvre]:
    """Return the parking of one vehicle that heads east, second by second."""
    watcher, found = ParkingWatcher(STREET), []
    for i, place in enumerate(places):
        columns = {
            "position": np.array([place]),
            "heading": np.zeros(1),
            "speed": np.array([0.0 if speeds is None else speeds[i]]),
        }
        frame = Frame(
            TimePoint(i * SECOND), Table("vehicle", [4], columns), Table("vehicle", [4], {})
        )
        found += watcher.observe(frame, true_places(1))
    return found + watcher.finish()


def parked(begin: int, end: int, building: str = "library") -> TrueManoeuvre:
    """Return the parking of the vehicle from one second to another."""
    times = TimePoint(begin * SECOND), TimePoint(end * SECOND)
    return TrueManoeuvre("parking_beside_building", (4,), (building,), *times)


def test_twenty_seconds_in_a_bay_are_parking() -> None:
    """From the first frame in which it stands to the last."""
    assert watch([BAY] * 21) == [parked(0, 20)]
    assert watch([BAY] * 20) == []


def test_standing_on_the_lane_is_waiting() -> None:
    """However long, and however near the building is."""
    assert watch([LANE] * 40) == []


def test_where_no_building_is_one_parks_beside_none() -> None:
    """The next one is more than 8 m away."""
    assert watch([NOWHERE] * 40) == []


def test_moving_on_begins_anew() -> None:
    """Even by a little, and even within the same bay."""
    assert watch([BAY] * 31, [0.0] * 9 + [1.0] + [0.0] * 21) == [parked(10, 30)]


def test_another_building_is_another_parking() -> None:
    """Each has its own time."""
    school = (-55.0, -4.8)

    assert watch([BAY] * 25 + [school] * 25) == [parked(0, 24), parked(25, 49, "school")]


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.tuples(st.integers(1, 30), st.sampled_from([BAY, LANE, NOWHERE])), max_size=5))
def test_parking_is_that_of_the_naive_reading(
    pieces: list[tuple[int, tuple[float, float]]],
) -> None:
    """The runs of frames in the bay that last for twenty seconds."""
    places = [place for count, place in pieces for _ in range(count)]
    expected, since = [], None
    for i, place in enumerate([*places, None]):
        if place == BAY:
            since = i if since is None else since
        else:
            if since is not None and i - 1 - since >= 20:
                expected.append(parked(since, i - 1))
            since = None

    assert watch(places) == expected

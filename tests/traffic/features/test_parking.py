"""Beside which building cars stand, case by case and against the naive reading."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Point

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.reading import read_road_map
from traffic.features.parking import BesideBuilding, outer_lanes

STREET = read_road_map(Path(__file__).parents[3] / "data/networks/high_street/high_street.net.xml")
EAST = STREET.roads.index("west_lights")
NAMES = (*STREET.surroundings.names, "none")

Row = tuple[float, float, float]
"""Metres along the road to the east, metres to the left of its middle, speed."""


def unit() -> BesideBuilding:
    """Return a unit as the application has it."""
    return BesideBuilding(STREET, within=8.0, below=0.8, above=1.5, aside=0.6, certainty=1.0)


def standing(frames: Sequence[Sequence[Row]], deviation: float = 0.1) -> list[list[str]]:
    """Return beside which buildings the cars of each frame stand."""
    beside, found = unit(), []
    for i, rows in enumerate(frames):
        s, d, speed = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
        n = len(rows)
        road = np.full(n, EAST, dtype=np.int32)
        columns = {
            "road": road,
            "d": d,
            "d_variance": np.full(n, deviation**2),
            "speed": speed,
            "position": STREET.point_at(road, s, d),
            "observed": np.ones(n, dtype=bool),
        }
        sample = Sample(Table("car", range(n), columns), TimePoint(i), TimePoint(i))
        (out,) = beside.push(sample.available_time, (sample,))
        found.append([NAMES[code] for code in out.value["beside_building"].tolist()])
    return found


LIBRARY, EMPTY, QUEUE = 180.0, 245.0, 300.0
"""Metres along the road: bays beside the library, bays beside nothing, where queues stand."""


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ((LIBRARY, -3.0, 0.0), "library"),
        ((LIBRARY, -3.0, 9.0), "none"),
        ((LIBRARY, 0.0, 0.0), "none"),
        ((EMPTY, -3.0, 0.0), "none"),
        ((QUEUE, 0.0, 0.0), "none"),
        ((QUEUE, -0.8, 0.0), "hotel"),
        ((QUEUE, 2.0, 0.0), "none"),
    ],
)
def test_a_car_stands_beside_a_building_at_the_kerb_or_off_the_lane(
    row: Row, expected: str
) -> None:
    """Not while it moves, waits on its lane, stands to the left, or where no building is."""
    assert standing([[row]]) == [[expected]]


def test_a_car_stands_until_it_is_clearly_faster() -> None:
    """Between both speeds what was last decided stands."""
    speeds = [1.2, 0.5, 1.2, 2.0, 1.2]

    assert standing([[(LIBRARY, -3.0, speed)] for speed in speeds]) == [
        ["none"], ["library"], ["library"], ["none"], ["none"],
    ]  # fmt: skip


def test_who_may_be_on_the_lane_is_not_aside_yet() -> None:
    """One standard deviation more is asked for, and less to remain."""
    frames = [[(LIBRARY, d, 0.0)] for d in (-0.7, -1.0, -0.5, -0.3)]

    assert [names for (names,) in standing(frames, deviation=0.3)] == [
        "none", "library", "library", "none",
    ]  # fmt: skip


def test_the_outer_lane_is_on_the_right_of_the_middle() -> None:
    """On a road of one lane its middle is that of the road."""
    assert outer_lanes(STREET)[EAST] == pytest.approx(0.0)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    rows=st.lists(
        st.tuples(st.floats(100, 310), st.floats(-6, 6), st.floats(0, 3)), min_size=1, max_size=8
    )
)
def test_first_sight_is_that_of_the_naive_reading(rows: list[Row]) -> None:
    """Car by car, building by building."""
    expected = []
    for s, d, speed in rows:
        ((x, y),) = STREET.point_at([EAST], np.array([s]), np.array([d]))
        distances = [shape.distance(Point(x, y)) for shape in STREET.surroundings.buildings]
        nearest = int(np.argmin(distances))
        stands = speed < 0.8 and -d >= 0.7 and distances[nearest] <= 8.0
        expected.append(NAMES[nearest] if stands else "none")

    assert standing([rows]) == [expected]

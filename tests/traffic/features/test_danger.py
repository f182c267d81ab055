"""Collision courses, case by case and against the naive reading."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, Duration, TimePoint
from networks.building import four_arm_crossing, straight_road
from networks.prediction import Bodies, first_touch
from networks.roads import RoadMap
from traffic.features.danger import CollisionCourses, near_pairs

STRAIGHT = straight_road(400.0, lanes=2)
CROSSING = four_arm_crossing()

Row = tuple[int, float, float, float]
"""Road, metres along it, metres to the left of its middle, speed along it."""


def cars_of(road_map: RoadMap, rows: Sequence[Row], deviation: float = 0.0) -> Table:
    """Return a table of cars of 4.5 m by 1.8 m, observed now."""
    road, s, d, speed = (np.array(column) for column in zip(*rows, strict=True))
    road, n = road.astype(np.int32), len(rows)
    heading = road_map.heading_at(road, s)
    columns = {
        "road": road,
        "s": s,
        "d": d,
        "speed": speed,
        "heading": heading,
        "velocity": speed[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]),
        "position": road_map.point_at(road, s, d),
        "length": np.full(n, 4.5),
        "width": np.full(n, 1.8),
        "observed_at": np.zeros(n, dtype=np.int64),
        **{
            name: np.full(n, deviation**2)
            for name in ("s_variance", "d_variance", "speed_variance")
        },
    }
    return Table("car", np.arange(n) * 10, columns)


def courses(
    road_map: RoadMap, rows: Sequence[Row], deviation: float = 0.0, at: int = 0
) -> list[tuple[int, int]]:
    """Return the pairs of cars that are on a collision course."""
    unit = CollisionCourses(
        road_map, reach=40.0, horizon=Duration(1000 * MILLISECOND),
        following=Duration(850 * MILLISECOND), closing=4.0, certainty=1.0,
    )  # fmt: skip
    time = TimePoint(at * MILLISECOND)
    (out,) = unit.push(time, (Sample(cars_of(road_map, rows, deviation), time, time),))
    pairs = out.value.select(out.value["collision_course"])
    return list(zip(pairs["first"].tolist(), pairs["second"].tolist(), strict=True))


@pytest.mark.parametrize(
    ("gap", "speed", "expected"),
    [(8.0, 10.0, [(0, 10)]), (9.0, 10.0, []), (2.0, 3.9, []), (3.0, 4.1, [(0, 10)])],
)
def test_who_comes_near_behind_a_standing_car_too_fast_is_a_danger(
    gap: float, speed: float, expected: list[tuple[int, int]]
) -> None:
    """Less than 0.85 s away, and faster than 4 m/s."""
    rows = [(0, 100.0, 0.0, speed), (0, 104.5 + gap, 0.0, 0.0)]

    assert courses(STRAIGHT, rows) == expected


def test_a_car_on_the_other_lane_is_none() -> None:
    """It stands aside."""
    assert courses(STRAIGHT, [(0, 100.0, 1.6, 12.0), (0, 109.0, -1.6, 0.0)]) == []


def test_cars_that_meet_on_their_own_sides_are_none() -> None:
    """Whatever their speeds."""
    west = next(i for i in range(len(STRAIGHT.roads)) if STRAIGHT.direction_in_link[i] < 0)

    assert courses(STRAIGHT, [(0, 200.0, 1.6, 20.0), (west, 190.0, 1.6, 20.0)]) == []


def test_uncertain_cars_must_be_nearer() -> None:
    """They count as smaller and slower, and their difference as less."""
    rows = [(0, 100.0, 0.0, 10.0), (0, 104.5 + 8.0, 0.0, 0.0)]

    assert courses(STRAIGHT, rows, deviation=0.1) == [(0, 10)]
    assert courses(STRAIGHT, rows, deviation=0.5) == []
    assert courses(STRAIGHT, [(0, 100.0, 0.0, 4.1), (0, 107.0, 0.0, 0.0)], deviation=0.1) == []


def test_cars_that_have_not_been_seen_lately_do_not_count() -> None:
    """After 400 ms nobody knows how fast they are."""
    rows = [(0, 100.0, 0.0, 10.0), (0, 110.0, 0.0, 0.0)]

    assert courses(STRAIGHT, rows, at=400) == [(0, 10)]
    assert courses(STRAIGHT, rows, at=401) == []


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.integers(0, 10_000))
def test_courses_are_those_of_the_naive_reading(seed: int) -> None:
    """Pair by pair, by the words of the definition."""
    generator = np.random.default_rng(seed)
    n = 6
    road = generator.integers(0, len(CROSSING.roads), n)
    rows = [
        (
            int(each),
            float(CROSSING.road_length[each] * generator.uniform(0.6, 1.0)),
            float(generator.uniform(-1, 1)),
            float(generator.choice([0.0, 0.5, generator.uniform(3, 18)])),
        )
        for each in road
    ]
    cars = cars_of(CROSSING, rows)
    bodies = Bodies(*(cars[name] for name in ("road", "s", "d", "speed", "length", "width")))
    times = np.arange(0.0, 1.025, 0.05)

    expected = []
    for i in range(n):
        for j in range(i + 1, n):
            apart = np.hypot(*(cars["position"][i] - cars["position"][j]))
            closing = np.hypot(*(cars["velocity"][i] - cars["velocity"][j]))
            same_way = np.cos(cars["heading"][i] - cars["heading"][j]) > 0.8
            follows = same_way and road[i] == road[j]
            both = min(cars["speed"][i], cars["speed"][j]) >= 1.0
            (touch,) = first_touch(CROSSING, bodies, (np.array([i]), np.array([j])), times)
            soon = touch <= (0.85 if same_way else 1.0) + 0.025
            if apart <= 40 and closing >= 4 and (follows or both) and soon:
                expected.append((i * 10, j * 10))
    assert sorted(courses(CROSSING, rows)) == expected


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), max_size=12), st.floats(0.1, 60)
)
def test_near_pairs_are_all_pairs_within_reach(
    points: list[tuple[float, float]], reach: float
) -> None:
    """Each once."""
    position = np.array(points, dtype=np.float64).reshape(-1, 2)

    first, second = near_pairs(position, reach)

    found = sorted((min(i, j), max(i, j)) for i, j in zip(first, second, strict=True))
    distance = np.linalg.norm(position[:, None] - position[None, :], axis=2)
    assert found == [
        (i, j) for i in range(len(points)) for j in range(i + 1, len(points))
        if distance[i, j] <= reach
    ]  # fmt: skip

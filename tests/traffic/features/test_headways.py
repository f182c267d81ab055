"""Headways: who is behind whom, with what gap, against trying every pair."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, Duration, TimePoint
from networks.building import four_arm_crossing, straight_road
from traffic.features.headways import Headways

CROSSING = four_arm_crossing(lanes=2)
STRAIGHT = straight_road(400.0, lanes=2)
REACH = 80.0
ACTIVE_FOR = Duration(SECOND)


def cars_on(road_map, road, s, **columns):
    """Return cars at *s* along roads, by default of 5 m, at 10 m/s, known for certain."""
    n = len(road)
    given_columns = {name: np.asarray(column) for name, column in columns.items()}
    return Table(
        "car",
        np.arange(n) + 10,
        {
            "road": np.asarray(road, dtype=np.int32),
            "s": np.asarray(s, dtype=float),
            "d": np.zeros(n),
            "length": np.full(n, 5.0),
            "speed": np.full(n, 10.0),
            "s_variance": np.zeros(n),
            "d_variance": np.zeros(n),
            "speed_variance": np.zeros(n),
            "observed_at": np.zeros(n, dtype=np.int64),
            **given_columns,
        },
    )


def headways(road_map, cars, now=0):
    """Return the pairs of one table of cars."""
    unit = Headways(road_map, reach=REACH, active_for=ACTIVE_FOR)
    (out,) = unit.push(TimePoint(now), (Sample(cars, TimePoint(now), TimePoint(now)),))
    return out.value


def shortest(road_map, road, goal):
    """Return the metres from the begin of one road to that of another, by trying all ways.

    On a way through a junction those beside it are tried as well.
    """
    edges = range(road_map.graph.edge_count)
    ways = [road_map.successors(edge) for edge in edges if road in road_map.successors(edge)]
    starts = ways[0] if ways and road not in edges else [road]
    best, stack = math.inf, [(start, 0.0) for start in starts]
    while stack:
        here, travelled = stack.pop()
        if travelled >= min(best, REACH + road_map.road_length[road]):
            continue
        if here == goal:
            best = travelled
            continue
        stack += [(on, travelled + road_map.road_length[here]) for on in road_map.successors(here)]
    return best


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.sampled_from([CROSSING, STRAIGHT]), st.integers(0, 2**32 - 1))
def test_headways_agree_with_trying_every_pair(road_map, seed):
    """Each pair within reach is there with the gap, the time gap and how far it is aside."""
    generator = np.random.Generator(np.random.PCG64(seed))
    n = 15
    road = generator.integers(0, len(road_map.roads), n)
    s = generator.uniform(0, 1, n) * road_map.road_length[road]
    d, speed = generator.normal(0, 2, n), generator.uniform(1, 20, n)
    length = generator.uniform(3, 12, n)
    cars = cars_on(road_map, road, s, d=d, speed=speed, length=length)

    found = headways(road_map, cars)

    rows = {
        (first, second): (gap, time_gap, aside)
        for first, second, gap, time_gap, aside in zip(
            found["first"].tolist(),
            found["second"].tolist(),
            found["gap"].tolist(),
            found["time_gap"].tolist(),
            found["aside"].tolist(),
            strict=True,
        )
    }
    expected = {}
    for i in range(n):
        for j in range(n):
            ahead = shortest(road_map, int(road[i]), int(road[j])) + s[j] - s[i]
            if i != j and 0 < ahead <= REACH:
                gap = ahead - (length[i] + length[j]) / 2
                pair = [int(road[i]), int(road[j])]
                loose = (road_map.crossing_of_road[pair] >= 0).any() or (
                    np.ptp(road_map.road_width[pair]) > 0
                )
                aside = max(abs(d[i] - d[j]) - (0.8 if loose else 0.0), 0.0)
                expected[i + 10, j + 10] = pytest.approx((gap, gap / speed[i], aside))
    assert rows == expected


def test_the_deviation_is_that_of_errors_drawn_at_random():
    """With errors of the given variances the time gap scatters as much as the column says."""
    s_deviation, speed_deviation = 0.4, 0.3
    cars = cars_on(
        STRAIGHT,
        [0, 0],
        [50.0, 67.0],
        s_variance=[s_deviation**2] * 2,
        speed_variance=[speed_deviation**2] * 2,
    )
    generator = np.random.Generator(np.random.PCG64(3))
    n = 20_000
    gap = 12.0 + generator.normal(0, s_deviation, n) - generator.normal(0, s_deviation, n)
    speed = 10.0 + generator.normal(0, speed_deviation, n)

    (deviation,) = headways(STRAIGHT, cars)["deviation"]

    assert deviation == pytest.approx(float(np.std(gap / speed)), rel=0.03)


def test_each_pair_has_the_deviation_of_the_speed_of_the_first():
    """The speed of the first car is as uncertain in a pair as it is."""
    cars = cars_on(
        STRAIGHT, [0, 0, 0], [50.0, 67.0, 80.0], speed_variance=np.array([0.04, 0.25, 1.0])
    )

    found = headways(STRAIGHT, cars)

    deviations = {
        (first, second): deviation
        for first, second, deviation in zip(
            found["first"].tolist(),
            found["second"].tolist(),
            found["speed_deviation"].tolist(),
            strict=True,
        )
    }
    assert deviations == {(10, 11): 0.2, (10, 12): 0.2, (11, 12): 0.5}


def test_a_car_that_was_not_observed_for_long_is_in_no_pair():
    """Who has not been seen for longer than the set time does not count."""
    cars = cars_on(STRAIGHT, [0, 0], [50.0, 70.0], observed_at=[0, 2 * SECOND])

    assert len(headways(STRAIGHT, cars, now=SECOND)) == 1
    assert len(headways(STRAIGHT, cars, now=2 * SECOND)) == 0


def test_a_standing_car_has_a_long_time_gap():
    """Nothing is divided by a speed of zero."""
    cars = cars_on(STRAIGHT, [0, 0], [50.0, 67.0], speed=[0.0, 0.0])

    assert headways(STRAIGHT, cars)["time_gap"][0] == pytest.approx(120.0)


def test_a_reach_of_nothing_is_refused():
    """A setting that would never find a pair is a fault."""
    with pytest.raises(ValueError, match="reach"):
        Headways(STRAIGHT, reach=0.0, active_for=ACTIVE_FOR)

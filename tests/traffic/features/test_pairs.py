"""Pairs of cars near each other on one road."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, Duration, TimePoint
from traffic.features.pairs import NearPairs, near_pairs_along

CARS = st.lists(st.tuples(st.integers(-1, 3), st.integers(-50, 50)), max_size=25)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(CARS, st.integers(0, 40))
def test_near_pairs_are_those_that_trying_all_pairs_finds(cars, distance):
    """Sorting along the links finds each near pair once and no other."""
    group = np.array([g for g, _ in cars], dtype=np.int64)
    along = np.array([a for _, a in cars], dtype=np.float64)

    behind, ahead = near_pairs_along(group, along, float(distance))

    found = sorted(tuple(sorted(p)) for p in zip(behind.tolist(), ahead.tolist(), strict=True))
    expected = [
        (i, j)
        for i in range(len(cars))
        for j in range(i + 1, len(cars))
        if group[i] == group[j] >= 0 and abs(along[i] - along[j]) <= distance
    ]
    assert found == expected
    assert (along[behind] <= along[ahead]).all()


def test_pairs_know_how_uncertain_they_are():
    """Errors of two cars are independent, so that their variances add."""
    cars = Table(
        "car",
        [1, 2],
        {
            "observed_at": np.zeros(2, dtype=np.int64),
            "direction_in_link": np.ones(2),
            "link_of_road": np.zeros(2, dtype=np.int32),
            "position_along_link": np.array([0.0, 20.0]),
            "d": np.array([1.0, -2.0]),
            "length": np.array([4.0, 6.0]),
            "s_variance": np.array([9.0, 16.0]),
            "d_variance": np.array([0.09, 0.16]),
        },
    )
    unit = NearPairs(distance=60.0, active_for=Duration(400 * MILLISECOND))
    (out,) = unit.push(TimePoint(0), (Sample(cars, TimePoint(0), TimePoint(0)),))

    pairs = out.value
    assert pairs["ahead"].tolist() == [20.0, -20.0]
    assert pairs["left"].tolist() == [3.0, -3.0]
    assert pairs["clearance"].tolist() == [5.0, 5.0]
    np.testing.assert_allclose(pairs["ahead_deviation"], 5.0)
    np.testing.assert_allclose(pairs["left_deviation"], 0.5)

"""Pairs of cars near each other on one road."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.features.pairs import near_pairs_along

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

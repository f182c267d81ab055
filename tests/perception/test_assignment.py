"""Pairing within a gate."""

from itertools import permutations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from perception.assignment import assign

COSTS = st.tuples(st.integers(0, 4), st.integers(0, 4)).flatmap(
    lambda shape: arrays(np.float64, shape, elements=st.floats(0.0, 10.0))
)


def best_by_trying_all(cost, gate):
    """Return the highest number of pairs within the gate, and the least cost of that many."""
    rows, columns = cost.shape
    if rows > columns:
        return best_by_trying_all(cost.T, gate)
    best = (0, 0.0)
    for chosen in permutations(range(columns), rows):
        allowed = [cost[i, j] for i, j in enumerate(chosen) if cost[i, j] <= gate]
        best = min(best, (-len(allowed), sum(allowed)))
    return -best[0], best[1]


@settings(derandomize=True, deadline=None, max_examples=150)
@given(COSTS, st.floats(0.0, 10.0))
def test_the_pairing_is_the_best_of_all(cost, gate):
    """As many pairs are made as the gate allows, and no other choice costs less."""
    rows, columns = assign(cost, gate)

    number, least = best_by_trying_all(cost, gate)
    assert len(rows) == len(columns) == number
    assert len(set(rows.tolist())) == number
    assert len(set(columns.tolist())) == number
    assert (cost[rows, columns] <= gate).all()
    np.testing.assert_allclose(cost[rows, columns].sum(), least, atol=1e-9)

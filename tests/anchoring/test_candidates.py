"""The choice among pairs that may be linked."""

from itertools import combinations, permutations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from anchoring.candidates import best_pairs

_pairs = st.dictionaries(
    st.tuples(st.integers(0, 3), st.integers(0, 3)), st.floats(0.0, 9.0), min_size=1, max_size=9
)


def _cost(choice, separations, lowers, limit):
    left_out = len(lowers) - len(choice)
    return sum(separations[pair] ** 2 for pair in choice) + left_out * limit**2


@settings(derandomize=True, deadline=None, max_examples=60)
@given(_pairs, st.sampled_from([0.0, 4.0, 12.0]))
def test_the_best_choice_is_found(separations, gate):
    """No other choice of pairs without a common member costs less."""
    at, on = np.array(list(separations)).T
    lowers, uppers = sorted(set(at.tolist())), sorted(set(on.tolist()))
    values = np.array(list(separations.values()))
    limit = max(gate, 1.01 * values.max() + 0.01)

    first, second = best_pairs(at, on, values, gate)

    chosen = list(zip(first.tolist(), second.tolist(), strict=True))
    choices = [
        list(zip(some, others, strict=True))
        for count in range(min(len(lowers), len(uppers)) + 1)
        for some in combinations(lowers, count)
        for others in permutations(uppers, count)
    ]
    possible = [c for c in choices if all(pair in separations for pair in c)]
    least = min(_cost(c, separations, lowers, limit) for c in possible)
    assert chosen in possible
    np.testing.assert_allclose(_cost(chosen, separations, lowers, limit), least)


def test_a_lone_pair_is_always_taken():
    """However far apart, two objects that compete with nobody are linked."""
    first, second = best_pairs(np.array([3]), np.array([5]), np.array([100.0]), 1.0)

    assert (first.tolist(), second.tolist()) == ([3], [5])

"""Intervals for shares: against their definitions."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.experiments.intervals import difference, wilson

_Z = 1.959963984540054

counts = st.integers(1, 500).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n)))


@settings(derandomize=True, deadline=None, max_examples=200)
@given(counts)
def test_the_bounds_are_where_the_score_test_turns(count: tuple[int, int]) -> None:
    """At a bound inside of ]0, 1[, the share is 1.96 standard deviations away from it."""
    successes, trials = count
    low, high = wilson(successes, trials)

    for bound in (low, high):
        if 0 < bound < 1:
            deviation = math.sqrt(bound * (1 - bound) / trials)
            assert abs(successes / trials - bound) == pytest.approx(_Z * deviation, rel=1e-6)
    assert 0 <= low <= successes / trials <= high <= 1


def test_nothing_is_known_of_no_trials() -> None:
    """Without trials everything is possible; with failures only, zero is."""
    assert wilson(0, 0) == (0.0, 1.0)
    assert wilson(0, 10)[0] == 0.0
    assert wilson(10, 10)[1] == 1.0


def test_more_successes_than_trials_are_refused() -> None:
    """There cannot be more successes than trials."""
    with pytest.raises(ValueError, match="at most 3"):
        wilson(4, 3)


def test_the_example_of_newcombe_comes_out() -> None:
    """56 of 70 against 48 of 80 differ by 0.0524 to 0.3339 (Newcombe 1998, table II, row a)."""
    low, high = difference((48, 80), (56, 70))

    assert low == pytest.approx(0.0524, abs=5e-5)
    assert high == pytest.approx(0.3339, abs=5e-5)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(counts, counts)
def test_a_difference_is_antisymmetric(one: tuple[int, int], other: tuple[int, int]) -> None:
    """The other way round, both bounds change their signs and places."""
    low, high = difference(one, other)
    back = difference(other, one)

    assert (low, high) == pytest.approx((-back.high, -back.low))
    assert low <= other[0] / other[1] - one[0] / one[1] <= high

"""Figures of delays, against the delays themselves."""

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.runtime.statistics import Delays

delays = st.lists(st.one_of(st.integers(-50, 5_000), st.integers(0, 10**11)), max_size=60)


def counted(given_delays):
    """Return the figures of some delays."""
    figures = Delays()
    for delay in given_delays:
        figures.add(delay)
    return figures


def nearest_rank(given_delays, percent):
    """Return the delay that *percent* of all do not exceed, by sorting them."""
    ranked = sorted(max(0, delay) for delay in given_delays)
    return ranked[max(0, math.ceil(len(ranked) * percent / 100) - 1)]


@settings(derandomize=True, deadline=None, max_examples=200)
@given(delays.filter(len), st.sampled_from([50, 90, 99, 100]))
def test_a_percentile_is_too_long_by_a_thirty_second_part_of_the_largest_at_most(some, percent):
    """Bins lose little, and never tell less than the truth nor more than the largest delay."""
    figures = counted(some)

    found, expected = figures.percentile(percent), nearest_rank(some, percent)

    assert expected <= found <= max(0, figures.largest)
    assert found - expected <= max(1_000, figures.largest / 32)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(delays, delays)
def test_figures_can_be_put_together_and_taken_apart(one, other):
    """Both together are as if all had been counted; a part taken away leaves the rest."""
    both = counted(one).plus(counted(other))
    rest = both.minus(counted(other))

    together = counted([*one, *other])
    assert (both.samples, both.total, both.largest) == (
        together.samples,
        together.total,
        together.largest,
    )
    assert (both.bins, both.width) == (together.bins, together.width)
    assert (rest.samples, rest.total) == (len(one), sum(one))
    assert counted(one).largest <= max(0, rest.largest) or not one


def test_without_delays_all_figures_are_zero():
    """An empty stream has no delays."""
    figures = Delays()

    assert (figures.mean, figures.percentile(99), figures.largest) == (0, 0, 0)

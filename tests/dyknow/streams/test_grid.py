"""Arithmetic on the grid of a sampled stream."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.grid import next_on_grid


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.integers(-50, 50), st.integers(1, 20), st.integers(-500, 500))
def test_the_next_time_on_the_grid_is_the_first_that_will_do(last, period, earliest):
    """It lies after the last one, whole periods away, and not before the earliest."""
    candidates = range(last + period, 2000, period)

    assert next_on_grid(last, period, earliest) == next(t for t in candidates if t >= earliest)

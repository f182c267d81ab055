"""Measurements are repeated in rounds and summed up by their medians."""

import gc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.benchmarks.measuring import line_through, measure, series, undisturbed
from traffic.benchmarks.results import Measurement, Point


def test_a_measurement_is_a_median_with_its_spread():
    """Of several values, the middle, the smallest and the largest are kept."""
    assert Measurement.of([3.0, 1.0, 2.0]) == Measurement(
        median=2.0, low=1.0, high=3.0, repetitions=3
    )


def test_rounds_measure_everything_once():
    """Each round runs every trial, and progress goes from the beginning to the end."""
    ran, told = [], []
    trials = {n: lambda n=n: ran.append(n) or float(len(ran)) for n in (5, 10)}

    found = measure(trials, 2, lambda share, what: told.append((share, what)), (0.5, 1.0), "cars")

    assert ran == [5, 10, 5, 10]
    assert found == {5: [1.0, 3.0], 10: [2.0, 4.0]}
    assert told == [
        (0.5, "5 cars"),
        (0.625, "10 cars"),
        (0.75, "5 cars"),
        (0.875, "10 cars"),
        (1.0, ""),
    ]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(
    st.floats(min_value=0.1, max_value=100),
    st.floats(min_value=1, max_value=100),
    st.lists(st.integers(min_value=1, max_value=1_000), min_size=2, max_size=6, unique=True),
)
def test_a_line_is_found_again(slope, intercept, places):
    """Through points on a line, the line is found."""
    found = series("x", {x: [intercept + slope * x] for x in places}, fitted=True)

    assert found.line is not None
    assert found.line.slope == pytest.approx(slope, rel=1e-6)
    assert found.line.at(0) == pytest.approx(intercept, rel=1e-4, abs=1e-4)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(st.floats(min_value=1, max_value=100), min_size=3, max_size=6))
def test_no_line_is_nearer(heights):
    """Of all lines tried, none has a smaller sum of squared relative distances."""
    points = [Point(x=x, y=Measurement.of([y])) for x, y in enumerate(heights)]
    x, y = np.arange(len(heights)), np.array(heights)

    line = line_through(points)

    def distance(slope: float, intercept: float) -> float:
        return float(np.sum(((intercept + slope * x - y) / y) ** 2))

    least = distance(line.slope, line.intercept)
    for by_slope in (-0.1, 0.0, 0.1):
        for by_intercept in (-0.1, 0.0, 0.1):
            other = distance(line.slope + by_slope, line.intercept + by_intercept)
            assert least <= other + 1e-9


def test_garbage_waits():
    """While something is measured no garbage is collected, and afterwards it is again."""
    with undisturbed():
        assert not gc.isenabled()
    assert gc.isenabled()

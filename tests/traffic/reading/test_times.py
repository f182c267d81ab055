"""Times and values in lines."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.errors import LineError
from traffic.reading.times import described, text_from_time, time_from


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.integers(-(10**18), 10**18))
def test_times_are_exact(time):
    """A time written in milliseconds is read to the same nanosecond."""
    assert time_from(text_from_time(time), str) == time


@pytest.mark.parametrize(
    ("amount", "time"), [(1, 1_000_000), (0.1, 100_000), ("1e3", 10**9), (-2.5, -2_500_000)]
)
def test_milliseconds_become_nanoseconds(amount, time):
    """Numbers and their digits are read alike."""
    assert time_from(amount, str) == time


@pytest.mark.parametrize(
    ("amount", "message"),
    [
        (True, "expected a time in milliseconds, found true"),
        ("", "expected a time in milliseconds, found ''"),
        ("nan", "expected a time in milliseconds, found 'nan'"),
        ("1_000", "expected a time in milliseconds, found '1_000'"),
        ("٣", "expected a time in milliseconds"),
        (1e-7, "expected a time in whole nanoseconds, found 1e-07 milliseconds"),
        ("1e-" + "9" * 30, "expected a time in whole nanoseconds"),
        ("1e" + "9" * 30, "expected a time of at most 4611686018427 milliseconds"),
        (-(10**13), "expected a time of at most 4611686018427 milliseconds, found -1000"),
        (float("inf"), "expected a time of at most 4611686018427 milliseconds, found inf"),
    ],
)
def test_other_times_are_refused(amount, message):
    """A time is a number of whole nanoseconds, within 146 years."""
    with pytest.raises(LineError, match=message):
        time_from(amount, lambda: "here")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "null"),
        (False, "false"),
        ("a", "'a'"),
        ([1], "an array"),
        ({}, "an object"),
        (1.5, "1.5"),
        (10**60, f"1{'0' * 39}…"),
        ("x" * 50, f"'{'x' * 40}…'"),
    ],
)
def test_values_are_told_as_they_stand_in_files(value, text):
    """Long ones are shortened."""
    assert described(value) == text

"""Durations as people write them."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.time import (
    MILLISECOND,
    MINUTE,
    SECOND,
    duration_from_text,
    milliseconds,
    seconds,
    text_from_duration,
)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("200", 200 * MILLISECOND),
        ("200 ms", 200 * MILLISECOND),
        ("1.5 s", 1500 * MILLISECOND),
        ("1min", MINUTE),
        ("2 h", 120 * MINUTE),
        ("3 us", 3000),
        ("7 ns", 7),
        ("-1", -MILLISECOND),
    ],
)
def test_a_bare_number_is_milliseconds_and_a_unit_may_follow(text, expected):
    """A number is milliseconds unless one of the known units follows it."""
    assert duration_from_text(text) == expected


@pytest.mark.parametrize("text", ["", "soon", "5 parsecs", "0.5 ns", "1e3"])
def test_a_text_that_is_no_duration_is_refused(text):
    """What is not a number with a known unit, or is finer than a nanosecond, is an error."""
    with pytest.raises(ValueError, match=r"expected|finer"):
        duration_from_text(text)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.integers(min_value=-(10**15), max_value=10**15))
def test_writing_then_reading_gives_the_same_duration(duration):
    """Text and duration are inverses, down to the nanosecond."""
    assert duration_from_text(text_from_duration(duration)) == duration


def test_amounts_in_floating_point_are_rounded_to_the_nearest_nanosecond():
    """A tenth of a second is exactly a hundred milliseconds."""
    assert seconds(0.1) == milliseconds(100) == SECOND // 10

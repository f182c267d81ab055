"""Points on the line between two samples."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.interpolation import interpolate
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from tests.support.streams import ms


def _between(before, after, time=25):
    """Return the value at *time*, between samples at 0 and at 100."""
    return interpolate(Sample(before, ms(0), ms(0)), Sample(after, ms(100), ms(100)), ms(time))


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        (0, 4, 1.0),
        (8.0, 0.0, 6.0),
        (np.float64(1), 2, 1.25),
        ((0, 4.0), (4, 0.0), (1.0, 3.0)),
        ("up", "up", "up"),
        (3, 3, 3),
        ((1, "up"), (5, "up"), (2.0, "up")),
    ],
)
def test_numbers_are_interpolated(before, after, expected):
    """A quarter of the way the value has changed by a quarter; what is the same stays so."""
    value = _between(before, after)

    assert value == expected
    assert type(value) is type(expected) or isinstance(value, float)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("up", "down"),
        (False, True),
        (1, "up"),
        (NO_VALUE, 1),
        ((1, "up"), (2, "down")),
        ((1, 2), (1, 2, 3)),
        (np.array([1.0]), np.array([1.0, 2.0])),
        (np.array(["a"]), np.array(["b"])),
        (Table("car", [], {}), Table("truck", [], {})),
    ],
)
def test_there_is_no_value_between_others(before, after):
    """Words, truths, absent values and things of different shape have nothing in between."""
    assert _between(before, after) is NO_VALUE


def test_arrays_are_interpolated_element_by_element():
    """Arrays of one shape are treated as their elements."""
    value = _between(np.array([0, 4]), np.array([4, 0]))

    assert value.tolist() == [1.0, 3.0]


def test_tables_have_the_objects_of_both():
    """Floating-point columns are interpolated, by object; all others keep their earlier value."""
    before = Table("car", [1, 2, 3], {"x": np.array([0.0, 1.0, 2.0]), "lane": np.array([0, 1, 2])})
    after = Table("car", [4, 3, 1], {"x": np.array([9.0, 6.0, 4.0]), "lane": np.array([7, 7, 7])})

    table = _between(before, after)

    assert table.ids.tolist() == [1, 3]
    assert table["x"].tolist() == [1.0, 3.0]
    assert table["lane"].tolist() == [0, 2]


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    st.floats(-1e6, 1e6),
    st.floats(-1e6, 1e6),
    st.integers(0, 100),
)
def test_a_line_is_interpolated_exactly(start, slope, time):
    """Of a fluent that changes at a constant rate every value between two samples is right."""
    value = _between(start, start + 100 * slope, time)

    assert value == pytest.approx(start + time * slope, abs=1e-6)

"""Equality of values of samples."""

import numpy as np
import pytest

from dyknow.streams.table import Table
from dyknow.streams.values import are_equal


def _table(**columns):
    return Table("car", [1, 2], {name: np.array(value) for name, value in columns.items()})


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        (1, 1, True),
        (1, 1.0, False),
        ("a", "b", False),
        ((1, "a"), (1, "a"), True),
        ((1,), (1, 2), False),
        (np.array([1, 2]), np.array([1, 2]), True),
        (np.array([1.0, np.nan]), np.array([1.0, np.nan]), True),
        (np.array(["a"]), np.array(["a"]), True),
        (np.array([1]), np.array([1.0]), False),
        (_table(x=[1.0, 2.0]), _table(x=[1.0, 2.0]), True),
        (_table(x=[1.0, 2.0]), _table(x=[1.0, 3.0]), False),
        (_table(x=[1.0, 2.0]), _table(y=[1.0, 2.0]), False),
        (_table(x=[1.0, 2.0]), 3, False),
        ({"x": np.array([1, 2])}, {"x": np.array([1, 2])}, True),
        ({"x": np.array([1, 2])}, {"x": np.array([1, 3])}, False),
        ({"x": 1}, {"x": 1, "y": 2}, False),
    ],
)
def test_values_are_equal_as_a_whole(left, right, expected):
    """Arrays, tables and mappings are one value, and nothing equals a value of another kind."""
    assert are_equal(left, right) is expected

"""How values and differences are told."""

from typing import Any

import numpy as np
import pytest

from dyknow.judging.wording import deviation, difference, short
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from tests.support.streams import ms


def cars(**columns: Any) -> Table:
    """Return a table of two cars."""
    return Table("car", [3, 7], {name: np.array(values) for name, values in columns.items()})


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (3, "3"),
        (np.float64(2.5), "2.5"),
        ("a" * 100, "'" + "a" * 58 + "…"),
        (cars(x=[1, 2]), "a table of 2 car"),
        (np.zeros((2, 3)), "an array (2, 3) of float64"),
    ],
)
def test_values_are_told_in_a_line(value: Any, text: str) -> None:
    """Whatever a value is, it is told in short."""
    assert short(value) == text


@pytest.mark.parametrize(
    ("expected", "found", "texts"),
    [
        (1, 2, ("1", "2")),
        (1, True, ("1", "True")),
        (1, 1.0, ("1", "1.0")),
        ((1, 2), (1, 3), ("in place 2, 2", "3")),
        ((1, 2), (1,), ("2 values: (1, 2)", "1: (1,)")),
        (cars(x=[1, 2]), cars(x=[1, 5]), ("x[car7] = 2", "5")),
        (cars(x=[np.nan, 2.0]), cars(x=[np.nan, 5.0]), ("x[car7] = 2.0", "5.0")),
        (cars(x=[1, 2]), cars(x=[1.0, 2.0]), ("column 'x' of int64", "float64")),
        (cars(x=[1, 2]), cars(y=[1, 2]), ("a table of car with x", "a table of car with y")),
        (
            cars(x=[1, 2]),
            Table("car", [3], {"x": np.array([1])}),
            ("objects [3, 7]", "[3]"),
        ),
        (np.array([1, 2]), np.array([1, 4]), ("2 at [1]", "4")),
        (
            np.zeros(2),
            np.zeros(3),
            ("an array (2,) of float64", "an array (3,) of float64"),
        ),
        (np.int64(1), 1, ("1 of int64", "1 of int")),
    ],
)
def test_a_difference_says_where_values_differ(
    expected: Any, found: Any, texts: tuple[str, str]
) -> None:
    """Of large values, the first place that differs is told."""
    assert difference(expected, found) == texts


def test_a_deviation_tells_times_and_value() -> None:
    """Samples differ in their times, their values, or all of these."""
    sample = Sample("a", ms(1), ms(2))

    assert deviation(sample, sample) == ("", "")
    assert deviation(sample, Sample("b", ms(1), ms(3))) == (
        "available time 2 and 'a'",
        "available time 3 and 'b'",
    )

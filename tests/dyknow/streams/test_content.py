"""What samples say."""

import numpy as np

from dyknow.streams.content import Contents
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint


def _sample(value, valid=0, available=0):
    return Sample(value, TimePoint(valid), TimePoint(available))


def test_samples_say_the_same_if_value_and_valid_time_are_the_same():
    """When a sample is available does not matter, and values may be tables."""
    contents = Contents()
    table = Table("car", [1], {"speed": np.array([1.0])})
    again = Table("car", [1], {"speed": np.array([1.0])})
    other = Table("car", [1], {"speed": np.array([2.0])})

    numbers = [contents.number(_sample(value, 0, at)) for at, value in enumerate("aba")]

    assert numbers[0] == numbers[2] != numbers[1]
    assert contents.number(_sample("a", 1, 0)) not in numbers
    assert contents.number(_sample(table)) == contents.number(_sample(again))
    assert contents.number(_sample(table)) != contents.number(_sample(other))

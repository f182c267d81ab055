"""Whether cars move."""

import numpy as np
import pytest

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.moving import Moving


def test_a_car_keeps_its_state_between_the_two_speeds():
    """Between the limits what was last decided stands."""
    unit = Moving(above=3.0, below=2.0)
    states = []
    for i, speed in enumerate([2.5, 1.5, 2.5, 3.5, 2.5]):
        table = Table("car", [1], {"speed": np.array([speed])})
        (out,) = unit.push(TimePoint(i), (Sample(table, TimePoint(i), TimePoint(i)),))
        states.append(bool(out.value["moving"][0]))

    assert states == [True, False, False, True, True]


def test_limits_in_the_wrong_order_are_refused():
    """The speed for resting may not exceed that for moving."""
    with pytest.raises(ValueError, match="below <= above"):
        Moving(above=1.0, below=2.0)

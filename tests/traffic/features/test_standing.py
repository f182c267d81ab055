"""Whether cars stand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from traffic.features.standing import Standing


def states(speeds):
    """Return whether one car stands at each speed, one after the other."""
    unit = Standing(below=0.5, above=1.0)
    found = []
    for i, speed in enumerate(speeds):
        table = Table("car", [1], {"speed": np.array([speed])})
        (out,) = unit.push(TimePoint(i), (Sample(table, TimePoint(i), TimePoint(i)),))
        found.append(bool(out.value["standing"][0]))
    return found


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.sampled_from([0.0, 0.4, 0.5, 0.8, 1.0, 1.1, 9.0]), max_size=12))
def test_the_last_speed_outside_the_limits_decides(speeds):
    """A car stands if of all speeds below the one and above the other the last was slow."""
    for i, stands in enumerate(states(speeds)):
        clear = [speed for speed in speeds[: i + 1] if speed < 0.5 or speed > 1.0]
        assert stands == bool(clear and clear[-1] < 0.5)


def test_limits_in_the_wrong_order_are_refused():
    """The speed for coming to rest may not exceed that for moving off."""
    with pytest.raises(ValueError, match="below <= above"):
        Standing(below=2.0, above=1.0)

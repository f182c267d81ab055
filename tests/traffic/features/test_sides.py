"""Whether cars are on the side on which one drives the other way."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.reading import read_road_map
from traffic.features.sides import Sides

RURAL = Path(__file__).parents[3] / "data" / "networks" / "rural" / "rural.net.xml"
ROAD_MAP = read_road_map(RURAL)
LANES = [ROAD_MAP.lanes.index(name) for name in ("west_junction_0", "junction_west_0")]


def sides(moments):
    """Return whether a car that drives east is on the wrong side, frame by frame.

    A moment is its lane (0 for the own one, 1 for the other, None for none), whether it is in a
    crossing, and its speed.
    """
    unit = Sides(ROAD_MAP, moving=2.0)
    lines = ROAD_MAP.lane_columns.lines
    found = []
    for i, (lane, in_crossing, speed) in enumerate(moments):
        own = np.array([LANES[0]])
        s = np.array([400.0])
        columns = {
            "position": lines.at(own, s, np.array([3.3 if lane else 0.0])),
            "heading": lines.heading_at(own, s),
            "speed": np.array([speed]),
            "lane": np.array([-1 if lane is None else LANES[lane]]),
            "crossing": np.array([0 if in_crossing else -1]),
        }
        sample = Sample(Table("car", [1], columns), TimePoint(i), TimePoint(i))
        (out,) = unit.push(TimePoint(i), (sample,))
        found.append(bool(out.value["wrong_side"][0]))
    return found


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    st.lists(
        st.sampled_from(
            [
                (0, False, 9.0),
                (1, False, 9.0),
                (None, False, 9.0),
                (None, True, 9.0),
                (1, False, 1.0),
            ]
        ),
        max_size=10,
    )
)
def test_the_last_lane_counts_while_a_car_moves(moments):
    """Off the lanes it stays on its side; in crossings, and when it hardly moves, it has none."""
    for i, wrong in enumerate(sides(moments)):
        lane, in_crossing, speed = moments[i]
        expected = lane == 1 and speed >= 2.0
        if lane is None and not in_crossing:
            told = [m for m in moments[: i + 1] if m != (None, False, 9.0)]
            expected = bool(told) and told[-1] == (1, False, 9.0)
        assert wrong == expected


def test_a_speed_of_nothing_is_refused():
    """A car that stands has no direction."""
    with pytest.raises(ValueError, match="more than 0 m/s"):
        Sides(ROAD_MAP, moving=0.0)

"""Past which stop line cars are."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.reading import read_road_map
from traffic.features.stop_lines import StopLines

NETWORKS = Path(__file__).parents[3] / "data" / "networks"
TOWN = read_road_map(NETWORKS / "crossing" / "crossing.net.xml")
APPROACH = TOWN.roads.index("south_centre")
WAY = TOWN.successors(APPROACH)[0]
ONWARD = TOWN.successors(WAY)[0]
SIGNALS = [TOWN.signals.names.index(f"south_centre_{lane}") for lane in (0, 1)]
LENGTH = 4.0


def past(places, beyond=4.0, slack=1.0, roads=TOWN):
    """Return `over` and `beyond` of one car at places (road, s, d), one after the other."""
    unit = StopLines(roads, beyond=beyond, slack=slack)
    found = []
    for i, (road, s, d) in enumerate(places):
        columns = {
            "road": np.array([road], dtype=np.int32),
            "s": np.array([s]),
            "d": np.array([d]),
            "length": np.array([LENGTH]),
            "observed": np.array([True]),
        }
        sample = Sample(Table("car", [4], columns), TimePoint(i), TimePoint(i))
        (out,) = unit.push(TimePoint(i), (sample,))
        found.append((int(out.value["over"][0]), int(out.value["beyond"][0])))
    return found


def along(front):
    """Return the place of a car whose front is so far past the line, on the right lane."""
    s = float(TOWN.road_length[APPROACH]) + front - LENGTH / 2
    length = float(TOWN.road_length[APPROACH])
    return (APPROACH, s, -1.6) if s <= length else (WAY, s - length, -1.6)


def test_a_car_that_drives_on_gets_over_the_line_and_beyond():
    """The signal is that of its lane, also on the way through the crossing, and none behind it."""
    right, left = SIGNALS

    assert past([along(x) for x in (-3.0, 0.5, 3.5, 6.0)]) == [
        (-1, -1),
        (right, -1),
        (right, -1),
        (right, right),
    ]
    assert past([(APPROACH, float(TOWN.road_length[APPROACH]), 1.6)]) == [(left, -1)]
    assert past([along(6.0), (ONWARD, 3.0, 0.0)]) == [(-1, -1), (-1, -1)]


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.sampled_from([-3.0, -0.9, 0.1, 1.0, 3.2, 4.1, 9.0]), min_size=1, max_size=10))
def test_a_front_that_is_past_must_come_back_by_the_slack(fronts):
    """What has happened before decides while the front is within the slack of a limit."""
    found = past([along(-9.0), *map(along, fronts)])[1:]

    for column, limit in ((0, 0.0), (1, 4.0)):
        is_past = False
        for front, row in zip(fronts, found, strict=True):
            is_past = front >= limit or (is_past and front >= limit - 1.0)
            assert row[column] == (SIGNALS[0] if is_past else -1)


def test_a_map_without_signals_has_no_lines():
    """All cars are past none."""
    rural = read_road_map(NETWORKS / "rural" / "rural.net.xml")

    assert past([(0, 10.0, 0.0)], roads=rural) == [(-1, -1)]


def test_limits_that_make_no_sense_are_refused():
    """Beyond is past the line, and slack is not less than none."""
    with pytest.raises(ValueError, match="beyond > 0"):
        StopLines(TOWN, beyond=0.0, slack=1.0)

"""Who stands in a crossing, against the definition read word by word."""

from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.reading import read_road_map
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces
from traffic.truth.standing import StandingWatcher

CROSSING = Path(__file__).parents[3] / "data" / "networks" / "crossing" / "crossing.net.xml"
ROAD_MAP = read_road_map(CROSSING)
INSIDE, BEFORE = (0.0, 0.0), (60.0, 12.8)
NOWHERE = TruePlaces(*(np.full(1, -1, np.int32),) * 2, *(np.full(1, np.nan),) * 5)  # type: ignore[arg-type]

Moment = tuple[bool, float]
"""Whether the car is in the crossing, and its speed."""


def watch(moments: list[Moment]) -> list[TrueManoeuvre]:
    """Return who stops in the crossing, with a frame each second."""
    watcher, found = StandingWatcher(ROAD_MAP), []
    for i, (inside, speed) in enumerate(moments):
        columns = {
            "position": np.array([INSIDE if inside else BEFORE]),
            "speed": np.array([speed]),
        }
        table = Table("vehicle", (3,), columns)
        found += watcher.observe(Frame(TimePoint(i * SECOND), table, table), NOWHERE)
    return found + watcher.finish()


def test_five_seconds_inside_are_a_stop() -> None:
    """From the first frame in which it stands to the last one."""
    moments = [(True, 5.0), *[(True, 0.0)] * 6, (True, 4.0)]

    assert watch(moments) == [
        TrueManoeuvre(
            "stop_in_crossing", (3,), ("centre",), TimePoint(SECOND), TimePoint(6 * SECOND)
        )
    ]
    assert watch([(True, 5.0), *[(True, 0.0)] * 5, (True, 4.0)]) == []


def test_waiting_before_the_crossing_is_none() -> None:
    """However long it takes."""
    assert watch([(False, 0.0)] * 30) == []


def naive(moments: list[Moment]) -> list[tuple[int, int]]:
    """Return the first and the last frame of each stop."""
    stands = False
    inside = []
    for is_inside, speed in moments:
        stands = speed < 0.3 or (stands and speed <= 1.0)
        inside.append(stands and is_inside)
    found = []
    for begin in range(len(inside)):
        end = begin
        while end < len(inside) and inside[end]:
            end += 1
        if (begin == 0 or not inside[begin - 1]) and end - 1 - begin >= 5:
            found.append((begin, end - 1))
    return found


@given(
    st.lists(
        st.tuples(st.sampled_from([True] * 9 + [False]), st.sampled_from([0.0, 0.2, 0.2, 0.7, 2])),
        max_size=30,
    )
)
@settings(derandomize=True, deadline=None, max_examples=300)
def test_the_watcher_agrees_with_the_definition(moments: list[Moment]) -> None:
    """Frame by frame it finds what looking at all frames finds."""
    found = [(each.begin // SECOND, each.end // SECOND) for each in watch(moments)]

    assert found == naive(moments)

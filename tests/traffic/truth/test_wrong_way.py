"""Who drives the wrong way, on hand-made cases and against the definition read word by word."""

from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.reading import read_road_map
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import PlaceReader
from traffic.truth.wrong_way import WrongWayWatcher

RURAL = Path(__file__).parents[3] / "data" / "networks" / "rural" / "rural.net.xml"
ROAD_MAP = read_road_map(RURAL)
OWN, OTHER = "west_junction_0", "junction_west_0"
STEP = SECOND
LENGTH = 4.0

Moment = tuple[bool, float, float | None]
"""Whether the car is on the other side, its speed, and how far another one is ahead on its own."""


def watch(moments: list[Moment]) -> list[TrueManoeuvre]:
    """Return who drives the wrong way, with a frame each second."""
    watcher, found = WrongWayWatcher(ROAD_MAP), []
    lanes = [OWN, OTHER]
    places = PlaceReader(ROAD_MAP, lanes)
    columns = ROAD_MAP.lane_columns
    own = np.array([columns.names.index(OWN)])
    for i, (is_across, speed, ahead) in enumerate(moments):
        s = 300.0 + 10.0 * i
        rows = [(0, s, 3.3 if is_across else 0.0, int(is_across))]
        rows += [] if ahead is None else [(1, s + ahead, 0.0, 0)]
        position = [columns.lines.at(own, np.array([x]), np.array([d]))[0] for _, x, d, _ in rows]
        heading = [columns.lines.heading_at(own, np.array([x]))[0] for _, x, _, _ in rows]
        ids = [row[0] for row in rows]
        vehicles = {
            "position": np.array(position),
            "heading": np.array(heading),
            "speed": np.full(len(rows), speed),
            "length": np.full(len(rows), LENGTH),
        }
        lane = np.array([row[3] for row in rows], dtype=np.int32)
        frame = Frame(
            TimePoint(i * STEP),
            Table("vehicle", ids, vehicles),
            Table("vehicle", ids, {"lane": lane}),
        )
        found += watcher.observe(frame, places.read(frame))
    return found + watcher.finish()


def test_five_seconds_on_the_other_side_are_the_wrong_way() -> None:
    """From the first frame there to the last one; less is nothing."""
    wrong = (True, 12.0, None)
    right = (False, 12.0, None)

    assert watch([right, *[wrong] * 6, right]) == [
        TrueManoeuvre("wrong_way", (0,), (), TimePoint(STEP), TimePoint(6 * STEP))
    ]
    assert watch([right, *[wrong] * 5, right]) == []
    assert watch([right] * 9) == []


def test_who_overtakes_has_a_reason() -> None:
    """Drawing level with someone who was ahead is enough, whatever follows."""
    gaps = [30.0, 20.0, 10.0, 3.0, 10.0, 20.0, 30.0]

    assert watch([(True, 12.0, gap) for gap in gaps]) == []
    assert watch([(True, 12.0, 30.0)] * 7)


def naive(moments: list[Moment]) -> list[tuple[int, int]]:
    """Return the first and the last frame of each stretch that counts."""
    wrong = [is_across and speed > 1.0 for is_across, speed, _ in moments]
    found = []
    for begin in range(len(wrong)):
        end = begin
        while end < len(wrong) and wrong[end]:
            end += 1
        if not wrong[begin] or (begin > 0 and wrong[begin - 1]) or end - 1 - begin < 5:
            continue
        gaps = [moments[i][2] for i in range(begin, end)]
        passed = any(
            first is not None and LENGTH < first <= 60 and second is not None and second <= LENGTH
            for i, first in enumerate(gaps)
            for second in gaps[i + 1 :]
        )
        if not passed:
            found.append((begin, end - 1))
    return found


@given(
    st.lists(
        st.tuples(
            st.sampled_from([True] * 9 + [False]),
            st.sampled_from([9.0] * 9 + [0.5]),
            st.sampled_from([None, None, 90.0, 30.0, 30.0, 30.0, 30.0, 30.0, 2.0, -20.0]),
        ),
        max_size=25,
    )
)
@settings(derandomize=True, deadline=None, max_examples=200)
def test_the_watcher_agrees_with_the_definition(moments: list[Moment]) -> None:
    """Frame by frame it finds what looking at all frames finds."""
    found = [(each.begin // STEP, each.end // STEP) for each in watch(moments)]

    assert found == naive(moments)

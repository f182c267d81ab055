"""The definition of broken off overtakes, on hand-made cases and against its naive reading."""

from collections.abc import Sequence

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.aborted_overtakes import AbortedOvertakeWatcher
from traffic.truth.manoeuvres import TrueManoeuvre

BEHIND, OUT, LEVEL, IN_FRONT = (-9.0, 0.0), (-9.0, 3.5), (0.0, 3.5), (9.0, 3.5)
ATTEMPT = [BEHIND, OUT, LEVEL, LEVEL, OUT, BEHIND]

Place = tuple[float, float]
"""How far ahead of the other and how far to its left a car is, metres."""


def watch(
    places: Sequence[Place], *, speed: float = 10.0, step: int = SECOND
) -> list[TrueManoeuvre]:
    """Return what car 0 breaks off beside car 1, both of 4 m, one place a frame."""
    watcher, found = AbortedOvertakeWatcher(), []
    for i, (ahead, left) in enumerate(places):
        progress = np.array([100.0 + ahead, 100.0])
        columns = {
            "position": np.column_stack([progress, [left, 0.0]]),
            "heading": np.zeros(2),
            "speed": np.array([10.0, speed]),
            "length": np.full(2, 4.0),
        }
        vehicles = Table("vehicle", [0, 1], columns)
        where = true_places(2, link=np.zeros(2, dtype=np.int32), progress=progress)
        frame = Frame(TimePoint(i * step), vehicles, Table("vehicle", [0, 1], {}))
        found += watcher.observe(frame, where)
    return found + watcher.finish()


def test_an_attempt_lasts_from_the_line_to_the_line() -> None:
    """From the last frame in line before to the first one in line after."""
    assert watch([BEHIND, *ATTEMPT]) == [
        TrueManoeuvre("overtake_aborted", (0, 1), (), TimePoint(SECOND), TimePoint(6 * SECOND))
    ]


def test_look_alikes_are_none() -> None:
    """Overtaking, changing lanes and back, swaying beside, being in a queue, taking too long."""
    assert watch([BEHIND, OUT, LEVEL, IN_FRONT, LEVEL, OUT, BEHIND]) == []
    assert watch([BEHIND, OUT, OUT, BEHIND]) == []
    assert watch([OUT, LEVEL, OUT, LEVEL, OUT]) == []
    assert watch(ATTEMPT, speed=2.0) == []
    assert watch(ATTEMPT, step=20 * SECOND) == []


def test_three_within_two_minutes_are_again_and_again() -> None:
    """From the end of the first to that of the third; then it is counted from anew."""
    found = [each for each in watch(ATTEMPT * 5) if each.kind == "overtake_again_and_again"]

    assert found == [
        TrueManoeuvre(
            "overtake_again_and_again", (0,), (), TimePoint(5 * SECOND), TimePoint(17 * SECOND)
        )
    ]
    assert len(watch(ATTEMPT * 6)) == 6 + 2
    slow = watch(ATTEMPT * 3, step=11 * SECOND)
    assert [each.kind for each in slow] == ["overtake_aborted"] * 3


def attempts_by_definition(places: Sequence[Place]) -> list[tuple[int, int]]:
    """Return begin and end of all attempts, by trying all pairs of frames."""
    found = []
    for begin in range(len(places)):
        for end in range(begin + 2, len(places)):
            between = places[begin + 1 : end]
            if (
                places[begin] == places[end] == BEHIND
                and all(left != 0.0 and ahead != IN_FRONT[0] for ahead, left in between)
                and LEVEL in between
            ):
                found.append((begin, end))
    return found


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.lists(st.sampled_from([BEHIND, OUT, LEVEL, IN_FRONT]), max_size=14))
def test_attempts_are_those_of_the_definition(places: list[Place]) -> None:
    """For any sequence of places, what trying all stretches finds."""
    found = [
        (each.begin // SECOND, each.end // SECOND)
        for each in watch(places)
        if each.kind == "overtake_aborted" and each.vehicles == (0, 1)
    ]

    assert found == attempts_by_definition(places)

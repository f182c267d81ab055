"""The definition of a near collision."""

from collections.abc import Sequence

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, TimePoint
from networks.building import straight_road
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.near_collisions import NearCollisionWatcher

ROAD = straight_road(600.0, lanes=1)
STEP = 40


def watch(frames: Sequence[Sequence[tuple[float, float]]]) -> list[TrueManoeuvre]:
    """Return the near collisions of cars of 4 m by 2 m, of which each has a place and a speed."""
    watcher, found = NearCollisionWatcher(ROAD), []
    for i, rows in enumerate(frames):
        s, speed = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
        n = len(rows)
        road = np.zeros(n, dtype=np.int32)
        columns = {
            "position": ROAD.point_at(road, s),
            "heading": ROAD.heading_at(road, s),
            "speed": speed,
            "length": np.full(n, 4.0),
            "width": np.full(n, 2.0),
        }
        ids = np.arange(n)
        frame = Frame(
            TimePoint(i * STEP * MILLISECOND), Table("vehicle", ids, columns),
            Table("vehicle", ids, {}),
        )  # fmt: skip
        places = true_places(n, road=road, s=s, d=np.zeros(n))
        found += watcher.observe(frame, places)
    return found + watcher.finish()


def braking(deceleration: float, left: float) -> list[list[tuple[float, float]]]:
    """Return frames in which one brakes from 12 m/s and stops with so much room left."""
    frames = []
    for i in range(200):
        gap = 40.0 - 12.0 * i * STEP / 1000
        needed = 144 / (2 * deceleration) + left
        speed = 12.0
        if gap < needed:
            passed = (needed - gap) / 12.0
            speed = max(12.0 - deceleration * passed, 0.0)
            gap = needed - (12.0 * passed - deceleration * passed**2 / 2)
            gap = gap if speed > 0 else left
        frames.append([(100.0 - gap, speed), (104.0, 0.0)])
    return frames


def test_braking_as_drivers_do_is_no_danger() -> None:
    """4.5 m/s² and 2.5 m to the one who stands."""
    assert watch(braking(4.5, 2.5)) == []


def test_braking_at_the_last_moment_is_one() -> None:
    """As hard as one can, with little left: it is told once."""
    (found,) = watch(braking(8.5, 0.8))

    assert (found.kind, found.vehicles) == ("near_collision", (0, 1))
    assert 200 <= (found.end - found.begin) / MILLISECOND < 2000


def test_the_smaller_number_stands_first() -> None:
    """Who endangers whom does not matter."""
    swapped = [[rows[1], rows[0]] for rows in braking(8.5, 0.8)]

    assert [found.vehicles for found in watch(swapped)] == [(0, 1)]


def test_following_closely_is_no_collision_course() -> None:
    """Two cars at one speed, however near."""
    assert watch([[(100.0 + i, 25.0), (104.5 + i, 25.0)] for i in range(50)]) == []


@settings(derandomize=True, deadline=None, max_examples=15)
@given(st.lists(st.tuples(st.booleans(), st.integers(1, 50)), max_size=5))
def test_episodes_are_those_of_the_naive_reading(pieces: list[tuple[bool, int]]) -> None:
    """Runs of danger of 0.2 s, which are one when they are at most 3 s apart."""
    danger = [is_on for is_on, count in pieces for _ in range(count)]
    frames = [[(100.0, 12.0 if is_on else 0.0), (108.0, 0.0)] for is_on in danger]

    found = [] if not frames else watch(frames)

    runs: list[list[int]] = []
    for i, is_on in enumerate(danger):
        if is_on and runs and i - runs[-1][-1] <= 2:  # a break of 100 ms is none
            runs[-1].append(i)
        elif is_on:
            runs.append([i])
    joined: list[list[list[int]]] = []
    for run in runs:
        if joined and (run[0] - joined[-1][-1][-1]) * STEP <= 3000:
            joined[-1].append(run)
        else:
            joined.append([run])
    expected = [
        (group[0][0], group[-1][-1])
        for group in joined
        if any((run[-1] - run[0]) * STEP >= 200 for run in group)
    ]
    times = [
        (each.begin // (STEP * MILLISECOND), each.end // (STEP * MILLISECOND)) for each in found
    ]
    assert times == expected

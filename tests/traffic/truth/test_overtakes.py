"""The definition of an overtake, on hand-made cases and against its naive reading."""

from collections.abc import Sequence
from itertools import permutations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.overtakes import OvertakeWatcher

Row = tuple[int, float, float, int, float]
"""Vehicle, progress, speed, link, metres to the left of the middle of the road."""


def watch(frames: Sequence[Sequence[Row]], step: int = SECOND) -> list[TrueManoeuvre]:
    """Return the overtakes among cars of 4 m that travel east, on whichever side."""
    return [each for each in watch_all(frames, step) if each.kind == "overtake"]


def watch_all(frames: Sequence[Sequence[Row]], step: int = SECOND) -> list[TrueManoeuvre]:
    """Return the same with the overtakes on each side."""
    watcher, found = OvertakeWatcher(), []
    for i, rows in enumerate(frames):
        ids, progress, speed, link, left = (np.array(c) for c in zip(*rows, strict=True))
        n = len(ids)
        vehicles = Table(
            "vehicle",
            ids,
            {
                "position": np.column_stack([progress, left]),
                "heading": np.zeros(n),
                "speed": speed,
                "length": np.full(n, 4.0),
            },
        )
        places = true_places(n, link=link.astype(np.int32), progress=progress.astype(float))
        frame = Frame(TimePoint(i * step), vehicles, Table("vehicle", ids, {}))
        found += watcher.observe(frame, places)
    return found + watcher.finish()


def pass_by(
    speed: float = 12.0, link: Sequence[int] = (0,) * 9, left: float = 3.5
) -> list[list[Row]]:
    """Return frames in which car 0 comes from 18 m behind car 1 to 14 m in front of it."""
    return [[(0, 4.0 * i, speed, link[i], left), (1, 18.0, 8.0, link[i], 0.0)] for i in range(9)]


def test_a_car_that_passes_another_overtakes_it() -> None:
    """From the last frame at least 5 m behind to the first at least 5 m in front, on the left."""
    assert watch_all(pass_by()) == [
        TrueManoeuvre(kind, (0, 1), (), TimePoint(3 * SECOND), TimePoint(6 * SECOND))
        for kind in ("overtake", "overtake_left")
    ]


def test_the_side_is_that_of_the_overtaker() -> None:
    """A car that passes to the right of the other overtakes on the right, the wrong side."""
    kinds = [each.kind for each in watch_all(pass_by(left=-3.5))]

    assert kinds == ["overtake", "overtake_right", "overtake_wrong_side"]


def test_the_numbers_of_the_cars_do_not_matter() -> None:
    """The car with the larger id may overtake just as well."""
    swapped = [[(1 - row[0], *row[1:]) for row in rows] for rows in pass_by()]

    assert [(each.kind, each.vehicles) for each in watch_all(swapped)] == [
        ("overtake", (1, 0)),
        ("overtake_left", (1, 0)),
    ]


def test_slow_changes_of_order_are_none() -> None:
    """In a queue, where one of the cars drives 3 m/s or less, nobody overtakes."""
    assert watch(pass_by(speed=3.0)) == []


def test_a_stop_in_between_breaks_an_overtake() -> None:
    """Both must be moving in every frame from begin to end."""
    frames = pass_by()
    frames[5] = [(0, 20.0, 12.0, 0, 3.5), (1, 18.0, 0.0, 0, 0.0)]

    assert watch(frames) == []


def test_leaving_the_link_breaks_an_overtake() -> None:
    """Who is on another link, or on none, in between has not overtaken."""
    assert watch(pass_by(link=[0, 0, 0, 0, 0, -1, 0, 0, 0])) == []
    assert watch(pass_by(link=[0, 0, 0, 0, 0, 1, 1, 1, 1])) == []


def test_an_overtake_may_not_last_longer_than_a_minute() -> None:
    """Sixty seconds from begin to end are allowed, more are not."""
    assert watch(pass_by(), step=20 * SECOND)
    assert watch(pass_by(), step=21 * SECOND) == []


def test_who_falls_back_has_not_overtaken() -> None:
    """A car that draws level and drops behind again has overtaken nobody."""
    frames = [*pass_by()[:6], *reversed(pass_by()[:6])]

    assert watch(frames) == []


def test_an_overtake_within_one_step_counts() -> None:
    """A car that is behind in one frame and in front in the next has overtaken in that step."""
    frames: list[list[Row]] = [
        [(0, x, 20.0, 0, 3.5), (1, 18.0, 8.0, 0, 0.0)] for x in (10.0, 28.0)
    ]

    assert [(each.kind, each.begin, each.end) for each in watch_all(frames)] == [
        ("overtake", 0, SECOND),
        ("overtake_left", 0, SECOND),
    ]


def naive(frames: Sequence[Sequence[Row]]) -> set[tuple[int, int, int, int]]:
    """Return overtaker, overtaken, begin and end by reading the definition for every pair."""
    states = [{row[0]: row for row in rows} for rows in frames]
    found = set()
    for a, b in permutations({row[0] for rows in frames for row in rows}, 2):
        together = [
            a in s and b in s and s[a][3] == s[b][3] >= 0 and abs(s[a][1] - s[b][1]) <= 60
            for s in states
        ]
        ahead = [s[a][1] - s[b][1] if ok else 0.0 for s, ok in zip(states, together, strict=True)]
        fast = [ok and s[a][2] > 3 and s[b][2] > 3 for s, ok in zip(states, together, strict=True)]
        for begin in range(len(frames)):
            for end in range(begin + 1, len(frames)):
                if (
                    ahead[begin] <= -5
                    and ahead[end] >= 5
                    and all(abs(x) < 5 for x in ahead[begin + 1 : end])
                    and all(fast[begin : end + 1])
                    and len({s[a][3] for s in states[begin : end + 1]}) == 1
                ):
                    found.add((a, b, begin * SECOND, end * SECOND))
    return found


@st.composite
def journeys(draw: st.DrawFn) -> list[list[Row]]:
    """Return frames of a few cars that jump about, come, go, stop and change links."""
    frames = []
    for _ in range(draw(st.integers(2, 10))):
        ids = draw(st.lists(st.integers(0, 4), min_size=1, max_size=5, unique=True))
        moved = draw(st.sampled_from([0, 0, 0, 1]))
        frames.append(
            [
                (
                    i,
                    draw(st.integers(0, 80)) + i * 0.01,
                    draw(st.sampled_from([10.0, 10.0, 10.0, 2.0])),
                    draw(st.sampled_from([moved, moved, moved, moved, 1, -1])),
                    0.0,
                )
                for i in ids
            ]
        )
    return frames


@given(journeys())
@settings(derandomize=True, deadline=None, max_examples=300)
def test_the_watcher_agrees_with_the_definition(frames: list[list[Row]]) -> None:
    """All pairs at once, frame by frame, give what quantifying over the whole past gives."""
    found = {(*found.vehicles, found.begin, found.end) for found in watch(frames)}

    assert found == naive(frames)

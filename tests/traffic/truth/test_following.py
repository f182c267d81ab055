"""The definitions of tailgating, convoys and being followed, and their naive readings."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.building import four_arm_crossing, straight_road
from networks.turns import Turn
from tests.support.true_places import true_places
from traffic.sumo.simulation import Frame
from traffic.truth.following import FollowedWatcher, FollowingWatcher
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.turns import TurnWatcher

ROAD = straight_road(2000.0, lanes=2)
LENGTH = 4.0
Row = tuple[int, float, float, float]
"""Vehicle, metres along the road, metres to the left of its middle, speed."""


def watch(frames: Sequence[Sequence[Row]], step: float = 1.0) -> list[TrueManoeuvre]:
    """Return what cars of 4 m do on a straight road of two lanes each way."""
    watcher, found = FollowingWatcher(ROAD), []
    for i, rows in enumerate(frames):
        ids, s, d, speed = (np.array(c) for c in zip(*rows, strict=True))
        vehicles = {"speed": speed.astype(float), "length": np.full(len(ids), LENGTH)}
        frame = Frame(
            TimePoint(round(i * step * SECOND)),
            Table("vehicle", ids, vehicles),
            Table("vehicle", ids, {}),
        )
        road = np.zeros(len(ids), dtype=np.int32)
        places = true_places(len(ids), road=road, s=s.astype(float), d=d.astype(float))
        found += watcher.observe(frame, places)
    return found + watcher.finish()


def column(
    time_gaps: Sequence[float], n_frames: int, speed: float = 10.0, lane: float = -1.6
) -> list[list[Row]]:
    """Return frames in which each car drives so many seconds behind the one before it."""
    back = np.concatenate([[0.0], np.cumsum([gap * speed + LENGTH for gap in time_gaps])])
    return [
        [(i, 600.0 + speed * t - back[i], lane, speed) for i in range(len(back))]
        for t in range(n_frames)
    ]


def test_who_drives_closely_for_four_seconds_tailgates() -> None:
    """From the first frame to the last, if that is four seconds or more."""
    (found,) = watch(column([0.5], 7))

    assert (found.kind, found.vehicles) == ("tailgating", (1, 0))
    assert (found.begin, found.end) == (0, 6 * SECOND)
    assert watch(column([0.5], 4)) == []


def test_slow_columns_are_no_tailgating() -> None:
    """At 8 m/s or less a short gap is none."""
    assert watch(column([0.5], 10, speed=8.0)) == []


def test_a_gap_that_opens_a_little_goes_on() -> None:
    """Up to one and a quarter times the time gap, tailgating goes on but does not begin."""
    frames = [*column([0.6], 3), *column([0.8], 6)[3:], *column([0.9], 9)[6:]]

    (found,) = watch(frames)

    assert (found.begin, found.end) == (0, 5 * SECOND)
    assert watch(column([0.8], 10)) == []


def test_a_car_on_the_other_lane_is_not_tailgated() -> None:
    """Only the next one on the same lane counts."""
    beside = [
        [row if row[0] else (0, row[1], 1.6, row[3]) for row in rows] for rows in column([0.5], 9)
    ]

    assert watch(beside) == []


def test_three_in_a_row_are_a_convoy() -> None:
    """First, second, third, for twenty seconds."""
    (found,) = watch(column([2.0, 2.4], 21))

    assert (found.kind, found.vehicles) == ("convoy", (0, 1, 2))
    assert watch(column([2.0, 2.4], 20)) == []
    assert watch(column([2.0, 2.6], 30)) == []


def test_five_in_a_row_are_three_convoys() -> None:
    """Each three that follow one another are one."""
    found = watch(column([2.0] * 4, 25))

    assert [each.vehicles for each in found] == [(0, 1, 2), (1, 2, 3), (2, 3, 4)]


def test_a_convoy_that_stops_is_over() -> None:
    """A queue does not move."""
    assert watch([*column([2.0, 2.0], 15), *column([2.0, 2.0], 9, speed=2.0)]) == []


@st.composite
def driving(draw: st.DrawFn) -> list[list[Row]]:
    """Return frames of four cars that change their places by and by."""
    frames = []
    choices = st.tuples(
        st.sampled_from([0.0, 9.0, 10.5, 12.0, 30.0]),
        st.sampled_from([-1.6, 1.6]),
        st.sampled_from([7.0, 12.0]),
    )
    rows = [draw(choices) for _ in range(4)]
    for _ in range(draw(st.integers(8, 24))):
        if draw(st.integers(0, 5)) == 0:
            rows[draw(st.integers(0, 3))] = draw(choices)
        places = np.cumsum([row[0] for row in rows])
        frames.append([(i, 100.0 + places[i], d, v) for i, (_, d, v) in enumerate(rows)])
    return frames


def naive_tailgating(frames: list[list[Row]], step: float) -> list[tuple[int, int, float, float]]:
    """Return who tailgates whom from when to when, pair by pair and frame by frame."""
    found = []
    for one in range(4):
        for other in range(4):
            held = []
            for rows in frames:
                _, s, d, v = rows[one]
                ahead = [r for r in rows if r[1] > s and abs(r[2] - d) <= 1.6]
                nearest = min((r[1] for r in ahead), default=np.inf)
                slack = 1.25 if held and held[-1] else 1.0
                gap = (rows[other][1] - s - LENGTH) / v
                is_next = rows[other] in ahead and rows[other][1] == nearest
                held.append(bool(is_next and gap < slack * 0.7 and slack * v > 8.0))
            for begin in range(len(held)):
                if held[begin] and not (begin and held[begin - 1]):
                    end = next((i for i in range(begin, len(held)) if not held[i]), len(held)) - 1
                    if (end - begin) * step >= 4:
                        found.append((one, other, begin * step, end * step))
    return found


@given(driving())
@settings(derandomize=True, deadline=None, max_examples=150)
def test_tailgating_agrees_with_its_definition_pair_by_pair(frames: list[list[Row]]) -> None:
    """Trying all pairs in all frames finds the same."""
    apart = [
        [(i, s + i * 1e-6, d, v) for i, s, d, v in rows] for rows in frames
    ]  # nobody is exactly beside another

    found = [each for each in watch(apart, 1.0) if each.kind == "tailgating"]

    assert sorted(
        (*each.vehicles, each.begin / SECOND, each.end / SECOND) for each in found
    ) == sorted(naive_tailgating(apart, 1.0))


TURNS = {
    (0, 0, 1): Turn.LEFT,
    (1, 1, 2): Turn.RIGHT,
    (1, 1, 3): Turn.STRAIGHT,
    (1, 1, 4): Turn.LEFT,
    (2, 0, 1): Turn.RIGHT,
}
LINKS, CROSSINGS = ("a", "b", "c", "d", "e"), ("x", "y")
Journey = tuple[float, tuple[int, ...], tuple[int, ...]]
"""When a car gets onto its first link, its links, and how long it is on each, seconds."""


def path(journey: Journey, n_frames: int) -> list[tuple[int, int]]:
    """Return link and crossing in each second; a crossing takes two seconds."""
    begin, links, stays = journey
    places = [(-1, -1)] * int(begin)
    for i, (link, stay) in enumerate(zip(links, stays, strict=True)):
        places += [(link, -1)] * stay
        if i + 1 < len(links):
            crossing = next((x for a, x, b in TURNS if (a, b) == (link, links[i + 1])), 0)
            places += [(-1, crossing)] * 2
    return [*places, *[(-1, -1)] * n_frames][:n_frames]


def followed(*journeys: Journey) -> list[TrueManoeuvre]:
    """Return who is followed."""
    watcher, found = FollowedWatcher(TurnWatcher(TURNS, LINKS, CROSSINGS)), []
    ids = np.arange(len(journeys))
    paths = [path(journey, 90) for journey in journeys]
    for time, at in enumerate(zip(*paths, strict=True)):
        link, crossing = np.array(at, dtype=np.int32).T
        frame = Frame(TimePoint(time * SECOND), Table("vehicle", ids, {}), Table("v", ids, {}))
        found += watcher.observe(frame, true_places(len(ids), link=link, crossing=crossing))
    return found + watcher.finish()


def test_who_turns_twice_alike_follows() -> None:
    """The one ahead and the one behind, from the first turn to the last."""
    (found,) = followed((0, (0, 1, 2), (5, 10, 20)), (4, (0, 1, 2), (5, 10, 20)))

    assert (found.kind, found.vehicles) == ("followed", (0, 1))
    assert (found.begin, found.end) == (5 * SECOND, 23 * SECOND)


def test_another_second_turn_is_no_following() -> None:
    """To turn elsewhere, or both to go straight on, does not count."""
    ahead = (0, (0, 1, 2), (5, 10, 20))
    straight = (0, (0, 1, 3), (5, 10, 20))

    assert followed(ahead, (4, (0, 1, 4), (5, 10, 20))) == []
    assert followed(straight, (4, (0, 1, 3), (5, 10, 20))) == []


def test_who_comes_long_after_does_not_follow() -> None:
    """Each turn must be at most fifteen seconds behind."""
    ahead = (0, (0, 1, 2), (5, 10, 20))

    assert len(followed(ahead, (15, (0, 1, 2), (5, 10, 20)))) == 1
    assert followed(ahead, (16, (0, 1, 2), (5, 10, 20))) == []
    assert followed(ahead, (4, (0, 1, 2), (5, 22, 20))) == []


def test_who_overtakes_on_the_way_does_not_follow() -> None:
    """The one behind must be behind both times."""
    assert followed((0, (0, 1, 2), (5, 20, 20)), (4, (0, 1, 2), (5, 10, 20))) == []


@st.composite
def journeys(draw: st.DrawFn) -> list[Journey]:
    """Return some journeys over links that follow one another."""
    found = []
    for _ in range(draw(st.integers(1, 5))):
        links = [draw(st.sampled_from([0, 1, 2]))]
        while (onward := [b for a, _, b in TURNS if a == links[-1]]) and len(links) < 5:
            links.append(draw(st.sampled_from(onward)))
        stays = tuple(draw(st.integers(1, 12)) for _ in links)
        found.append((float(draw(st.integers(0, 12))), tuple(links), stays))
    return found


def entries_of(journey: Journey) -> list[tuple[int, float]]:
    """Return each link of a journey and when the car gets onto it."""
    at, links, stays = journey
    found = []
    for link, stay in zip(links, stays, strict=True):
        found.append((link, at))
        at += stay + 2
    return found


def naively_followed(one: list[tuple[int, float]], other: list[tuple[int, float]]) -> bool:
    """Tell whether the second car is behind the first on the same three links, with two turns."""
    links = [link for link, _ in one]
    ways = [TURNS[a, x, b] for a, x, b in TURNS if (a, b) in pairwise(links)]
    lags = [b - a for (_, a), (_, b) in zip(one[1:], other[1:], strict=True)]
    return (
        links == [link for link, _ in other]
        and Turn.STRAIGHT not in ways
        and all(0 < lag <= 15 for lag in lags)
    )


@given(journeys())
@settings(derandomize=True, deadline=None, max_examples=200)
def test_following_agrees_with_comparing_all_pairs_of_turns(cars: list[Journey]) -> None:
    """Trying every two turns in a row of every two cars finds the same."""
    entries = [entries_of(car) for car in cars]
    doubles = [(i, m) for i, each in enumerate(entries) for m in range(len(each) - 2)]
    expected = [
        (i, j, entries[i][m + 1][1] - 2, entries[j][n + 2][1])
        for i, m in doubles
        for j, n in doubles
        if i != j and naively_followed(entries[i][m : m + 3], entries[j][n : n + 3])
    ]

    found = [(*each.vehicles, each.begin / SECOND, each.end / SECOND) for each in followed(*cars)]

    assert sorted(found) == sorted(each for each in expected if each[3] < 90)


def test_following_goes_through_crossings() -> None:
    """A car behind one in a crossing, or beyond it, follows it."""
    crossing = four_arm_crossing()
    road = next(
        r
        for r in range(len(crossing.roads))
        if crossing.link_of_road[r] >= 0 and crossing.successors(r)
    )
    inside = crossing.successors(road)[0]
    watcher, found = FollowingWatcher(crossing), []
    for t in range(6):
        frame = Frame(
            TimePoint(t * SECOND),
            Table("vehicle", [0, 1], {"speed": np.full(2, 10.0), "length": np.full(2, LENGTH)}),
            Table("vehicle", [0, 1], {}),
        )
        s = np.array([crossing.road_length[road] - 4.0, 4.0])
        places = true_places(2, road=np.array([road, inside]), s=s, d=np.zeros(2))
        found += watcher.observe(frame, places)

    assert [each.vehicles for each in watcher.finish()] == [(0, 1)]

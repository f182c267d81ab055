"""Who follows whom, against the definition read literally."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, Duration, TimePoint
from traffic.features.following import FOLLOWING, Following
from traffic.features.pairs import pair_id

NEAR, CLOSE, MOVING, FAST, OFFSET, CERTAINTY = 2.5, 0.7, 3.0, 8.0, 1.6, 1.0
SLACK, SURER = 1.25, 2.0


def unit() -> Following:
    """Return the unit with the bounds of the bundled specification."""
    return Following(
        near=Duration(int(NEAR * SECOND)),
        close=Duration(int(CLOSE * SECOND)),
        moving=MOVING,
        fast=FAST,
        offset=OFFSET,
        certainty=CERTAINTY,
    )


def headway(first: int = 1, second: int = 2, **values: float) -> dict[str, float]:
    """Return one pair; by default the first car is 2 s behind the second, at 12 m/s."""
    usual = {
        "first": first,
        "second": second,
        "ahead": 29.0,
        "time_gap": 2.0,
        "deviation": 0.0,
        "aside": 0.0,
        "aside_deviation": 0.0,
        "speed": 12.0,
        "speed_of_second": 12.0,
        "speed_deviation": 0.0,
    }
    return usual | values


def table_of(pairs: list[dict[str, float]]) -> Table:
    """Return a table of pairs."""
    names = headway()
    columns = {name: np.array([pair[name] for pair in pairs], dtype=float) for name in names}
    columns |= {name: columns[name].astype(np.int64) for name in ("first", "second")}
    ids = pair_id(columns["first"], columns["second"])
    return Table("headway", ids, columns)


def after(*frames: list[dict[str, float]]) -> dict[tuple[int, int], set[str]]:
    """Push frames one after the other; return what holds of each pair at the end."""
    following = unit()
    value = Table("following", [], {})
    for i, frame in enumerate(frames):
        (out,) = following.push(
            TimePoint(i), (Sample(table_of(frame), TimePoint(i), TimePoint(i)),)
        )
        value = out.value
    return {
        (int(first), int(second)): {name for name in FOLLOWING if value[name][row]}
        for row, (first, second) in enumerate(zip(value["first"], value["second"], strict=True))
    }


def test_a_car_follows_the_next_one_only():
    """Of two cars ahead on one way the nearer one is followed."""
    near, beyond = headway(1, 3, ahead=15.0, time_gap=0.9), headway(3, 2, ahead=14.0)

    assert after([headway(1, 2), near, beyond])[1, 2] == set()
    assert after([headway(1, 2), near, beyond])[1, 3] == {"follows"}


def test_a_car_on_another_way_is_not_between():
    """Where ways part, the nearest on each is the next; a detour is another way."""
    near, detour = headway(1, 3, ahead=15.0), headway(3, 2, ahead=20.0)

    assert after([headway(1, 2), near])[1, 2] == {"follows"}
    assert after([headway(1, 2), near, detour])[1, 2] == {"follows"}


def test_a_car_on_the_lane_beside_is_not_followed():
    """Who is aside by a lane is passed over, and the next one behind it is followed."""
    beside = headway(1, 2, aside=3.2, ahead=15.0)
    held = after([beside, headway(2, 3, aside=3.2, ahead=14.0), headway(1, 3)])

    assert held == {(1, 2): set(), (2, 3): set(), (1, 3): {"follows"}}


def test_who_drives_closely_and_fast_tailgates():
    """A short time gap is tailgating at speed and following else."""
    assert after([headway(time_gap=0.5)])[1, 2] == {"follows", "tailgates"}
    assert after([headway(time_gap=0.5, speed=7.0)])[1, 2] == {"follows"}


def test_what_is_true_stays_true_a_little_longer():
    """A time gap in between keeps what there was."""
    between = headway(time_gap=0.8)

    assert after([headway(time_gap=0.5)], [between])[1, 2] == {"follows", "tailgates"}
    assert after([between])[1, 2] == {"follows"}
    assert after([headway()], [headway(time_gap=3.2)])[1, 2] == set()


def test_an_uncertain_time_gap_changes_nothing():
    """A time gap must be on the other side by more than its deviation."""
    uncertain = headway(time_gap=0.65, deviation=0.1)

    assert after([uncertain])[1, 2] == {"follows"}
    assert after([headway(time_gap=0.5)], [headway(time_gap=0.95, deviation=0.1)])[1, 2] == {
        "follows",
        "tailgates",
    }


def test_tailgating_begins_when_it_is_surer():
    """What suffices to stay within a bound by one deviation does not make a car tailgate."""
    assert after([headway(time_gap=0.55, deviation=0.1)])[1, 2] == {"follows"}
    assert after([headway(time_gap=0.45, deviation=0.1)])[1, 2] == {"follows", "tailgates"}


def test_an_uncertain_speed_changes_nothing():
    """A speed must be on the other side of a bound by more than its deviation."""
    close = headway(time_gap=0.5)
    slower = headway(time_gap=0.5, speed=6.0, speed_deviation=1.0)

    assert after([headway(time_gap=0.5, speed=8.5, speed_deviation=1.0)])[1, 2] == {"follows"}
    assert after([close], [slower])[1, 2] == {"follows", "tailgates"}
    assert after([close], [slower | {"speed_deviation": 0.2}])[1, 2] == {"follows"}


def test_a_pair_that_was_gone_begins_anew():
    """What held before a pair was out of reach does not count any more."""
    assert after([headway(time_gap=0.5)], [], [headway(time_gap=0.8)])[1, 2] == {"follows"}


@st.composite
def frames_of_pairs(draw):
    """Return some frames of pairs among four cars."""
    pairs = [(i, j) for i in range(1, 5) for j in range(1, 5) if i != j]
    frames = []
    for _ in range(draw(st.integers(1, 5))):
        chosen = draw(st.lists(st.sampled_from(pairs), unique=True, max_size=8))
        frames.append(
            [
                headway(
                    i,
                    j,
                    ahead=draw(st.integers(1, 5)) * 8.0,
                    time_gap=draw(st.sampled_from([0.3, 0.55, 0.65, 0.75, 0.95, 2.4, 2.8, 3.3])),
                    deviation=draw(st.sampled_from([0.0, 0.1])),
                    aside=draw(st.sampled_from([0.0, 1.5, 1.8, 3.2])),
                    aside_deviation=draw(st.sampled_from([0.0, 0.3])),
                    speed=draw(st.sampled_from([2.0, 2.7, 5.0, 7.0, 12.0])),
                    speed_of_second=draw(st.sampled_from([2.0, 2.7, 12.0])),
                    speed_deviation=draw(st.sampled_from([0.0, 0.5, 5.0])),
                )
                for i, j in chosen
            ]
        )
    return frames


def someone_between(key, by_pair, now):
    """Tell whether there is a third car, in lane, on the way from the one to the other."""
    for third in range(1, 5):
        near, far = (key[0], third), (third, key[1])
        if all(pair in by_pair and "lane" in now[pair] for pair in (near, far)):
            detour = by_pair[near]["ahead"] + by_pair[far]["ahead"] - by_pair[key]["ahead"]
            if detour <= 1.0:
                return True
    return False


def naive(frames):
    """Return what holds at the end, pair by pair."""
    before: dict[tuple[int, int], set[str]] = {}
    for frame in frames:
        now: dict[tuple[int, int], set[str]] = {}
        by_pair = {(p["first"], p["second"]): p for p in frame}
        for key, p in by_pair.items():
            spread = p["aside_deviation"]
            stays = "lane" in before.get(key, ()) and p["aside"] - spread <= SLACK * OFFSET
            now[key] = {"lane"} if p["aside"] + spread <= OFFSET or stays else set()
        for key, p in by_pair.items():
            if "lane" not in now[key] or someone_between(key, by_pair, now):
                continue
            slower = min(p["speed"], p["speed_of_second"])
            for name, limit, surer, speed, spread, least in (
                ("follows", NEAR, 1.0, slower, 0.0, MOVING),
                ("tailgates", CLOSE, SURER, p["speed"], p["speed_deviation"], FAST),
            ):
                begins = p["time_gap"] + surer * p["deviation"] <= limit and speed - spread > least
                stays = (
                    name in before.get(key, ())
                    and p["time_gap"] - p["deviation"] <= SLACK * limit
                    and SLACK * (speed + spread) > least
                )
                if begins or stays:
                    now[key].add(name)
        before = now
    return {key: held - {"lane"} for key, held in before.items()}


@settings(derandomize=True, deadline=None, max_examples=200)
@given(frames_of_pairs())
def test_relations_agree_with_their_definition_pair_by_pair(frames):
    """The columns say what reading the definition for one pair after the other says."""
    assert after(*frames) == naive(frames)


def test_bounds_in_the_wrong_order_are_refused():
    """Tailgating must be closer than following."""
    with pytest.raises(ValueError, match="close <= near"):
        Following(
            near=Duration(SECOND),
            close=Duration(2 * SECOND),
            moving=3.0,
            fast=8.0,
            offset=1.6,
            certainty=1.0,
        )

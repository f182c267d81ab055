"""To which side cars swing, on hand-made paths and against the naive reading."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint
from traffic.features.swaying import SWINGS, Swaying

NONE, LEFT, RIGHT = "none", *SWINGS
LEAST, MOST, DRIFT, REST = 0.7, 2.6, 0.1, 6
STEP = 500 * MILLISECOND


def unit() -> Swaying:
    """Return a unit without uncertainty."""
    return Swaying(
        least=LEAST,
        most=MOST,
        rest=Duration(REST * SECOND),
        moving=3.0,
        drift=DRIFT,
        certainty=1.0,
    )


def swings(
    d: Sequence[float],
    *,
    speed: Sequence[float] | None = None,
    link: Sequence[int] | None = None,
    road: Sequence[int] | None = None,
    deviation: float = 0.0,
    observed: Sequence[bool] | None = None,
) -> list[str]:
    """Return the swing of one car at each of its places across the road, half a second apart."""
    n = len(d)
    cars, found = unit(), []
    for i in range(n):
        columns = {
            "d": np.array([d[i]]),
            "d_variance": np.array([deviation**2]),
            "speed": np.array([10.0 if speed is None else speed[i]]),
            "road": np.array([0 if road is None else road[i]], dtype=np.int32),
            "link_of_road": np.array([0 if link is None else link[i]], dtype=np.int32),
            "direction_in_link": np.array([1.0]),
            "observed": np.array([True if observed is None else observed[i]]),
        }
        sample = Sample(Table("car", [1], columns), TimePoint(i * STEP), TimePoint(i * STEP))
        (out,) = cars.push(sample.available_time, (sample,))
        code = int(out.value["swing"][0])
        found.append(NONE if code < 0 else SWINGS[code])
    return found


def test_a_car_that_sways_swings_left_and_right_in_turn() -> None:
    """Each swing is told when it is wide enough, and stands until the next one."""
    path = [0.0, 0.5, 1.0, 0.5, 0.0, -0.5, 0.0, 0.5]

    assert swings(path) == [NONE, NONE, LEFT, LEFT, RIGHT, RIGHT, RIGHT, LEFT]


def test_a_change_of_lanes_is_no_swing_in_the_end() -> None:
    """What goes on to one side for more than 2.6 m is forgotten."""
    assert swings([0.0, 0.8, 1.6, 2.4, 3.2, 3.2]) == [NONE, LEFT, LEFT, LEFT, NONE, NONE]


def test_a_car_that_keeps_straight_has_stopped_swinging() -> None:
    """After six seconds without a turn there is no swing."""
    assert swings([0.0, 1.0, *[1.0] * 14])[-3:] == [LEFT, NONE, NONE]


def test_slow_drift_is_no_swing() -> None:
    """A car that follows its lane within a metre in twenty seconds keeps straight."""
    assert set(swings(np.linspace(0.0, 1.5, 41).tolist())) == {NONE}


def test_uncertain_places_must_be_further_apart() -> None:
    """One standard deviation more is asked for."""
    assert swings([0.0, 0.8], deviation=0.2) == [NONE, NONE]
    assert swings([0.0, 1.0], deviation=0.2) == [NONE, LEFT]


@pytest.mark.parametrize(
    ("what", "values"),
    [("speed", [10, 10, 2, 10]), ("link", [0, 0, -1, 0]), ("link", [0, 0, 1, 1])],
)
def test_standing_crossings_and_other_links_end_a_swing(what: str, values: list[int]) -> None:
    """Swings belong to one journey along one link."""
    assert swings([0.0, 1.0, 1.0, 1.0], **{what: values}) == [NONE, LEFT, NONE, NONE]  # type: ignore[arg-type]


def test_the_middle_line_of_the_next_road_makes_no_swing() -> None:
    """Where a road ends and a wider one begins, places across them are joined."""
    path, road = [0.0, 0.0, 1.6, 1.6, 1.0, 0.8], [0, 0, 1, 1, 1, 1]

    assert swings(path, road=road) == [NONE, NONE, NONE, NONE, NONE, RIGHT]


def test_a_car_out_of_sight_keeps_its_swing() -> None:
    """Nothing is concluded from where it is expected to be."""
    assert swings([0.0, 1.0, 0.0, 1.0], observed=[True, True, False, True]) == [
        NONE, LEFT, LEFT, LEFT,
    ]  # fmt: skip


def naive(path: Sequence[float]) -> list[str]:
    """Return the swings of one car by looking back at all of its path each time."""
    found, start, side, turned = [], 0, NONE, 0
    seconds = STEP / SECOND
    for i, across in enumerate(path):
        if side != NONE and (i - turned) * seconds > REST:
            side, start = NONE, i
        faded = [DRIFT * seconds * (i - j) for j in range(start, i + 1)]
        begun = path[start : i + 1]
        low = min(place + lost for place, lost in zip(begun, faded, strict=True))
        high = max(place - lost for place, lost in zip(begun, faded, strict=True))
        if side != LEFT and across - min(low, across) >= LEAST:
            side, start, turned = LEFT, i, i
        elif side != RIGHT and max(high, across) - across >= LEAST:
            side, start, turned = RIGHT, i, i
        found.append(side)
    return found


@settings(derandomize=True, deadline=None, max_examples=300)
@given(path=st.lists(st.integers(-4, 4).map(lambda x: x * 0.3 + 0.001), min_size=1, max_size=30))
def test_swings_are_those_of_the_naive_reading(path: list[float]) -> None:
    """Turns are found as by looking back at the path since the last one."""
    # paths stay narrower than a change of lanes, so that nothing is forgotten
    assert swings(path) == naive(path)


@settings(derandomize=True, deadline=None, max_examples=50)
@given(
    paths=st.lists(st.lists(st.floats(-3, 3), min_size=12, max_size=12), min_size=1, max_size=5),
    seed=st.integers(0, 1000),
)
def test_cars_do_not_depend_on_each_other(paths: list[list[float]], seed: int) -> None:
    """Many cars at once, which come and go in any order, swing as each does alone."""
    generator = np.random.default_rng(seed)
    begins = generator.integers(0, 6, len(paths))
    cars, found = unit(), [[] for _ in paths]  # type: list[list[str]]
    for i in range(12):
        here = generator.permutation([k for k in range(len(paths)) if begins[k] <= i])
        n = len(here)
        columns = {
            "d": np.array([paths[k][i] for k in here]),
            "d_variance": np.zeros(n),
            "speed": np.full(n, 10.0),
            "road": np.zeros(n, dtype=np.int32),
            "link_of_road": np.zeros(n, dtype=np.int32),
            "direction_in_link": np.ones(n),
            "observed": np.ones(n, dtype=bool),
        }
        at = TimePoint(i * STEP)
        (out,) = cars.push(at, (Sample(Table("car", here, columns), at, at),))
        for k, code in zip(here.tolist(), out.value["swing"].tolist(), strict=True):
            found[k].append(NONE if code < 0 else SWINGS[code])

    for k, path in enumerate(paths):
        assert found[k] == swings(path[begins[k] :])

"""Who faces oncoming traffic."""

from types import SimpleNamespace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint
from traffic.features.oncoming import FacingTraffic

Car = tuple[int, int, float, float]
"""Direction in the link, link, place along it, metres to the left of the middle of the road."""

CARS = st.lists(
    st.tuples(
        st.sampled_from([-1, 1]),
        st.integers(-1, 1),
        st.integers(-150, 150).map(float),
        st.sampled_from([-5.0, 0.0, 5.0]),
    ),
    max_size=8,
)


def facing(cars: list[Car], *, left_hand: bool = False, deviation: float = 0.0) -> set:
    """Return who faces whom on roads of 7 m, among cars of 4 m at 10 m/s; by their numbers."""
    direction, link, place, left = np.array(cars, dtype=np.float64).reshape(-1, 4).T
    n = len(cars)
    table = Table(
        "car",
        np.arange(n),
        {
            "observed_at": np.zeros(n, dtype=np.int64),
            "direction_in_link": direction,
            "link_of_road": link.astype(np.int32),
            "road": np.zeros(n, dtype=np.int32),
            "position_along_link": place,
            "d": left,
            "length": np.full(n, 4.0),
            "speed": np.full(n, 10.0),
            "s_variance": np.full(n, deviation**2),
            "d_variance": np.full(n, deviation**2),
        },
    )
    unit = FacingTraffic(
        SimpleNamespace(road_width=[7.0], left_hand=left_hand),
        reach=200.0,
        horizon=Duration(4 * SECOND),
        active_for=Duration(400 * MILLISECOND),
        certainty=1.0,
        within=Duration(0),
    )
    (out,) = unit.push(TimePoint(0), (Sample(table, TimePoint(0), TimePoint(0)),))
    pairs = out.value
    return {
        (int(first), int(second))
        for first, second, truth in zip(
            pairs["first"], pairs["second"], pairs["facing"], strict=True
        )
        if truth == 1
    }


def test_who_is_on_the_other_side_faces_who_comes_soon():
    """Sixty metres at ten metres a second each are three seconds."""
    assert facing([(1, 0, 0.0, 5.0), (-1, 0, 60.0, 0.0)]) == {(0, 1)}


def test_look_alikes_face_nobody():
    """On the own side, far enough away, driving the same way, passed already, on another link."""
    other = (-1, 0, 60.0, 0.0)
    assert facing([(1, 0, 0.0, 0.0), other]) == set()
    assert facing([(1, 0, 0.0, 5.0), (-1, 0, 95.0, 0.0)]) == set()
    assert facing([(1, 0, 0.0, 5.0), (1, 0, 60.0, 0.0)]) == set()
    assert facing([(1, 0, 70.0, 5.0), other]) == set()
    assert facing([(1, 1, 0.0, 5.0), other]) == set()


def test_where_one_drives_on_the_left_the_other_side_is_the_right_one():
    """The side on which others come is beyond the middle of the link."""
    other = (-1, 0, 60.0, 0.0)
    assert facing([(1, 0, 0.0, -5.0), other], left_hand=True) == {(0, 1)}
    assert facing([(1, 0, 0.0, 5.0), other], left_hand=True) == set()


def test_uncertain_places_face_nobody():
    """A car that may as well be on its own side is not believed to be on the other."""
    assert facing([(1, 0, 0.0, 5.0), (-1, 0, 60.0, 0.0)], deviation=3.0) == set()


@settings(derandomize=True, deadline=None, max_examples=200)
@given(CARS)
def test_pairs_are_those_that_trying_all_finds(cars):
    """Each car on the other side, with each that would touch it in time, clearly before 4 s."""
    expected = {
        (i, j)
        for i, (way, link, place, left) in enumerate(cars)
        for j, (other_way, other_link, other_place, _) in enumerate(cars)
        if left == 5.0
        and link == other_link >= 0
        and way == -other_way
        and 0 < way * (other_place - place) <= 4 + 20 * 3.9
    }

    assert facing(cars) == expected

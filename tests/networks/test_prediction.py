"""Where bodies will be along their roads, and when two of them would touch."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.building import four_arm_crossing, straight_road
from networks.prediction import Bodies, first_touch
from networks.roads import RoadMap

STRAIGHT = straight_road(400.0, lanes=1)
CROSSING = four_arm_crossing()
TIMES = np.arange(0.0, 2.05, 0.1)


def bodies(road: list[int], s: list[float], speed: list[float], d: float = 0.0) -> Bodies:
    """Return cars of 4 m by 2 m."""
    n = len(road)
    return Bodies(
        np.array(road, dtype=np.int32), np.array(s), np.full(n, d), np.array(speed),
        np.full(n, 4.0), np.full(n, 2.0),
    )  # fmt: skip


def touch(road_map: RoadMap, cars: Bodies) -> float:
    """Return when the first two would touch."""
    (found,) = first_touch(road_map, cars, (np.array([0]), np.array([1])), TIMES)
    return float(found)


def test_a_follower_touches_when_the_gap_is_used_up() -> None:
    """11 m between bumpers, closing at 10 m/s: in 1.1 s."""
    assert touch(STRAIGHT, bodies([0, 0], [50.0, 65.0], [15.0, 5.0])) == pytest.approx(1.1)


def test_who_is_as_fast_never_touches() -> None:
    """Nor does one who falls back."""
    assert touch(STRAIGHT, bodies([0, 0], [50.0, 56.0], [10.0, 10.0])) == np.inf
    assert touch(STRAIGHT, bodies([0, 0], [50.0, 56.0], [5.0, 10.0])) == np.inf


def test_cars_that_meet_on_their_own_sides_do_not_touch() -> None:
    """The middle of each road is that of its own lane."""
    east = 0
    west = next(i for i in range(1, len(STRAIGHT.roads)) if STRAIGHT.direction_in_link[i] < 0)

    assert touch(STRAIGHT, bodies([east, west], [200.0, 185.0], [15.0, 15.0])) == np.inf


def test_no_pairs_need_no_answer() -> None:
    """Nothing in, nothing out."""
    none = np.empty(0, dtype=np.intp)

    assert len(first_touch(STRAIGHT, bodies([0], [1.0], [1.0]), (none, none), TIMES)) == 0


def outline(road_map: RoadMap, cars: Bodies, row: int, time: float) -> shapely.Polygon:
    """Return the rectangle of one car after *time* seconds."""
    position, heading = cars.at(road_map, time)
    angle, (x, y) = heading[row], position[row]
    box = shapely.box(-cars.length[row] / 2, -cars.width[row] / 2, cars.length[row] / 2,
                      cars.width[row] / 2)  # fmt: skip
    turned = shapely.affinity.rotate(box, angle, origin=(0, 0), use_radians=True)
    return shapely.affinity.translate(turned, x, y)


@settings(derandomize=True, deadline=None, max_examples=120)
@given(seed=st.integers(0, 10_000), on_crossing=st.booleans())
def test_touching_agrees_with_the_shapes(seed: int, on_crossing: bool) -> None:
    """The first moment at which the two rectangles meet, as geometry tells it."""
    road_map = CROSSING if on_crossing else STRAIGHT
    generator = np.random.default_rng(seed)
    n = 4
    road = generator.integers(0, len(road_map.roads), n)
    s = road_map.road_length[road] * generator.uniform(0.3, 1.0, n)
    cars = Bodies(
        road.astype(np.int32), s, generator.uniform(-2, 2, n), generator.uniform(0, 20, n),
        generator.uniform(2, 8, n), generator.uniform(1, 3, n),
    )  # fmt: skip
    first, second = np.triu_indices(n, k=1)

    found = first_touch(road_map, cars, (first, second), TIMES)

    for i, j, when in zip(first, second, found, strict=True):
        gaps = [
            outline(road_map, cars, i, t).distance(outline(road_map, cars, j, t)) for t in TIMES
        ]
        touching = [t for t, gap in zip(TIMES, gaps, strict=True) if gap <= 1e-9]
        assert when == (touching[0] if touching else np.inf)

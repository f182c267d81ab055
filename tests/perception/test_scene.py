"""The ground and what stands on it."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.scene import Ground, build_surroundings, polygons_of
from tests.perception.scenes import CAR, road, vehicles


def test_nothing_is_built_on_the_road():
    """Every house and every tree keeps off the carriageway."""
    ground = road()

    surroundings = build_surroundings(ground, np.random.default_rng(0))

    (carriageway,) = polygons_of(ground.paved)
    houses = surroundings.buildings
    reach = 0.5 * np.hypot(houses[:, 3], houses[:, 4])
    gaps = shapely.distance(shapely.points(houses[:, :2]), carriageway) - reach
    assert len(houses) > 5
    assert (gaps > 5.0).all()
    trees = surroundings.trees
    assert (shapely.distance(shapely.points(trees[:, :2]), carriageway) > trees[:, 2]).all()


def test_the_same_seed_builds_the_same_houses():
    """Surroundings are reproducible."""
    first, second = (build_surroundings(road(), np.random.default_rng(3)) for _ in range(2))

    np.testing.assert_array_equal(first.buildings, second.buildings)
    np.testing.assert_array_equal(first.trees, second.trees)


def test_a_map_without_roads_has_empty_surroundings():
    """Without outlines there is nothing to build along."""
    surroundings = build_surroundings(Ground(()), np.random.default_rng(0))

    assert len(surroundings.buildings) == len(surroundings.trees) == 0


def test_choosing_vehicles_keeps_the_columns_together():
    """A mask chooses the same rows of every column."""
    several = vehicles([(i, float(i), 0.0, 0.0, CAR) for i in range(4)])

    chosen = several.select(np.array([False, True, False, True]))

    np.testing.assert_array_equal(chosen.ids, [1, 3])
    np.testing.assert_array_equal(chosen.position[:, 0], [1.0, 3.0])
    assert len(chosen) == 2


def test_outlines_of_too_few_corners_are_no_polygons():
    """A line in place of an outline is left out."""
    assert len(polygons_of([np.zeros((2, 2)), np.eye(3)[:, :2]])) == 1


ROAD = np.array([[-100.0, -4.0], [100.0, -4.0], [100.0, 4.0], [-100.0, 4.0]])


def rectangle(x: float, y: float, angle: float, length: float, width: float) -> np.ndarray:
    """Return the corners of a rectangle."""
    half = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * [length / 2, width / 2]
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return half @ turn + [x, y]


@settings(derandomize=True, deadline=None, max_examples=40)
@given(
    x=st.floats(-80, 80), y=st.floats(20, 60), angle=st.floats(0, 3.1), length=st.floats(8, 30),
    share=st.floats(0.3, 0.9),
)  # fmt: skip
def test_a_known_house_is_a_box_around_its_outline(
    x: float, y: float, angle: float, length: float, share: float
) -> None:
    """Of the same place, size and direction."""
    outline = rectangle(x, y, angle, length, share * length)

    found = build_surroundings(Ground((ROAD,), buildings=(outline,)), np.random.default_rng(1))

    assert len(found.buildings) == len(found.building_colours) == 1
    box = found.buildings[0]
    np.testing.assert_allclose(box[:2], [x, y], atol=1e-6)
    np.testing.assert_allclose(sorted(box[3:5]), [share * length, length], rtol=1e-6)
    corners = rectangle(*box[:5])
    gaps = np.linalg.norm(corners[:, None] - outline[None], axis=2).min(axis=1)
    assert gaps.max() == pytest.approx(0.0, abs=1e-6)
    distance = np.linalg.norm(found.trees[:, :2] - box[:2], axis=1)
    assert (distance > np.hypot(*box[3:5]) / 2).all()


def test_where_no_house_is_known_some_are_made_up() -> None:
    """A road through nothing looks wrong."""
    assert len(build_surroundings(Ground((ROAD,)), np.random.default_rng(1)).buildings) > 1

"""The ground and what stands on it."""

import numpy as np
import shapely

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

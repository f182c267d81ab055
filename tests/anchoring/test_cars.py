"""Cars know where on the map they are."""

import numpy as np

from anchoring.cars import Car
from dyknow.streams.table import Table
from dyknow.time import milliseconds, seconds
from networks.building import four_arm_crossing


def _on_road(roads, names, s):
    """Return on-road objects at *s* of roads, on their centre lines, at 10 m/s."""
    road = np.array([roads.roads.index(name) for name in names], dtype=np.int32)
    s = np.asarray(s, dtype=float)
    heading = roads.heading_at(road, s)
    return Table(
        "on_road_object",
        np.arange(len(names)) + 5,
        {
            "position": roads.point_at(road, s),
            "velocity": 10 * np.stack((np.cos(heading), np.sin(heading)), axis=1),
            "speed": np.full(len(names), 10.0),
            "road": road,
            "s": s,
            "d": np.zeros(len(names)),
            "observed": np.ones(len(names), dtype=bool),
        },
    )


def test_cars_are_on_a_link_or_in_a_crossing():
    """On a link there is a lane and no crossing, in a crossing neither link nor lane."""
    roads = four_arm_crossing(100.0)
    lower = _on_road(roads, ["west_centre", "centre_east"], [50.0, 60.0])
    inside = lower.with_columns(position=np.zeros((2, 2)))

    on_link = Car(roads).create(np.array([1, 2]), lower, 0)
    in_crossing = Car(roads).create(np.array([1, 2]), inside, 0)

    assert on_link.sort == "car"
    assert (on_link["lane"] >= 0).all()
    assert (on_link["crossing"] == -1).all()
    np.testing.assert_array_equal(on_link["link"], roads.link_of_road[lower["road"]])
    assert (in_crossing["crossing"] == 0).all()
    assert (in_crossing["link"] == -1).all()


def test_positions_along_a_link_grow_in_one_direction_only():
    """Both carriageways of a link share one position; the direction says which is driven."""
    roads = four_arm_crossing(100.0)
    unit, ids = Car(roads), np.array([1, 2])
    lower = _on_road(roads, ["west_centre", "centre_west"], [20.0, 30.0])
    ahead = _on_road(roads, ["west_centre", "centre_west"], [25.0, 35.0])

    cars = unit.create(ids, lower, 0)
    later = unit.update(cars, ahead, milliseconds(500))

    moved = later["position_along_link"] - cars["position_along_link"]
    np.testing.assert_allclose(moved, 5.0 * cars["direction_in_link"])
    assert set(cars["direction_in_link"]) == {1.0, -1.0}
    np.testing.assert_array_equal(later.ids, ids)


def test_cars_without_an_on_road_object_go_straight_on():
    """A predicted car keeps its velocity and is not observed."""
    roads = four_arm_crossing(100.0)
    unit = Car(roads)
    cars = unit.create(np.array([1]), _on_road(roads, ["west_centre"], [20.0]), 0)

    predicted = unit.predict(unit.predict(cars, seconds(1)), seconds(3))

    np.testing.assert_allclose(predicted["position"] - cars["position"], [[30.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(predicted["s"], [50.0])
    assert not predicted["observed"].any()

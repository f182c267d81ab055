"""Made-up networks."""

import pytest

from networks.building import bend, four_arm_crossing, ring, straight_road


def test_a_straight_road_is_one_link():
    """Two directed roads make one link between two dead ends."""
    road_map = straight_road(150.0)

    assert road_map.roads == ("west_east", "east_west")
    assert road_map.links == ("west-east",)
    assert road_map.crossings == ()
    assert road_map.road_length == pytest.approx([150.0, 150.0])


def test_one_may_overtake_on_the_straight_road():
    """The innermost lanes of the two directions are opposite to each other."""
    lanes = straight_road(lanes=2).lane_columns

    assert [lanes.names[o] if o >= 0 else "" for o in lanes.opposite] == [
        "",
        "east_west_1",
        "",
        "west_east_1",
    ]


def test_a_crossing_has_four_links():
    """Four arms are four links between the crossing and its dead ends."""
    road_map = four_arm_crossing()

    assert road_map.crossings == ("centre",)
    assert len(road_map.links) == 4
    assert len(road_map.roads) == 8 + 12


def test_a_bend_keeps_the_side_of_the_road():
    """On the left bend the inner direction is shorter than the outer one."""
    onward, back = bend().road_length

    assert onward > back


def test_a_ring_has_no_end():
    """Every road of the ring has a successor."""
    road_map = ring()

    assert len(road_map.links) == 1
    assert all(road_map.successors(road) for road in range(len(road_map.roads)))

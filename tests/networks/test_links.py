"""Positions along links."""

import numpy as np
import pytest

from networks.assembling import road_map_from_parts
from networks.building import Road, network_parts, ring


def test_the_dead_end_is_not_measured_twice():
    """Where one can turn at a dead end, both directions still have one measure."""
    places = {"west": (0.0, 0.0), "east": (100.0, 0.0)}
    road_map = road_map_from_parts(network_parts(places, [Road("west", "east")], u_turns=True))
    roads = np.array([road_map.roads.index(name) for name in ("west_east", "east_west")])

    assert road_map.positions.length == pytest.approx([100.0])
    assert sorted(road_map.direction_in_link[roads]) == [-1.0, 1.0]
    assert sorted(road_map.offset_in_link[roads]) == pytest.approx([0.0, 100.0])


def test_a_link_of_several_edges_is_measured_through():
    """Positions go on from edge to edge through an edge split, in both directions alike."""
    places = {"west": (0.0, 0.0), "middle": (80.0, 0.0), "east": (200.0, 0.0)}
    road_map = road_map_from_parts(
        network_parts(places, [Road("west", "middle"), Road("middle", "east")])
    )
    x = np.linspace(1.0, 199.0, 25)
    positions = []
    for y, velocity in ((-1.6, 10.0), (1.6, -10.0)):
        points = np.column_stack([x, np.full_like(x, y)])
        road = road_map.match(points, np.tile([velocity, 0.0], (25, 1)), 5.0)
        s, _ = road_map.project(points, road)
        positions.append(road_map.position_along_link(road, s))

    assert positions[0] == pytest.approx(positions[1], abs=0.01)
    assert np.abs(np.diff(positions[0])) == pytest.approx(np.full(24, 198.0 / 24), abs=0.01)


def test_round_a_ring_both_directions_agree():
    """On a ring positions of both directions differ by less than the width of the road."""
    road_map = ring()
    s = np.full(len(road_map.roads), 1.0)
    roads = np.arange(len(road_map.roads))
    reference = road_map.positions.length[0]

    along, _ = road_map.project(road_map.point_at(roads, s), roads)
    position = road_map.position_along_link(roads, along)

    assert np.all(position > -reference / 8)
    assert np.all(position < reference * 9 / 8)

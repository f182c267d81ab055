"""Crossings and links."""

import numpy as np

from networks.building import Road, network_parts
from networks.parts import Edge, Junction, Lane, NetworkParts
from networks.topology import topology_of

STAR = {
    "centre": (0.0, 0.0),
    "east": (200.0, 0.0),
    "north": (0.0, 200.0),
    "west": (-200.0, 0.0),
}

TWIN = [
    Road("centre", "north"),
    Road("centre", "west"),
    Road("centre", "twin"),
    Road("twin", "east"),
    Road("twin", "south"),
]
"""The roads of two crossings, one beside the other."""


def names(crossings):
    """Return the junctions of each crossing."""
    return [set(members) for members in crossings]


def test_three_roads_make_a_crossing():
    """Where three roads meet is a crossing, their ends are none, and each road is a link."""
    roads = [Road("centre", "east"), Road("centre", "north"), Road("centre", "west")]

    found = topology_of(network_parts(STAR, roads))

    assert found.crossings == (("centre",),)
    assert sorted(map(sorted, found.links)) == [
        ["centre_east", "east_centre"],
        ["centre_north", "north_centre"],
        ["centre_west", "west_centre"],
    ]


def test_an_edge_split_is_no_crossing():
    """A junction of two roads divides no link."""
    roads = [Road("west", "centre"), Road("centre", "east")]

    found = topology_of(network_parts(STAR, roads))

    assert found.crossings == ()
    assert len(found.links) == 1
    assert len(found.links[0]) == 4


def test_crossings_close_together_are_one():
    """Two crossings with a link under 30 m between them become one and swallow the link."""
    places = STAR | {"twin": (29.0 + 2 * 7.2, 0.0), "south": (43.0, -200.0)}

    found = topology_of(network_parts(places, TWIN))

    assert names(found.crossings) == [{"centre", "twin"}]
    assert len(found.links) == 4
    assert found.crossing_of_edge == {"centre_twin": 0, "twin_centre": 0}


def test_crossings_farther_apart_stay_two():
    """A link of 31 m keeps two crossings apart."""
    places = STAR | {"twin": (31.0 + 2 * 7.2, 0.0), "south": (45.0, -200.0)}

    found = topology_of(network_parts(places, TWIN))

    assert names(found.crossings) == [{"centre"}, {"twin"}]
    assert found.crossing_of_edge == {}


def test_a_short_dead_end_is_still_a_link():
    """A stub of 12 m that leads nowhere makes a crossing and is not swallowed by it."""
    places = STAR | {"yard": (0.0, -20.0)}
    roads = [Road("centre", "east"), Road("centre", "west"), Road("centre", "yard")]

    found = topology_of(network_parts(places, roads))

    assert names(found.crossings) == [{"centre"}]
    assert len(found.links) == 3


def test_two_carriageways_are_one_link():
    """One-way roads side by side, opposite ways between the same crossings, are one link."""
    places = {
        "a": (0.0, 0.0),
        "b": (300.0, 0.0),
        "c": (0.0, 18.0),
        "d": (300.0, 18.0),
        "a_south": (0.0, -200.0),
        "b_south": (300.0, -200.0),
        "c_north": (0.0, 200.0),
        "d_north": (300.0, 200.0),
    }
    roads = [
        Road("a", "b", one_way=True),
        Road("d", "c", one_way=True),
        Road("a", "c"),
        Road("b", "d"),
        Road("a", "a_south"),
        Road("b", "b_south"),
        Road("c", "c_north"),
        Road("d", "d_north"),
    ]

    found = topology_of(network_parts(places, roads))

    assert names(found.crossings) == [{"a", "c"}, {"b", "d"}]
    assert ("a_b", "d_c") in found.links


def test_where_a_median_begins_is_no_crossing():
    """A road that divides into its two carriageways goes on as the same link."""
    places = {"start": (0.0, 0.0), "fork": (100.0, 0.0), "up": (200.0, 9.0), "down": (200.0, -9.0)}
    roads = [
        Road("start", "fork"),
        Road("fork", "down", one_way=True),
        Road("up", "fork", one_way=True),
    ]

    found = topology_of(network_parts(places, roads))

    assert found.crossings == ()
    assert len(found.links) == 1


def test_a_fork_of_two_ways_out_is_a_crossing():
    """A road that divides into two that lead away is a crossing, however slowly they part."""
    places = {"start": (0.0, 0.0), "fork": (100.0, 0.0), "up": (300.0, 60.0), "down": (300.0, 0.0)}
    roads = [Road("start", "fork"), Road("fork", "down", one_way=True), Road("fork", "up")]

    found = topology_of(network_parts(places, roads))

    assert names(found.crossings) == [{"fork"}]
    assert len(found.links) == 3


def test_both_sides_of_a_block_are_links():
    """Roads between the same two junctions that lie apart are two roads."""
    places = {"gate": (-100.0, 0.0), "south": (0.0, 0.0), "north": (0.0, 160.0)}
    roads = [
        Road("gate", "south"),
        Road("south", "north", corners=((-70.0, 80.0),), one_way=True),
        Road("north", "south", corners=((70.0, 80.0),), one_way=True),
    ]

    found = topology_of(network_parts(places, roads))

    assert names(found.crossings) == [{"south"}]
    assert sorted(map(sorted, found.links)) == [
        ["gate_south", "south_gate"],
        ["north_south", "south_north"],
    ]


def test_the_largest_junction_names_its_crossing():
    """The junctions of a crossing stand in the order of their areas."""
    places = STAR | {"twin": (40.0, 0.0), "south": (40.0, -200.0)}
    roads = [
        Road("centre", "north"),
        Road("centre", "west"),
        Road("centre", "twin"),
        Road("twin", "east", lanes=1),
        Road("twin", "south", lanes=3),
    ]

    found = topology_of(network_parts(places, roads))

    assert found.crossings == (("twin", "centre"),)


def test_a_small_loop_belongs_to_its_crossing():
    """A loop shorter than 30 m that returns to its crossing is part of it."""
    parts = network_parts(
        STAR, [Road("centre", "east"), Road("centre", "north"), Road("centre", "west")]
    )
    circle = np.array([[7.0, -7.0], [12.0, -7.0], [12.0, -12.0], [7.0, -12.0], [7.0, -8.0]])
    loop = Edge("loop", "centre", "centre", (Lane("loop_0", circle),))

    found = topology_of(
        NetworkParts(parts.junctions, {**parts.edges, "loop": loop}, parts.connections)
    )

    assert found.crossing_of_edge == {"loop": 0}
    assert len(found.links) == 3


def test_a_ring_without_end_is_one_link():
    """A road that leads back to its beginning and meets no other has no crossing."""
    line = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [0.0, 1.0]])
    ring = Edge("ring", "a", "a", (Lane("ring_0", line),))
    junction = Junction("a", line[0], np.empty((0, 2)))

    found = topology_of(NetworkParts({"a": junction}, {"ring": ring}, ()))

    assert found.crossings == ()
    assert found.links == (("ring",),)

"""Left, right, straight on, back."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.assembling import road_map_from_parts
from networks.building import Road, four_arm_crossing, network_parts
from networks.turns import Turn

ARMS = ("east", "north", "west", "south")


def turn_between(road_map, start, end):
    """Return the turn from one arm of a crossing to another."""
    link = {name: road_map.link_of_edge[f"{name}_centre"] for name in ARMS}
    crossing = road_map.crossing_index("centre")
    return road_map.turns.get((link[start], crossing, link[end]))


@pytest.mark.parametrize("left_hand", [False, True])
@pytest.mark.parametrize("lanes", [1, 3])
def test_the_four_arms_of_a_crossing(lanes, left_hand):
    """From each arm the next ones counter-clockwise are right, straight, left, and itself back."""
    road_map = four_arm_crossing(lanes=lanes, u_turns=True, left_hand=left_hand)

    for i, start in enumerate(ARMS):
        turns = [turn_between(road_map, start, ARMS[(i + k) % 4]) for k in range(4)]

        assert turns == [Turn.UTURN, Turn.RIGHT, Turn.STRAIGHT, Turn.LEFT]


def test_only_permitted_ways_are_turns():
    """Without connections that lead back there is no U-turn."""
    road_map = four_arm_crossing()

    assert turn_between(road_map, "east", "east") is None
    assert len(road_map.turns) == 12


def test_turns_have_names():
    """The turns can be read by the names of links and crossing."""
    road_map = four_arm_crossing()

    names = {(road_map.links[a], road_map.crossings[x]) for a, x, _ in road_map.turns}

    assert {(a, x) for a, x, _ in road_map.turn_names} == names
    assert set(road_map.turn_names.values()) == {Turn.LEFT, Turn.RIGHT, Turn.STRAIGHT}


@settings(derandomize=True, deadline=None, max_examples=25)
@given(st.integers(-140, 140).filter(lambda a: abs(abs(a) - 45) > 3 and abs(a) > 12))
def test_the_angle_decides(degrees):
    """Up to 45° to either side is straight on, more to the left is left, to the right right."""
    angle = math.radians(degrees)
    away = -90.0 if degrees > 0 else 90.0
    places = {
        "start": (-150.0, 0.0),
        "centre": (0.0, 0.0),
        "end": (150.0 * math.cos(angle), 150.0 * math.sin(angle)),
        "other": (0.0, 150.0 * math.sin(math.radians(away))),
    }
    roads = [Road(name, "centre") for name in ("start", "end", "other")]
    road_map = road_map_from_parts(network_parts(places, roads))

    turn = road_map.turns[
        road_map.link_of_edge["start_centre"], 0, road_map.link_of_edge["centre_end"]
    ]

    if abs(degrees) <= 45:
        assert turn is Turn.STRAIGHT
    else:
        assert turn is (Turn.LEFT if degrees > 0 else Turn.RIGHT)


def test_turns_lead_across_clusters():
    """A way through two junctions of one crossing is judged from where it enters to its exit."""
    places = {
        "one": (0.0, 0.0),
        "two": (35.0, 0.0),
        "west": (-200.0, 0.0),
        "east": (235.0, 0.0),
        "north": (0.0, 200.0),
        "south": (35.0, -200.0),
    }
    roads = [
        Road("one", "two"),
        Road("one", "west"),
        Road("two", "east"),
        Road("one", "north"),
        Road("two", "south"),
    ]
    road_map = road_map_from_parts(network_parts(places, roads))
    link = {
        name: road_map.link_of_edge[edge]
        for name, edge in {
            "west": "one_west",
            "east": "two_east",
            "north": "one_north",
            "south": "two_south",
        }.items()
    }

    assert len(road_map.crossings) == 1
    assert road_map.turns[link["west"], 0, link["east"]] is Turn.STRAIGHT
    assert road_map.turns[link["west"], 0, link["south"]] is Turn.RIGHT
    assert road_map.turns[link["north"], 0, link["south"]] is Turn.STRAIGHT
    assert road_map.turns[link["east"], 0, link["north"]] is Turn.RIGHT


def test_a_block_that_returns_is_no_u_turn():
    """Leaving a loop at the crossing where it began is judged by its angle."""
    places = {
        "gate": (-100.0, 0.0),
        "centre": (0.0, 0.0),
        "corner": (100.0, 0.0),
        "top": (100.0, 100.0),
        "back": (0.0, 100.0),
    }
    roads = [
        Road("gate", "centre"),
        Road("centre", "corner", one_way=True),
        Road("corner", "top", one_way=True),
        Road("top", "back", one_way=True),
        Road("back", "centre", one_way=True),
    ]
    road_map = road_map_from_parts(network_parts(places, roads))
    loop = road_map.link_of_edge["centre_corner"]

    assert loop == road_map.link_of_edge["back_centre"]
    assert road_map.turns[loop, 0, loop] is Turn.LEFT

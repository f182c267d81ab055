"""The road map: its questions, each against the definition."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.building import bend, four_arm_crossing, ring, straight_road
from networks.errors import UnknownPlaceError

CROSSING = four_arm_crossing(lanes=2, u_turns=True)
STRAIGHT = straight_road(200.0, lanes=2)
MAPS = (CROSSING, STRAIGHT, bend(), four_arm_crossing(left_hand=True))

seeds = st.integers(0, 2**32 - 1)


def points_on(road_map, seed, *, count=40, spread=4.0):
    """Return roads, positions along them, and points scattered about these."""
    generator = np.random.Generator(np.random.PCG64(seed))
    road = generator.integers(0, len(road_map.roads), count)
    s = generator.uniform(0.0, 1.0, count) * road_map.road_length[road]
    return road, s, road_map.point_at(road, s, generator.normal(0.0, spread, count))


def road_called(road_map, name):
    """Return the index of a road, as an array of one."""
    return np.array([road_map.roads.index(name)])


@settings(derandomize=True, deadline=None, max_examples=25)
@given(st.sampled_from(MAPS), seeds)
def test_location_agrees_with_asking_every_area(road_map, seed):
    """A point is in the first crossing that covers it, else in the nearest lane."""
    points = points_on(road_map, seed)[2]
    areas = road_map.areas

    places = road_map.locate(points)

    for i, point in enumerate(points):
        covering = [a for a, s in enumerate(areas.shapes) if s.intersects(shapely.Point(point))]
        crossings = [areas.crossing[a] for a in covering if areas.crossing[a] >= 0]
        lanes = [areas.lane[a] for a in covering if areas.lane[a] >= 0]
        assert places.crossing[i] == (crossings[0] if crossings else -1)
        if crossings:
            assert places.lane[i] == places.link[i] == -1
        elif lanes:
            lines = {lane: road_map.lane_columns.lines.line(lane) for lane in lanes}
            distance = {
                lane: shapely.LineString(line).distance(shapely.Point(point))
                for lane, line in lines.items()
            }
            assert distance[places.lane[i]] == pytest.approx(min(distance.values()), abs=1e-9)
            assert (
                places.link[i] == road_map.link_of_road[road_map.lane_columns.road[places.lane[i]]]
            )
        else:
            assert places.lane[i] == -1
            assert (places.link[i] >= 0) == bool(covering)


@settings(derandomize=True, deadline=None, max_examples=15)
@given(st.sampled_from(MAPS), seeds)
def test_distance_to_road_agrees_with_shapely(road_map, seed):
    """The distance to the road is that to the union of its areas."""
    points = points_on(road_map, seed, spread=15.0)[2]

    distances = road_map.distance_to_road(points)

    whole = shapely.union_all(road_map.areas.shapes)
    assert distances == pytest.approx(shapely.distance(whole, shapely.points(points)), abs=1e-9)


@settings(derandomize=True, deadline=None, max_examples=25)
@given(st.sampled_from((*MAPS, ring())), seeds, st.floats(0.0, 400.0))
def test_moving_agrees_with_moving_step_by_step(road_map, seed, distance):
    """Carrying on at once or road by road leads to the same place."""
    road, s, _ = points_on(road_map, seed, count=10)

    moved = road_map.move(road, s + distance)

    for i in range(len(road)):
        at, position, forks = int(road[i]), float(s[i]) + distance, 0
        while position > road_map.road_length[at] and road_map.successors(at):
            position -= road_map.road_length[at]
            forks += len(road_map.successors(at)) > 1
            at = road_map.successors(at)[0]
        assert moved.road[i] == at
        assert moved.s[i] == pytest.approx(position)
        assert moved.branches[i] == forks


@settings(derandomize=True, deadline=None, max_examples=15)
@given(st.sampled_from(MAPS), seeds, st.floats(0.0, 20.0), st.floats(1.0, 12.0))
def test_matching_agrees_with_asking_every_segment(road_map, seed, speed, reach):
    """The matched road has the segment of a lane with the least cost of distance and direction."""
    road, s, points = points_on(road_map, seed, count=8)
    heading = road_map.heading_at(road, s)
    velocity = speed * np.column_stack([np.cos(heading), np.sin(heading)])
    lanes = road_map.lane_columns

    matched = road_map.match(points, velocity, reach)

    for point, direction, found in zip(points, heading, matched, strict=True):
        costs = {-1: math.inf}
        for ends, lane in zip(*lanes.lines.segments(), strict=True):
            distance = shapely.LineString(ends).distance(shapely.Point(point))
            if distance - lanes.width[lane] / 2 <= reach:
                bend = math.atan2(*(ends[1] - ends[0])[::-1]) - direction
                cost = distance + 10.0 * min(1.0, speed / 2.0) * (1 - math.cos(bend))
                costs[lanes.road[lane]] = min(cost, costs.get(lanes.road[lane], math.inf))
        assert costs[found] == pytest.approx(min(costs.values()), abs=1e-6)


def test_who_overtakes_keeps_to_the_own_road():
    """On the lane of the other direction the own road is matched, with an offset to the left."""
    point = np.array([[100.0, 1.6]])

    road = straight_road().match(point, np.array([[15.0, 0.0]]), 5.0)

    assert straight_road().roads[road[0]] == "west_east"
    assert straight_road().project(point, road)[1] == pytest.approx([3.2])


def test_who_stands_is_matched_by_distance():
    """Without motion only the distance counts."""
    points = np.array([[100.0, 1.6], [100.0, -1.6], [100.0, 90.0]])

    road = straight_road().match(points, np.zeros((3, 2)), 5.0)

    assert [straight_road().roads[r] for r in road[:2]] == ["east_west", "west_east"]
    assert road[2] == -1


def test_no_road_gives_not_a_number():
    """For road -1 there is neither position nor heading nor point."""
    none = np.array([-1])

    s, d = STRAIGHT.project(np.zeros((1, 2)), none)

    assert np.isnan([*s, *d]).all()
    assert np.isnan(STRAIGHT.heading_at(none, np.zeros(1))).all()
    assert np.isnan(STRAIGHT.point_at(none, np.zeros(1))).all()
    assert np.isnan(STRAIGHT.position_along_link(none, np.zeros(1))).all()
    assert STRAIGHT.move(none, np.array([5.0])).road[0] == -1


def test_an_empty_frame_gives_empty_answers():
    """Without points every question has an empty answer."""
    points = np.empty((0, 2))

    assert [len(column) for column in CROSSING.locate(points)] == [0, 0, 0]
    assert len(CROSSING.match(points, points, 5.0)) == 0
    assert len(CROSSING.distance_to_road(points)) == 0
    assert len(CROSSING.move(np.empty(0, np.int32), np.empty(0)).road) == 0


@pytest.mark.parametrize("road_map", MAPS)
def test_roads_follow_one_another_without_a_gap(road_map):
    """A road ends where its successors begin."""
    for road in range(len(road_map.roads)):
        for successor in road_map.successors(road):
            end = road_map.point_at([road], road_map.road_length[[road]])
            start = road_map.point_at([successor], np.zeros(1))

            assert end == pytest.approx(start, abs=0.02)


def test_the_straightest_successor_comes_first():
    """From the west, straight on to the east is the first successor."""
    (road,) = road_called(CROSSING, "west_centre")

    (onward,) = CROSSING.successors(CROSSING.successors(road)[0])

    assert CROSSING.roads[onward] == "centre_east"


def test_a_dead_end_is_run_over():
    """Where no road follows, the position goes on behind the end."""
    moved = STRAIGHT.move(road_called(STRAIGHT, "west_east"), np.array([230.0]))

    assert moved.s == pytest.approx([230.0])


def test_both_directions_share_one_measure():
    """The same place has the same position along the link in both directions."""
    road = np.concatenate([road_called(STRAIGHT, n) for n in ("west_east", "east_west")])

    s, _ = STRAIGHT.project(np.full((2, 2), [60.0, 0.0]), road)
    position = STRAIGHT.position_along_link(road, s)

    assert s == pytest.approx([60.0, 140.0])
    assert position[0] == pytest.approx(position[1])
    assert set(STRAIGHT.direction_in_link) == {1.0, -1.0}


def test_positions_along_a_bend_differ_little():
    """On a bend the two directions agree to half of what one is longer than the other."""
    road_map = bend(60.0, math.pi / 2)
    onward, back = road_called(road_map, "start_end"), road_called(road_map, "end_start")
    tolerance = abs(float(np.subtract(*road_map.road_length[[onward[0], back[0]]]))) / 2 + 0.1
    s = np.linspace(5.0, 250.0, 20)
    points = road_map.point_at(np.repeat(onward, 20), s, 1.6)

    opposite, _ = road_map.project(points, np.repeat(back, 20))
    there = road_map.position_along_link(np.repeat(onward, 20), s)
    here = road_map.position_along_link(np.repeat(back, 20), opposite)

    assert np.abs(there - here).max() < tolerance


def test_a_crossing_is_found_by_its_junction():
    """The name of a junction leads to its crossing; others are refused with a hint."""
    assert CROSSING.crossing_index("centre") == 0

    with pytest.raises(UnknownPlaceError, match="no crossing called 'center'; did you mean 'cent"):
        CROSSING.crossing_index("center")


def test_edges_are_parts_of_links_and_crossings():
    """Every edge of the network, also one inside a junction, has either link or crossing."""
    assert CROSSING.link_of_edge["east_centre"] == CROSSING.link_of_edge["centre_east"]
    assert CROSSING.crossing_of_edge[":centre_0"] == 0
    assert CROSSING.link_of_edge.keys().isdisjoint(CROSSING.crossing_of_edge)


def test_the_map_can_be_drawn():
    """Outlines cover what is located, and the crossing lies in the middle."""
    whole = shapely.union_all([shapely.Polygon(p) for p in CROSSING.road_polygons()])

    assert whole.area == pytest.approx(shapely.union_all(CROSSING.areas.shapes).area, rel=1e-6)
    assert CROSSING.crossing_centre(0) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert len(CROSSING.crossing_polygons()) == 1
    assert STRAIGHT.bounds == pytest.approx((0.0, -6.4, 200.0, 6.4))

"""What is ahead of what, against following every way."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.ahead import RoadsAhead
from networks.building import bend, four_arm_crossing, ring, straight_road

MAPS = (four_arm_crossing(lanes=2, u_turns=True), straight_road(200.0), bend(), ring())


def starts_of(road_map, road, *, undecided):
    """Return the roads on which a point on *road* may be."""
    if not undecided or road < road_map.graph.edge_count:
        return [road]
    return [
        way
        for edge in range(road_map.graph.edge_count)
        for way in road_map.successors(edge)
        if road in road_map.successors(edge)
    ]


def naive_pairs(road_map, road, s, reach, *, undecided=False):
    """Return the distance of each pair, by following all ways from each point."""
    found = {}
    for i in range(len(road)):
        starts = starts_of(road_map, int(road[i]), undecided=undecided)
        begins = dict.fromkeys(starts, 0.0)
        stack = [(start, 0.0) for start in starts]
        while stack:
            here, begin = stack.pop()
            end = begin + road_map.road_length[here]
            for onward in road_map.successors(here):
                if end - s[i] <= reach and end < begins.get(onward, np.inf):
                    begins[onward] = end
                    stack.append((onward, end))
        for j in range(len(road)):
            distance = begins.get(int(road[j]), np.inf) + s[j] - s[i]
            if 0 < distance <= reach:
                found[i, j] = distance
    return found


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.sampled_from(MAPS), st.integers(0, 2**32 - 1), st.floats(1.0, 120.0), st.booleans())
def test_pairs_agree_with_trying_all_ways(road_map, seed, reach, undecided):
    """One point is ahead of another if the shortest way to it is within reach."""
    generator = np.random.Generator(np.random.PCG64(seed))
    road = generator.integers(-1, len(road_map.roads), 25)
    s = np.where(road < 0, np.nan, generator.uniform(0, 1, 25) * road_map.road_length[road])

    found = RoadsAhead(road_map, reach, undecided=undecided).pairs(road, s)

    known = np.flatnonzero(road >= 0)
    expected = naive_pairs(road_map, road[known], s[known], reach, undecided=undecided)
    pairs = {
        (int(i), int(j)): distance
        for i, j, distance in zip(found.behind, found.ahead, found.distance, strict=True)
    }
    assert pairs == pytest.approx(
        {(int(known[i]), int(known[j])): distance for (i, j), distance in expected.items()}
    )


def test_what_was_learned_about_some_roads_serves_for_others():
    """Asking for other roads later gives the same as asking for them at first."""
    road_map = MAPS[0]
    generator = np.random.Generator(np.random.PCG64(5))
    seasoned = RoadsAhead(road_map, 60.0)
    for _ in range(20):
        road = generator.integers(0, len(road_map.roads), 10)
        s = generator.uniform(0, 1, 10) * road_map.road_length[road]

        found = seasoned.pairs(road, s)

        fresh = RoadsAhead(road_map, 60.0).pairs(road, s)
        assert sorted(zip(*found, strict=True)) == sorted(zip(*fresh, strict=True))


def test_no_points_make_no_pairs():
    """An empty frame, and one in which nobody is on a road, are answered."""
    ahead = RoadsAhead(MAPS[0], 60.0)

    assert not len(ahead.pairs(np.empty(0, dtype=int), np.empty(0)).behind)
    assert not len(ahead.pairs(np.array([-1, -1]), np.array([1.0, 2.0])).behind)

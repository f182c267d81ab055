"""Angles and polylines."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from networks.geometry import (
    Polylines,
    first_least,
    group_ranges,
    has_length,
    middle_line,
    offset_line,
    resampled,
    without_repetitions,
    wrapped_angle,
)

BEND = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])
FLAT = np.array([[0.0, 5.0], [4.0, 5.0]])

coordinates = st.integers(-60, 60).map(float)
corners = st.tuples(coordinates, coordinates)
lines = (
    st.lists(corners, min_size=2, max_size=7)
    .map(lambda line: np.array(line, dtype=np.float64))
    .filter(has_length)
)


def test_angles_are_wrapped_into_one_turn():
    """An angle comes into (-π, π], π itself stays."""
    wrapped = wrapped_angle([0.0, math.pi, -math.pi, 3 * math.pi, 2.5 * math.pi])

    assert wrapped == pytest.approx([0.0, math.pi, math.pi, math.pi, math.pi / 2])


def test_ranges_follow_one_another():
    """Ranges are written out one after another, empty ones leave nothing."""
    ranges = group_ranges(np.array([4, 9, 0]), np.array([2, 0, 3]))

    assert ranges.tolist() == [4, 5, 0, 1, 2]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 4)), max_size=30))
def test_first_least_agrees_with_a_loop(pairs):
    """In each group the first of its least values is found."""
    pairs = sorted(pairs, key=lambda pair: pair[0])
    group = np.array([g for g, _ in pairs], dtype=np.intp)
    values = np.array([v for _, v in pairs], dtype=np.float64)
    expected = [
        min(
            (i for i, (h, _) in enumerate(pairs) if h == g),
            key=lambda i: (pairs[i][1], i),
        )
        for g in sorted({g for g, _ in pairs})
    ]

    assert first_least(values, group).tolist() == expected


def test_a_line_loses_its_repetitions():
    """Points that repeat the one before are dropped."""
    line = without_repetitions(np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]))

    assert line.tolist() == [[0.0, 0.0], [1.0, 0.0]]


def test_a_line_of_one_place_is_refused():
    """A line whose points are all the same has no direction."""
    with pytest.raises(ValueError, match="two different points"):
        without_repetitions(np.zeros((3, 2)))


def test_resampling_keeps_to_the_line():
    """The fractions of a line are measured along it."""
    points = resampled(BEND, np.array([0.0, 0.25, 0.5, 0.75]))

    assert points.tolist() == [[0, 0], [5, 0], [10, 0], [10, 5]]


def test_the_middle_line_is_midway():
    """Between two parallels the middle line is half-way."""
    middle = middle_line(FLAT, FLAT + np.array([0.0, 3.0]))

    assert middle.tolist() == [[0.0, 6.5], [4.0, 6.5]]


def test_an_offset_line_is_mitred():
    """Moved to the left, a left bend meets on its inner side."""
    moved = offset_line(BEND, 2.0)

    assert moved == pytest.approx(np.array([[0.0, 2.0], [8.0, 2.0], [8.0, 10.0]]))


def test_projection_gives_position_and_left_offset():
    """Left of the line the offset is positive, right of it negative."""
    lines = Polylines([BEND, FLAT])

    s, d = lines.project(np.array([[5.0, 2.0], [12.0, 5.0], [1.0, 4.0]]), np.array([0, 0, 1]))

    assert s.tolist() == [5.0, 15.0, 1.0]
    assert d.tolist() == [2.0, -2.0, -1.0]


def test_a_line_goes_on_straight_beyond_its_ends():
    """Before the start s is negative, behind the end it is greater than the length."""
    lines = Polylines([BEND])

    s, d = lines.project(np.array([[-3.0, 1.0], [11.0, 14.0]]), np.array([0, 0]))

    assert s.tolist() == [-3.0, 24.0]
    assert d.tolist() == [1.0, -1.0]
    assert lines.at(np.array([0, 0]), s, d).tolist() == [[-3.0, 1.0], [11.0, 14.0]]


def test_the_heading_is_that_of_the_segment():
    """The heading changes at the corner."""
    headings = Polylines([BEND]).heading_at(np.zeros(3, int), np.array([-5.0, 9.9, 10.1]))

    assert headings == pytest.approx([0.0, 0.0, math.pi / 2])


def test_no_points_are_no_trouble():
    """An empty frame gives empty answers."""
    s, d = Polylines([BEND]).project(np.empty((0, 2)), np.empty(0, dtype=np.intp))

    assert len(s) == len(d) == 0


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(lines, min_size=1, max_size=4), st.lists(corners, min_size=1, max_size=8))
def test_distance_agrees_with_shapely(lines, points):
    """The distance of each point from its line is the one that shapely finds."""
    index = np.arange(len(points)) % len(lines)

    distances = Polylines(lines).distance(np.array(points), index)

    expected = [
        shapely.LineString(lines[i]).distance(shapely.Point(p))
        for i, p in zip(index, points, strict=True)
    ]
    assert distances == pytest.approx(expected, abs=1e-6)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(lines, min_size=1, max_size=4), st.floats(0.0, 1.0), st.data())
def test_point_and_projection_are_inverse_on_the_line(lines, fraction, data):
    """A point of a line projects onto itself."""
    polylines = Polylines(lines)
    index = np.array([data.draw(st.integers(0, len(lines) - 1))])
    point = polylines.at(index, fraction * polylines.lengths[index])

    s, d = polylines.project(point, index)

    assert d == pytest.approx([0.0], abs=1e-6)
    assert polylines.at(index, s) == pytest.approx(point, abs=1e-6)
    assert shapely.LineString(lines[index[0]]).distance(shapely.Point(point[0])) < 1e-6

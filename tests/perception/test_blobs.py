"""Blobs and their moments."""

from itertools import pairwise

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.blobs import Blobs, find_blobs, mean_within, outline_moments, per_blob_mean

COUNTS = st.lists(st.integers(3, 9), min_size=1, max_size=5)


def star(corners, generator):
    """Return a polygon (k, 2) around a random place, its corners in order of angle."""
    angles = np.sort(generator.uniform(0, 2 * np.pi, corners))
    radius = generator.uniform(1.0, 5.0, corners)
    around = np.column_stack([np.cos(angles), np.sin(angles)]) * radius[:, None]
    return around + generator.uniform(-100, 100, 2)


def integral(polygon, function):
    """Integrate over a polygon by cutting it into triangles, with their exact midpoint rule."""
    total = 0.0
    first = polygon[0]
    for second, third in pairwise(polygon[1:]):
        edge, other = second - first, third - first
        area = 0.5 * (edge[0] * other[1] - edge[1] * other[0])
        middles = [(first + second) / 2, (second + third) / 2, (third + first) / 2]
        total += area * np.mean([function(m) for m in middles], axis=0)
    return total


@settings(derandomize=True, deadline=None, max_examples=60)
@given(COUNTS, st.integers(0, 2**32 - 1))
def test_moments_of_many_outlines_agree_with_those_of_each(counts, seed):
    """Area and centroid are shapely's; the spread is the integral over triangles."""
    generator = np.random.default_rng(seed)
    polygons = [star(corners, generator) for corners in counts]
    starts = np.cumsum([0, *counts[:-1]])

    moments = outline_moments(np.concatenate(polygons), starts)

    for row, polygon in enumerate(polygons):
        shape = shapely.Polygon(polygon)
        if shape.area < 1e-3 or not shape.is_valid:
            continue
        np.testing.assert_allclose(moments.area[row], shape.area, rtol=1e-6)
        centroid = shapely.get_coordinates(shape.centroid)[0]
        np.testing.assert_allclose(moments.centroid[row], centroid, atol=1e-5)
        off = polygon - centroid
        signed = integral(off, lambda _: 1.0)
        products = integral(off, lambda p: np.outer(p, p))
        np.testing.assert_allclose(moments.spread[row], products / signed, rtol=1e-4, atol=1e-4)


def test_a_line_has_a_centroid_and_no_spread():
    """An outline without area gives the mean of its corners."""
    moments = outline_moments(np.array([[0.0, 0.0], [2.0, 2.0], [4.0, 4.0]]), np.array([0]))

    assert moments.area[0] == 0.0
    np.testing.assert_allclose(moments.centroid, [[2.0, 2.0]])
    assert not moments.spread.any()


def mask_with(*boxes, shape=(60, 80)):
    """Return a mask with filled boxes (left, top, right, low), ends included."""
    mask = np.zeros(shape, dtype=np.uint8)
    for left, top, right, low in boxes:
        mask[top : low + 1, left : right + 1] = 255
    return mask


def test_each_connected_region_is_a_blob():
    """Two boxes give two outlines with the boxes' borders; the one at the edge is flagged."""
    blobs = find_blobs(mask_with((10, 10, 20, 15), (70, 40, 79, 50)))

    order = np.argsort(blobs.boxes[:, 0])
    np.testing.assert_array_equal(blobs.boxes[order], [[10, 10, 20, 15], [70, 40, 79, 50]])
    np.testing.assert_array_equal(blobs.touches_border[order], [False, True])


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.integers(2, 6), st.integers(7, 15))
def test_taking_thin_parts_away_does_not_move_what_is_thick(thinnest, side):
    """A box with a hair of one pixel is the box again, for odd and for even kernels."""
    box = (20, 20, 20 + side, 20 + side)

    blobs = find_blobs(mask_with(box, (5, 25, 60, 25)), thinnest=thinnest)

    np.testing.assert_array_equal(blobs.boxes, [box])


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.integers(1, 8), st.integers(1, 8))
def test_narrow_gaps_are_bridged_and_wide_ones_are_not(gap, bridged):
    """Two boxes become one exactly when the gap is narrower than what is bridged."""
    blobs = find_blobs(mask_with((10, 10, 20, 20), (21 + gap, 10, 40, 20)), bridged=bridged)

    assert len(blobs) == (1 if gap < bridged else 2)


def test_small_regions_are_left_out():
    """A region whose outline is too short is noise."""
    blobs = find_blobs(mask_with((10, 10, 11, 11), (30, 30, 40, 40)), min_outline=8)

    assert len(blobs) == 1


def test_the_mean_within_an_outline_leaves_out_the_rest():
    """Only pixels inside count, whatever surrounds them; channels stay apart."""
    image = np.zeros((60, 80, 3), dtype=np.uint8)
    image[10:16, 10:21] = (10, 20, 30)

    means = mean_within(image, find_blobs(mask_with((10, 10, 20, 15))).outlines)

    np.testing.assert_allclose(means, [[10, 20, 30]])


def test_boxes_meet_only_where_they_overlap():
    """A blob meets the blobs of another image whose box shares a pixel with its own."""
    blobs = find_blobs(mask_with((10, 10, 20, 15), (40, 40, 50, 50)))
    others = find_blobs(mask_with((18, 14, 30, 30)))

    assert sorted(blobs.meets(others).tolist()) == [False, True]
    assert not blobs.meets(find_blobs(mask_with())).any()


def test_no_blobs_have_empty_columns():
    """An empty mask gives columns without rows."""
    blobs = find_blobs(mask_with())

    assert len(blobs) == len(blobs.points) == len(blobs.starts) == len(blobs.boxes) == 0


def test_means_are_taken_blob_by_blob():
    """Values at the points are averaged for each outline."""
    outlines = (np.zeros((2, 2), np.int32), np.zeros((3, 2), np.int32))
    blobs = Blobs(outlines, np.zeros(2, dtype=bool))

    np.testing.assert_allclose(per_blob_mean(np.array([1, 3, 4, 5, 6]), blobs), [2.0, 5.0])

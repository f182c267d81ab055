"""Areas, apart from look-up (see test_roads)."""

import numpy as np
import pytest
import shapely

from networks.regions import outlines, strip, united

LINE = np.array([[0.0, 0.0], [10.0, 0.0]])


def test_a_strip_lies_to_both_sides():
    """A strip is as long as its line and as wide as asked."""
    (area,) = strip([LINE], [4.0])

    assert area.bounds == (0.0, -2.0, 10.0, 2.0)


def test_narrow_gaps_are_closed():
    """Areas half a metre apart become one."""
    parts = strip([LINE, LINE + np.array([0.0, 4.5])], [4.0, 4.0])

    whole = united(list(parts))

    assert whole.geom_type == "Polygon"
    assert whole.area == pytest.approx(10 * 8.5)


def test_outlines_leave_out_what_is_no_area():
    """Of a collection only the polygons have an outline; it is not closed."""
    mixed = shapely.GeometryCollection([shapely.box(0, 0, 2, 1), shapely.LineString(LINE)])

    (ring,) = outlines(mixed)

    assert len(ring) == 4

"""Paths: smooth curves measured along their length."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, Point

from traffic.sumo.acts.paths import Path

CORNER = np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 40.0]])


def test_the_ends_of_a_path_are_those_of_its_polyline() -> None:
    """Corners are rounded, ends are not."""
    path = Path.along(CORNER)

    assert path.point(0.0) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert path.point(path.length) == pytest.approx((40.0, 40.0), abs=1e-6)
    assert 78.0 < path.length < 80.0


def test_a_rounded_corner_turns_little_by_little() -> None:
    """Between points a quarter of a metre apart the direction changes by less than 11 degrees."""
    path = Path.along(CORNER)

    headings = np.array([path.heading(s) for s in np.arange(0.0, path.length, 0.25)])

    assert headings[0] == pytest.approx(0.0, abs=1e-6)
    assert headings[-1] == pytest.approx(np.pi / 2, abs=1e-6)
    assert np.degrees(np.abs(np.diff(headings)).max()) < 11.0


corners = st.lists(
    st.tuples(st.integers(20, 40), st.integers(-60, 60)), min_size=1, max_size=5
).map(
    lambda legs: np.cumsum(
        [(0.0, 0.0)]
        + [(d * np.cos(a), d * np.sin(a)) for d, a in ((d, np.radians(a)) for d, a in legs)],
        axis=0,
    )
)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(corners=corners, share=st.floats(0.05, 0.95), aside=st.floats(-2.0, 2.0))
def test_a_point_beside_a_path_is_found_again(
    corners: np.ndarray, share: float, aside: float
) -> None:
    """The distance to the curve agrees with geometry, and the place with where it was made."""
    path = Path.along(corners)
    s = share * path.length

    x, y = path.point(s, aside)
    found_s, found_aside = path.place_of(x, y)

    curve = LineString([path.point(each) for each in np.arange(0.0, path.length, 0.1)])
    assert abs(found_aside) == pytest.approx(curve.distance(Point(x, y)), abs=0.05)
    assert found_aside == pytest.approx(aside, abs=0.05)
    assert found_s == pytest.approx(s, abs=0.3)


def test_doubled_corners_do_no_harm() -> None:
    """Lanes that follow one another share a point."""
    doubled = np.repeat(CORNER, 2, axis=0)

    assert Path.along(doubled).length == pytest.approx(Path.along(CORNER).length)

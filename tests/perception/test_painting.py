"""The ground as a camera sees it."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.painting import (
    GroundPainter,
    fill_areas,
    level_from_temperature,
    temperature_from_level,
)
from perception.scene import build_surroundings
from tests.perception.scenes import camera, road, texture


@pytest.fixture(scope="module")
def painter():
    """Return a painter of the road with houses and trees."""
    return GroundPainter(road(), build_surroundings(road(), np.random.default_rng(1)), texture())


def test_roads_are_grey_grass_is_green_and_lines_are_bright(painter):
    """Each surface has its colour, and asphalt is the warmest."""
    view = camera()
    image, warmth = painter.paint_colour(view).astype(int), painter.paint_thermal(view)
    places = np.array([[0.0, 3.0], [3.75, 0.0]])
    asphalt, line = view.image_from_ground(places).round().astype(int)[:, ::-1]
    is_green = (image[..., 1] > image[..., 0] + 15) & (image[..., 1] > image[..., 2] + 10)

    assert np.ptp(image[tuple(asphalt)]) < 12
    assert image[tuple(line)].mean() > image[tuple(asphalt)].mean() + 40
    assert is_green.mean() > 0.3
    assert warmth[tuple(asphalt)] > np.median(warmth[is_green]) + 20


@settings(derandomize=True, deadline=None, max_examples=50)
@given(st.floats(10.0, 58.0))
def test_levels_and_temperatures_are_inverse(degrees):
    """A temperature that the sensor can show is read back from its level."""
    assert temperature_from_level(level_from_temperature(degrees)) == pytest.approx(degrees)


def test_areas_are_filled_to_the_pixel_with_their_holes():
    """The number of filled pixels is the area in view over the size of a pixel."""
    view = camera()
    ring = shapely.Polygon(
        [(-20, -20), (20, -20), (20, 20), (-20, 20)], [[(-5, -5), (5, -5), (5, 5), (-5, 5)]]
    )
    mask = np.zeros((360, 640), dtype=np.uint8)

    fill_areas(mask, np.array([ring], dtype=object), view, 255)

    assert np.count_nonzero(mask) * view.metres_per_pixel() ** 2 == pytest.approx(1500, rel=0.03)

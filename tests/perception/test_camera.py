"""The pinhole camera."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.camera import Calibration, Camera
from perception.errors import CalibrationError

CAMERAS = st.builds(
    lambda x, y, altitude, heading, pitch: Camera.looking_at(
        x, y, altitude, heading=heading, pitch=math.radians(pitch)
    ),
    st.floats(-1e4, 1e4),
    st.floats(-1e4, 1e4),
    st.floats(20.0, 400.0),
    st.floats(-math.pi, math.pi),
    st.floats(45.0, 90.0),
)
PIXELS = st.lists(st.tuples(st.floats(0.0, 1279.0), st.floats(0.0, 719.0)), min_size=1, max_size=5)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(CAMERAS, PIXELS, st.floats(0.0, 10.0))
def test_projecting_undoes_back_projecting(camera, pixels, height):
    """What lies under a pixel's ray at some height is seen in that pixel."""
    points = np.array(pixels)

    ground = camera.ground_from_image(points, height)

    seen = camera.image_from_world(np.column_stack([ground, np.full(len(points), height)]))
    np.testing.assert_allclose(seen, points, atol=1e-5)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(CAMERAS, PIXELS)
def test_ground_per_pixel_is_the_derivative_of_the_ground(camera, pixels):
    """The Jacobian agrees with a difference of a thousandth of a pixel."""
    points = np.array(pixels)
    step = 1e-3

    slope = camera.ground_per_pixel(points)

    for axis in (0, 1):
        shift = np.eye(2)[axis] * step
        moved = camera.ground_from_image(points + shift) - camera.ground_from_image(points - shift)
        np.testing.assert_allclose(slope[:, :, axis], moved / (2 * step), rtol=1e-3, atol=1e-3)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(CAMERAS)
def test_what_lies_in_the_footprint_is_seen(camera):
    """The middle of the footprint's corners is in the image, a point far outside is not."""
    corners = camera.footprint()

    assert camera.sees(corners.mean(axis=0, keepdims=True)).all()
    assert not camera.sees(corners + 3.0 * (corners - corners.mean(axis=0))).any()


def test_a_camera_looking_at_a_point_has_it_in_the_middle():
    """The optical axis of an oblique camera meets the ground where it was told to."""
    camera = Camera.looking_at(30.0, -20.0, 100.0, heading=0.7, pitch=math.radians(50.0))

    np.testing.assert_allclose(
        camera.image_from_ground(np.array([[30.0, -20.0]])), [[639.5, 359.5]], atol=1e-9
    )


def test_looking_straight_down_north_is_up_and_east_is_right():
    """At nadir with heading north, image axes follow the compass."""
    camera = Camera.looking_at(0.0, 0.0, 100.0)

    middle, east, north = camera.image_from_ground(
        np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]])
    )

    assert east[0] > middle[0]
    assert north[1] < middle[1]
    assert camera.metres_per_pixel() == pytest.approx(2 * 100 * math.tan(math.radians(42)) / 1280)


def test_roll_turns_the_image_about_its_middle():
    """A quarter turn of roll brings what was right of the middle below or above it."""
    plain = Camera.looking_at(0.0, 0.0, 100.0)
    rolled = Camera(plain.position, roll=math.pi / 2)

    before = plain.image_from_ground(np.array([[10.0, 0.0]]))[0] - plain.calibration.centre_px
    after = rolled.image_from_ground(np.array([[10.0, 0.0]]))[0] - rolled.calibration.centre_px

    assert np.hypot(*before) == pytest.approx(np.hypot(*after))
    assert before @ after == pytest.approx(0.0, abs=1e-6)


def test_points_behind_the_camera_have_no_pixel():
    """A point above a camera that looks down gives NaN."""
    camera = Camera.looking_at(0.0, 0.0, 100.0)

    assert np.isnan(camera.image_from_world(np.array([[0.0, 0.0, 150.0]]))).all()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Camera((0.0, 0.0, -1.0)), "camera altitude must be above"),
        (lambda: Camera((0.0, 0.0, math.nan)), "camera pose must be finite"),
        (lambda: Camera((0.0, 0.0, 50.0), pitch=0.2), "wholly below the horizon"),
        (lambda: Camera.looking_at(0.0, 0.0, 50.0, pitch=-1.0), "camera pitch must be above 0"),
        (lambda: Calibration(0, 720, 700.0, (0.0, 0.0)), "image size must be at least 1 x 1"),
        (lambda: Calibration(640, 480, -1.0, (0.0, 0.0)), "focal length must be a positive"),
        (lambda: Calibration(640, 480, 1.0, (0.0, math.inf)), "image centre must be finite"),
        (lambda: Calibration.from_field_of_view(horizontal=4.0), "field of view must be between"),
    ],
)
def test_impossible_cameras_are_refused(make, message):
    """A camera that cannot be is refused with what was expected and what was found."""
    with pytest.raises(CalibrationError, match=message):
        make()

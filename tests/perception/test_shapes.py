"""Vehicles and houses as faces."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.shapes import Material, faces_of_vehicles, visible_quads
from tests.perception.scenes import BUS, CAR, camera, vehicles

SIZES = st.sampled_from([CAR, BUS, (7.1, 2.4, 2.4), (2.2, 0.9, 1.5)])


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.floats(-30, 30), st.floats(-15, 15), st.floats(-np.pi, np.pi), SIZES)
def test_faces_fill_the_box_of_the_vehicle(x, y, heading, size):
    """In the vehicle's own frame the corners reach length, width and height, and no farther."""
    faces = faces_of_vehicles(vehicles([(1, x, y, heading, size)]), camera())

    offset = faces.corners.reshape(-1, 3) - (x, y, 0.0)
    along = offset[:, 0] * np.cos(heading) + offset[:, 1] * np.sin(heading)
    across = offset[:, 1] * np.cos(heading) - offset[:, 0] * np.sin(heading)
    assert np.abs(along).max() == pytest.approx(size[0] / 2)
    assert np.abs(across).max() == pytest.approx(size[1] / 2)
    assert offset[:, 2].max() == pytest.approx(size[2], rel=0.01)
    assert offset[:, 2].min() >= 0.0


def test_only_faces_towards_the_camera_are_visible():
    """From straight above, tops are seen and sides are not."""
    faces = faces_of_vehicles(vehicles([(1, 0.0, 0.0, 0.0, BUS)]), camera())

    _, rows = visible_quads(faces, camera(), inset_px=0.0)

    heights = np.ptp(faces.corners[rows][..., 2], axis=1)
    assert len(rows) > 0
    assert (heights == 0.0).all()


def test_the_far_vehicle_is_painted_first():
    """Faces come in the order of falling distance from the camera."""
    faces = faces_of_vehicles(
        vehicles([(1, 5.0, 0.0, 0.0, CAR), (2, 50.0, 0.0, 0.0, CAR)]), camera()
    )

    assert faces.owner[0] == 1
    assert faces.owner[-1] == 0


def test_insets_shrink_a_quad_on_every_side():
    """A large face loses the inset on each of its four sides."""
    faces = faces_of_vehicles(vehicles([(1, 0.0, 0.0, 0.0, BUS)]), camera())

    plain, rows = visible_quads(faces, camera(), inset_px=0.0)
    inset, _ = visible_quads(faces, camera(), inset_px=0.5)

    roof = np.ptp(plain[:, :, 0], axis=1).argmax()
    np.testing.assert_allclose(np.ptp(plain[roof], axis=0) - np.ptp(inset[roof], axis=0), 1.0)
    assert (faces.material[rows] != Material.NONE).all()

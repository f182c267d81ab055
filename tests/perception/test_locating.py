"""Blobs on the ground."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.blobs import Blobs
from perception.camera import Camera
from perception.locating import height_from_length, locate, no_sightings


def silhouette(camera, position, heading, size):
    """Return the pixels on the hull of a box's image, in order around it."""
    length, width, height = size
    signs = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (0, 1)])
    local = signs * np.array([length / 2, width / 2, height])
    cos, sin = math.cos(heading), math.sin(heading)
    corners = np.column_stack(
        [
            position[0] + cos * local[:, 0] - sin * local[:, 1],
            position[1] + sin * local[:, 0] + cos * local[:, 1],
            local[:, 2],
        ]
    )
    return hull_of(camera.image_from_world(corners))


def hull_of(points):
    """Return the convex hull by gift wrapping, as whole pixels."""
    start = current = int(points[:, 0].argmin())
    hull = []
    while True:
        hull.append(current)
        ahead = points - points[current]
        best = (current + 1) % len(points)
        for candidate in range(len(points)):
            turn = ahead[best][0] * ahead[candidate][1] - ahead[best][1] * ahead[candidate][0]
            if candidate != current and turn > 0:
                best = candidate
        current = best
        if current == start or len(hull) > len(points):
            return np.rint(points[hull]).astype(np.int32)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(
    st.floats(-60.0, 60.0),
    st.floats(-35.0, 35.0),
    st.floats(-math.pi, math.pi),
    st.sampled_from([60.0, 75.0, 90.0]),
)
def test_a_box_is_located_at_its_middle(x, y, heading, pitch):
    """The middle of a bus-like box is found to 0.4 m, wherever it is seen from."""
    camera = Camera.looking_at(0.0, 0.0, 120.0, pitch=math.radians(pitch))
    outline = silhouette(camera, (x, y), heading, (12.0, 2.5, 3.4))

    found = locate(Blobs((outline,), np.array([False])), camera, noise_px=0.4)

    assert np.hypot(*(found.position[0] - (x, y))) < 0.4
    assert found.length[0] == pytest.approx(12.0, abs=1.2)
    assert found.width[0] == pytest.approx(2.5, abs=0.8)
    np.linalg.cholesky(found.covariance[0])


def test_uncertainty_grows_with_distance_along_the_ray():
    """An oblique view is less sure of what is farther away, most of all along the ray."""
    camera = Camera.looking_at(0.0, 0.0, 80.0, heading=0.0, pitch=math.radians(50.0))
    near, far = (
        locate(
            Blobs((silhouette(camera, (x, 0.0), 0.0, (5.0, 1.8, 1.5)),), np.array([False])),
            camera,
            noise_px=0.4,
        )
        for x in (-20.0, 60.0)
    )

    assert far.covariance[0, 0, 0] > 2 * near.covariance[0, 0, 0]
    assert far.covariance[0, 0, 0] > far.covariance[0, 1, 1]


def test_longer_vehicles_are_higher():
    """The usual height never falls with the length."""
    heights = height_from_length(np.linspace(2.0, 20.0, 50))

    assert (np.diff(heights) >= 0).all()


def test_no_blobs_no_sightings():
    """An image without blobs gives columns without rows."""
    camera = Camera.looking_at(0.0, 0.0, 80.0)

    assert len(locate(Blobs((), np.zeros(0, bool)), camera, noise_px=0.4)) == 0
    assert len(no_sightings()) == 0

"""What the cameras show of a scene."""

import numpy as np
import pytest

from perception.rendering import SensorNoise, temperature_of_vehicles
from perception.shapes import Material
from tests.perception.scenes import BUS, CAR, Film, camera

CAMERA = camera()


def window(image, x, y, half=3):
    """Return the pixels around a place on the ground."""
    u, v = CAMERA.image_from_ground(np.array([[x, y]])).round().astype(int)[0]
    return image[v - half : v + half + 1, u - half : u + half + 1].astype(float)


def test_the_same_seed_gives_the_same_bytes():
    """Two films with one seed are equal frame by frame; another seed differs."""
    films = [Film(1), Film(1), Film(2)]
    frames = [[film.take([(1, 0.5 * f, 0, 0, CAR)], CAMERA) for f in range(3)] for film in films]

    for first, second in zip(frames[0], frames[1], strict=True):
        np.testing.assert_array_equal(first[0], second[0])
        np.testing.assert_array_equal(first[1], second[1])
    assert (frames[0][0][0] != frames[2][0][0]).any()


def test_images_have_the_size_of_the_camera():
    """Colour has three channels, thermal none."""
    colour, thermal = Film().take([], CAMERA)

    assert colour.shape == (360, 640, 3)
    assert thermal.shape == (360, 640)
    assert colour.dtype == thermal.dtype == np.uint8


def test_a_vehicle_shows_its_colour_and_only_around_its_place():
    """A white bus is bright where it stands; far from it the frame is the empty road."""
    film = Film(noise := 0)
    colour, _ = film.take([(4, 10.0, 3.0, 0.0, BUS)], CAMERA)
    empty, _ = Film(noise).take([], CAMERA)

    assert window(colour, 10.0, 3.0).mean() > 170
    assert window(empty, 10.0, 3.0).mean() < 120
    assert abs(window(colour, -30.0, 3.0).mean() - window(empty, -30.0, 3.0).mean()) < 3.0


def test_the_thermal_image_tells_warm_and_cold_from_the_asphalt():
    """Of many vehicles some are warmer and some are colder than the road, none is the same."""
    rows = [(i, -50 + 10 * i, 3.0, 0.0, CAR) for i in range(1, 10)]

    _, thermal = Film().take(rows, CAMERA)

    road = window(thermal, 0.0, -4.0).mean()
    contrast = np.array([window(thermal, row[1] - 0.8, 3.0, 1).mean() - road for row in rows])
    assert (contrast > 10).any()
    assert (contrast < -10).any()
    assert (np.abs(contrast) > 10).all()


def test_the_shadow_falls_away_from_the_sun():
    """To the north-east of a vehicle the ground is darker than to the south-west."""
    colour, _ = Film().take([(4, 0.0, 0.0, 0.0, (5.0, 2.0, 3.0))], CAMERA)

    assert window(colour, 0.5, 1.7, 1).mean() < window(colour, 0.5, -1.7, 1).mean() - 10


@pytest.mark.parametrize("shape", [(60, 80), (60, 80, 3)])
def test_noise_has_its_deviation_and_differs_from_frame_to_frame(shape):
    """Added noise has the headroom as mean, the given deviation, and is fresh for each frame."""
    noise = SensorNoise(shape, 2.5, np.random.default_rng(0))
    frames = []
    for _ in range(2):
        image = np.full(shape, 100, dtype=np.uint8)
        noise.add_to(image)
        frames.append(image.astype(float))

    assert frames[0].mean() == pytest.approx(100 + noise.headroom, abs=0.2)
    assert frames[0].std() == pytest.approx(2.5, rel=0.05)
    assert np.corrcoef(frames[0].ravel(), frames[1].ravel())[0, 1] < 0.1


def test_warmth_depends_on_the_id_only():
    """The same vehicle has the same temperatures, whatever else is in view."""
    alone = temperature_of_vehicles(np.array([7]))
    among = temperature_of_vehicles(np.array([3, 7, 9]))

    np.testing.assert_array_equal(alone[0], among[1])


def test_about_the_given_share_of_vehicles_is_cold():
    """The share of cold vehicles is kept over many ids, and engines are warmer than bodies."""
    degrees = temperature_of_vehicles(np.arange(4000), cold_share=0.6)

    assert np.mean(degrees[:, Material.PAINT] < 37.0) == pytest.approx(0.6, abs=0.03)
    assert (degrees[:, Material.BONNET] > degrees[:, Material.PAINT]).all()


def test_another_pose_shows_the_same_ground():
    """After a move of the camera, a place on the ground keeps its surface."""
    film = Film()
    here, _ = film.take([], CAMERA)
    there, _ = film.take([], camera(pitch=80.0))

    u, v = camera(pitch=80.0).image_from_ground(np.array([[5.0, 8.5]])).round().astype(int)[0]
    grass = there[v - 2 : v + 3, u - 2 : u + 3].mean(axis=(0, 1))
    np.testing.assert_allclose(window(here, 5.0, 8.5, 2).mean(axis=(0, 1)), grass, atol=12)

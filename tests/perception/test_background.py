"""The background, learned from pixels."""

import numpy as np
import pytest

from perception.background import (
    Background,
    BackgroundSettings,
    find_standing,
    guess_empty_road,
)
from perception.blobs import find_blobs

SETTINGS = BackgroundSettings()
EVERYWHERE = np.full((80, 120), 255, dtype=np.uint8)


def road_image(generator, level=90.0, noise=2.0):
    """Return a grey road with noise."""
    pixels = generator.normal(level, noise, EVERYWHERE.shape)
    return np.clip(np.rint(pixels), 0, 255).astype(np.uint8)


def with_box(image, level=200):
    """Return the image with a box on it."""
    changed = image.copy()
    changed[30:40, 40:60] = level
    return changed


def learned(generator, *, noise=2.0, frames=100):
    """Return a background that has seen the empty road for a while."""
    background = Background(road_image(generator, noise=noise), SETTINGS)
    for _ in range(frames):
        background.learn(road_image(generator, noise=noise), EVERYWHERE)
    return background


@pytest.mark.parametrize("noise", [1.0, 2.5, 5.0])
def test_the_noise_is_measured(noise):
    """After some seconds the deviation of the noise is known to a fifth."""
    background = learned(np.random.default_rng(1), noise=noise, frames=400)

    assert background.noise == pytest.approx(noise, rel=0.2)


def test_noise_is_not_foreground_and_a_box_is():
    """The empty road gives almost no foreground, a box gives itself."""
    generator = np.random.default_rng(2)
    background = learned(generator)

    empty = np.count_nonzero(background.foreground(road_image(generator), EVERYWHERE))
    box = background.foreground(with_box(road_image(generator)), EVERYWHERE)

    assert empty <= 2
    assert (box[30:40, 40:60] == 255).all()
    assert np.count_nonzero(box) <= 200 + 2


def test_only_the_region_is_looked_at():
    """Outside the region nothing is foreground."""
    generator = np.random.default_rng(3)
    background = learned(generator)

    mask = background.foreground(with_box(road_image(generator)), np.zeros_like(EVERYWHERE))

    assert not mask.any()


def test_a_shadow_is_background_for_a_colour_camera_only():
    """What lowers the light by less than the darkest shadow is let pass, if shadows exist."""
    generator = np.random.default_rng(4)
    shaded = with_box(road_image(generator), level=70)

    with_shadows = Background(
        road_image(generator), BackgroundSettings(darkest_shadow=0.66)
    ).foreground(shaded, EVERYWHERE)
    without = Background(road_image(generator), SETTINGS).foreground(shaded, EVERYWHERE)

    assert np.count_nonzero(with_shadows[30:40, 40:60]) == 0
    assert np.count_nonzero(without[30:40, 40:60]) == 200


def test_what_may_not_be_learned_is_not():
    """A standing box that is guarded stays foreground; an unguarded one is absorbed."""
    generator = np.random.default_rng(5)
    guarded, unguarded = learned(generator), learned(generator)
    guard = EVERYWHERE.copy()
    guard[25:45, 35:65] = 0

    for _ in range(600):
        image = with_box(road_image(generator))
        unguarded.foreground(image, EVERYWHERE)
        guarded.learn(image, guard)
        unguarded.learn(image, EVERYWHERE)

    image = with_box(road_image(generator))
    assert np.count_nonzero(guarded.foreground(image, EVERYWHERE)[30:40, 40:60]) == 200
    assert np.count_nonzero(unguarded.foreground(image, EVERYWHERE)[30:40, 40:60]) == 0


def test_a_ghost_is_told_from_a_vehicle():
    """A box only in the background is a ghost; a box only in the image is none."""
    generator = np.random.default_rng(6)
    empty, box = road_image(generator), with_box(road_image(generator))

    haunted, clean = Background(box, SETTINGS), Background(empty, SETTINGS)
    ghost = find_blobs(haunted.foreground(empty, EVERYWHERE), min_outline=8)
    vehicle = find_blobs(clean.foreground(box, EVERYWHERE), min_outline=8)

    assert haunted.is_ghost(empty, ghost).tolist() == [True]
    assert clean.is_ghost(box, vehicle).tolist() == [False]
    assert len(clean.is_ghost(box, find_blobs(np.zeros_like(EVERYWHERE)))) == 0


def test_what_is_adopted_is_background_at_once():
    """After adopting the image in an area, nothing there is foreground."""
    generator = np.random.default_rng(7)
    background = Background(with_box(road_image(generator)), SETTINGS)
    empty = road_image(generator)

    background.adopt(empty, EVERYWHERE)

    assert np.count_nonzero(background.foreground(empty, EVERYWHERE)) == 0


def test_a_vehicle_of_the_first_image_is_replaced_by_road_and_a_line_is_not():
    """What is broad and unlike the road is filled in; a painted line beside it stays."""
    generator = np.random.default_rng(8)
    image = with_box(road_image(generator))
    image[50:52] = 220
    road = EVERYWHERE.copy()

    standing = find_standing(image, road, SETTINGS, 0.2)
    guessed = guess_empty_road(image, road, standing, SETTINGS, 0.2)

    np.testing.assert_allclose(guessed[30:40, 40:60].mean(), 90.0, atol=3.0)
    assert (guessed[50:52] == 220).all()


def test_without_road_nothing_is_guessed():
    """Where the map has no road the first image stays as it is."""
    image = with_box(road_image(np.random.default_rng(9)))
    nowhere = np.zeros_like(EVERYWHERE)

    standing = find_standing(image, nowhere, SETTINGS, 0.2)

    np.testing.assert_array_equal(guess_empty_road(image, nowhere, standing, SETTINGS, 0.2), image)

"""Lamps drawn and read."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from perception.lamps import LampReader, Lamps, Light, mask_of, without_lamps
from perception.painting import GroundPainter
from perception.pipeline import Pipeline
from perception.rendering import ColourRenderer, ThermalRenderer
from perception.scene import Surroundings
from tests.perception.scenes import CAR, FRAME, camera, road, texture, vehicles

LAMPS = Lamps(
    np.array(
        [
            [[10.0, -6.0], [10.0, -3.0]],
            [[10.0, -3.0], [10.0, 0.0]],
            [[-10.0, 6.0], [-10.0, 3.0]],
            [[900.0, 0.0], [900.0, 3.0]],
        ]
    )
)
VIEW = camera()
LIT = [Light.GREEN, Light.YELLOW, Light.RED, Light.RED_YELLOW]


class Street:
    """A colour camera above a road with lamps."""

    def __init__(self) -> None:
        painter = GroundPainter(road(), Surroundings(), texture())
        generator = np.random.default_rng(3)
        self.colour = ColourRenderer(painter, generator, lamps=LAMPS)
        self.thermal = ThermalRenderer(painter, generator)

    def take(self, lights, rows=()):
        """Return the colour image of vehicles given as rows, with the lamps lit."""
        return self.colour.render(vehicles(rows), VIEW, np.array([*lights, Light.RED]))


STREET = Street()


def read_all(images):
    """Return what is known after each image."""
    reader = LampReader(LAMPS)
    return [reader.read(i * FRAME, image, VIEW) for i, image in enumerate(images)]


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(st.tuples(*[st.sampled_from(LIT)] * 3), min_size=1, max_size=8))
def test_a_light_is_known_when_it_was_seen_twice(shown):
    """Since the first of two images in a row that show it; what is out of sight is never known."""
    known = read_all([STREET.take(lights) for lights in shown])

    for i, lights in enumerate(known):
        found = {
            int(r): (int(x), int(t))
            for r, x, t in zip(lights.rows, lights.light, lights.since, strict=True)
        }
        assert found == naive(shown[: i + 1])
        assert lights.is_seen.all()


def naive(shown):
    """Return light and time of each lamp by looking for the last two equal images in a row."""
    found = {}
    for lamp in range(3):
        history = [lights[lamp] for lights in shown]
        pairs = [i for i in range(1, len(history)) if history[i] == history[i - 1]]
        if pairs:
            light = history[pairs[-1]]
            changes = []
            for i in pairs:
                if not changes or changes[-1][0] != history[i]:
                    changes.append((history[i], i - 1))
            found[lamp] = (int(light), changes[-1][1] * FRAME)
    return found


def test_a_covered_lamp_keeps_its_light():
    """A lorry hides one lamp; the light that comes meanwhile is known when the lorry is gone."""
    lorry = [(1, 10.0, -4.5, 0.0, (8.0, 3.2, 2.0))]
    before, during, after = (Light.GREEN,) * 3, (Light.RED,) * 3, (Light.RED,) * 3
    images = [STREET.take(before)] * 3 + [STREET.take(during, lorry)] * 3
    known = read_all([*images, *[STREET.take(after)] * 3])

    assert known[5].light.tolist() == [Light.GREEN, Light.RED, Light.RED]
    assert known[5].is_seen.tolist() == [False, True, True]
    assert known[8].light.tolist() == [Light.RED] * 3
    assert known[8].since.tolist() == [6 * FRAME, 3 * FRAME, 3 * FRAME]


def test_the_paint_of_a_car_is_no_light():
    """A red car on a lamp that is green does not make it red: what is left of it counts."""
    car = [(2, 10.0, -4.5, 0.0, CAR)]
    known = read_all([STREET.take((Light.GREEN,) * 3, car)] * 3)

    assert known[2].light.tolist() == [Light.GREEN] * 3


def test_dark_lamps_are_not_seen():
    """A lamp that is off looks like road, about which nothing is known."""
    known = read_all([STREET.take((Light.OFF,) * 3)] * 3)

    assert len(known[2].rows) == 0


def test_without_lamps_the_road_is_plain():
    """Where lamps are the image is as grey as was asked for; elsewhere it is as it was."""
    image = STREET.take((Light.RED, Light.GREEN, Light.YELLOW))
    mask = mask_of(LAMPS, VIEW)

    plain = without_lamps(image, mask, (90, 90, 90))

    assert np.ptp(plain[mask != 0].astype(int), axis=1).max() <= 40
    assert np.array_equal(plain[mask == 0], image[mask == 0])


def test_lamps_that_change_are_no_vehicles():
    """Nothing is perceived on an empty road whose lamps change their light."""
    pipeline = Pipeline(road().paved, lamps=LAMPS)
    nobody = vehicles([])
    for frame in range(60):
        lights = [LIT[frame // 10 % 4]] * 3
        colour = STREET.take(lights)
        thermal = STREET.thermal.render(nobody, VIEW)
        percepts = pipeline.perceive(frame * FRAME, colour, thermal, VIEW)
        assert len(percepts) == 0

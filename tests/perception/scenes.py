"""Small scenes to be filmed: a straight road, vehicles on it, a camera above."""

import math
from functools import lru_cache

import numpy as np

from perception.camera import Calibration, Camera
from perception.painting import GroundPainter, make_texture
from perception.rendering import ColourRenderer, ThermalRenderer
from perception.scene import Ground, Surroundings, Vehicles

FRAME = 40_000_000
CAR = (5.0, 1.8, 1.5)
BUS = (12.0, 2.5, 3.4)
PALETTE = np.array(
    [[200, 200, 205], [30, 32, 35], [150, 20, 25], [25, 50, 120], [235, 235, 235]], dtype=np.uint8
)


def road():
    """Return a straight road of two lanes along x, 12 m wide, with a dashed line."""
    outline = np.array([[-90.0, -6.0], [90.0, -6.0], [90.0, 6.0], [-90.0, 6.0]])
    return Ground((outline,), (), (), (np.array([[-90.0, 0.0], [90.0, 0.0]]),))


def camera(pitch=90.0):
    """Return a camera 70 m above the road, with 640 x 360 pixels of 0.2 m."""
    calibration = Calibration.from_field_of_view(width=640, height=360)
    return Camera.looking_at(0.0, 0.0, 70.0, pitch=math.radians(pitch), calibration=calibration)


def vehicles(rows):
    """Return vehicles from rows (id, x, y, heading, (length, width, height))."""
    ids = np.array([row[0] for row in rows], dtype=np.int64)
    place = np.array([row[1:4] for row in rows], dtype=np.float64).reshape(-1, 3)
    size = np.array([row[4] for row in rows], dtype=np.float64).reshape(-1, 3)
    return Vehicles(ids, place[:, :2], place[:, 2], *size.T, PALETTE[ids % len(PALETTE)])


@lru_cache(maxsize=1)
def texture():
    """Return a texture, made once."""
    return make_texture(np.random.default_rng(0))


class Film:
    """Both cameras above the road; renders what it is given."""

    def __init__(self, seed=0, ground=None):
        generator = np.random.default_rng(seed)
        self.ground = ground or road()
        painter = GroundPainter(self.ground, Surroundings(), texture())
        self.colour = ColourRenderer(painter, generator)
        self.thermal = ThermalRenderer(painter, generator)

    def take(self, rows, view):
        """Return the colour and the thermal image of vehicles given as rows."""
        seen = vehicles(rows)
        return self.colour.render(seen, view), self.thermal.render(seen, view)

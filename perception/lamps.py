"""The lamps of traffic lights: bars of light across the lanes, drawn and read.

As in SUMO's own windows, a bar lies across each lane that has a signal, next to the stop line
where a vehicle that waits does not cover it, and shines in the colour of the signal. Where the
bars lie is known from the map and the pose of the camera; what they show is read from the pixels.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from perception.camera import Camera, Points
from perception.painting import Image, fill_areas, fill_quads
from perception.scene import polygons_of

__all__ = ["LampReader", "Lamps", "Light", "Lights", "mask_of", "without_lamps"]

_BEHIND_LINE = 0.4
_THICKNESS = 0.7
_WIDTH_SHARE = 0.88
_FEWEST_PIXELS = 3.0
"""A bar is drawn so thick at least."""

_SAMPLES = 11
_SAME_COLOUR = 55.0
"""Levels by which a pixel of a lamp may differ from its colour; paints differ more."""

_FEWEST_SEEN = 2
_MAJORITY = 0.6
_FRAMES_TO_BELIEVE = 2
_COLOURED = 40
"""Levels between the channels of a pixel that is not as grey as the road."""

_MARGIN = 0.35
_SIGHT_MARGIN_PX = 60.0


class Light(IntEnum):
    """What a lamp shows."""

    OFF = 0
    GREEN = 1
    YELLOW = 2
    RED = 3
    RED_YELLOW = 4


_COLOURS = np.array(
    [[0, 0, 0], [90, 240, 50], [10, 228, 255], [48, 48, 255], [0, 132, 255]], dtype=np.float64
)  # blue, green, red


@dataclass(frozen=True, slots=True, eq=False)
class Lamps:
    """Where lamps are.

    Attributes:
        lines: shape (n, 2, 2), the right and the left end of the stop line of each, as one drives
            towards it, in the world.
    """

    lines: Points

    def __len__(self) -> int:
        return len(self.lines)

    def outlines(self, camera: Camera, margin: float = 0.0) -> Points:
        """Return the corners (n, 4, 2) of the bars on the ground, widened by *margin* metres."""
        right, left = self.lines[:, 0], self.lines[:, 1]
        across = left - right
        length = np.hypot(across[:, 0], across[:, 1])[:, None]
        left_of = across / length
        ahead = np.column_stack([left_of[:, 1], -left_of[:, 0]])
        thick = max(_THICKNESS, _FEWEST_PIXELS * camera.metres_per_pixel()) / 2 + margin
        half = (_WIDTH_SHARE * length / 2 + margin) * left_of
        centre = (right + left) / 2 + _BEHIND_LINE * ahead
        corners = (half + thick * ahead, half - thick * ahead)
        return np.stack(
            [centre + corners[0], centre + corners[1], centre - corners[0], centre - corners[1]],
            axis=1,
        )

    def samples(self, camera: Camera) -> Points:
        """Return the pixels (n, k, 2) along the middle of each bar."""
        corners = self.outlines(camera)
        ends = (corners[:, 0] + corners[:, 1]) / 2, (corners[:, 2] + corners[:, 3]) / 2
        share = np.linspace(0.06, 0.94, _SAMPLES)[None, :, None]
        points = ends[0][:, None] * (1 - share) + ends[1][:, None] * share
        return camera.image_from_ground(points.reshape(-1, 2)).reshape(-1, _SAMPLES, 2)

    def draw(
        self, image: Image, lights: npt.NDArray[np.integer], camera: Camera, lowered: float = 0.0
    ) -> None:
        """Draw the lamps that are lit, in place, with all levels *lowered* by so much."""
        lit = np.flatnonzero(
            (lights != Light.OFF) & camera.sees(self.lines[:, 0], -_SIGHT_MARGIN_PX)
        )
        if len(lit):
            corners = self.outlines(camera)[lit]
            pixels = camera.image_from_ground(corners.reshape(-1, 2)).reshape(-1, 4, 2)
            fill_quads(image, pixels, np.maximum(_COLOURS[lights[lit]] - lowered, 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class Lights:
    """What is known of the lamps whose light has been seen, as columns.

    Attributes:
        rows: shape (n,), which of the lamps.
        light: shape (n,), int8, what it shows, or showed when it was seen last.
        since: shape (n,), nanoseconds, when it was first seen to show this.
        is_seen: shape (n,), whether it is seen now.
    """

    rows: npt.NDArray[np.intp]
    light: npt.NDArray[np.int8]
    since: npt.NDArray[np.int64]
    is_seen: npt.NDArray[np.bool_]


class LampReader:
    """Reads what lamps show, frame by frame.

    The pixels along the middle of a bar vote; those that are none of the colours of a lamp, such
    as those of a vehicle on it, have no vote. A light is believed when it was seen in two images
    one after the other, and dated back to the first. A lamp that is covered, out of the image, or
    dark keeps the light that it had.

    Args:
        lamps: Where they are.
    """

    def __init__(self, lamps: Lamps) -> None:
        n = len(lamps)
        self._lamps = lamps
        self._camera: Camera | None = None
        self._light = np.full(n, Light.OFF, dtype=np.int8)
        self._since = np.zeros(n, dtype=np.int64)
        self._candidate = self._light.copy()
        self._candidate_since = np.zeros(n, dtype=np.int64)
        self._n_seen = np.zeros(n, dtype=np.int64)

    def read(self, time: int, image: Image, camera: Camera) -> Lights:
        """Return what is known of the lamps with the image of *time*, nanoseconds."""
        seen = self._seen(image, camera)
        is_seen = seen != Light.OFF
        is_same = seen == self._candidate
        self._n_seen = np.where(is_seen, np.where(is_same, self._n_seen + 1, 1), self._n_seen)
        self._candidate_since = np.where(is_seen & ~is_same, time, self._candidate_since)
        self._candidate = np.where(is_seen, seen, self._candidate)
        is_new = self._candidate != self._light
        is_new &= self._n_seen >= _FRAMES_TO_BELIEVE
        self._light = np.where(is_new, self._candidate, self._light)
        self._since = np.where(is_new, self._candidate_since, self._since)
        rows = np.flatnonzero(self._light != Light.OFF)
        return Lights(rows, self._light[rows], self._since[rows], is_seen[rows])

    def _seen(self, image: Image, camera: Camera) -> npt.NDArray[np.int8]:
        """Return the light of each lamp in one image, OFF where none is seen."""
        if camera != self._camera:
            self._camera = camera
            self._pixels = np.rint(self._lamps.samples(camera)).astype(np.intp)
        u, v = self._pixels[..., 0], self._pixels[..., 1]
        height, width = image.shape[:2]
        is_inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
        colour = image[v.clip(0, height - 1), u.clip(0, width - 1)].astype(np.float64)
        apart = np.linalg.norm(colour[:, :, None] - _COLOURS[1:], axis=3)
        votes = ((apart < _SAME_COLOUR) & is_inside[:, :, None]).sum(axis=1)
        best = votes.argmax(axis=1)
        count, total = votes.max(axis=1), votes.sum(axis=1)
        is_clear = (count >= _FEWEST_SEEN) & (count >= _MAJORITY * total)
        return np.where(is_clear, best + 1, Light.OFF).astype(np.int8)


def without_lamps(image: Image, mask: Image, plain: Sequence[float]) -> Image:
    """Return a colour image in which the coloured pixels of a mask have a plain colour.

    So lamps that change their light do not look like something that comes and goes on the road.

    Args:
        image: Blue, green, red.
        mask: Not zero where lamps are.
        plain: Blue, green, red of the road.
    """
    rows, columns = np.nonzero(mask)
    pixels = image[rows, columns]
    is_coloured = np.ptp(pixels.astype(np.int16), axis=1) > _COLOURED
    cleared = image.copy()
    cleared[rows[is_coloured], columns[is_coloured]] = np.asarray(plain, dtype=np.uint8)
    return cleared


def mask_of(lamps: Lamps, camera: Camera) -> Image:
    """Return where the image shows bars, with a margin: 255, elsewhere 0."""
    mask = np.zeros((camera.size[1], camera.size[0]), dtype=np.uint8)
    fill_areas(mask, polygons_of(list(lamps.outlines(camera, _MARGIN))), camera, 255)
    return mask

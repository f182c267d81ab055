"""Put blobs on the ground: where the vehicle stands, how large it is, and how sure that is.

What a camera sees of a vehicle is the shadow that a lamp in its place would throw, on the ground,
of a box: the box's base and its roof, which the ray shifts away from the camera, and what lies
between. The shape of this outline is symmetric about the image of the box's middle, so the
outline's centroid is taken for a point half the vehicle's height above the ground.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from perception.blobs import Blobs, outline_moments
from perception.camera import Camera, Points

__all__ = [
    "Sightings",
    "height_from_length",
    "locate",
    "middle_height_from_length",
    "no_sightings",
]

_LENGTHS = np.array([2.5, 4.5, 5.3, 6.5, 12.0, 16.5])
"""Lengths of vehicles at which the figures below hold; between them they change evenly."""

_HEIGHTS = np.array([1.5, 1.5, 1.5, 2.6, 3.4, 4.0])
_MIDDLE_HEIGHTS = np.array([0.5, 0.5, 0.5, 1.15, 1.9, 2.2])
"""Height of the point whose image is the outline's centroid: cars narrow upwards."""

_SHIFT_ALONG = np.array([0.0, 0.4, 0.4, 0.5, 0.75, 0.75])
_SHIFT_ACROSS = np.array([0.5, 0.65, 0.65, 0.75, 0.95, 0.95])
"""How much of the shift of the roof makes the outline longer, and broader."""

_OBLIQUE_RISE = 0.05
"""Metres by which that point rises for each metre that the ray reaches per metre of altitude."""

_HEIGHT_NOISE = 0.15
_FLOOR_NOISE = 0.05
_LEAST_SIDE = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class Sightings:
    """Blobs of one image as vehicles on the ground.

    Attributes:
        position: shape (n, 2), middle of the vehicle, metres, in the world.
        covariance: shape (n, 2, 2), of the position.
        length: shape (n,).
        width: shape (n,).
        angle: shape (n,), direction of the long axis, between -π/2 and π/2.
        area: shape (n,), of the outline on the ground.
        blob: shape (n,), row of the blob.
    """

    position: Points
    covariance: npt.NDArray[np.float64]
    length: npt.NDArray[np.float64]
    width: npt.NDArray[np.float64]
    angle: npt.NDArray[np.float64]
    area: npt.NDArray[np.float64]
    blob: npt.NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.position)


def no_sightings() -> Sightings:
    """Return columns without rows."""
    empty = np.zeros(0)
    nowhere = np.zeros((0, 2)), np.zeros((0, 2, 2))
    return Sightings(*nowhere, empty, empty, empty, empty, np.zeros(0, dtype=np.intp))


def middle_height_from_length(length: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the height of the point of a vehicle whose image is its outline's centroid."""
    return np.asarray(np.interp(length, _LENGTHS, _MIDDLE_HEIGHTS))


def height_from_length(length: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the usual height of a vehicle of some length: car, van, lorry or bus."""
    return np.asarray(np.interp(length, _LENGTHS, _HEIGHTS))


def locate(blobs: Blobs, camera: Camera, *, noise_px: float) -> Sightings:
    """Return where the blobs' vehicles stand and how long and wide they are.

    Args:
        blobs: What is taken for vehicles.
        camera: Where the image was taken.
        noise_px: Deviation of the centroids of outlines, in pixels along each axis.
    """
    if not len(blobs):
        return no_sightings()
    outlines = camera.ground_from_image(blobs.points.astype(np.float64))
    moments = outline_moments(outlines, blobs.starts)
    angle, long_side, short_side = _sides(moments.spread)
    pixels = camera.image_from_ground(moments.centroid)
    slope = camera.ground_per_pixel(pixels)
    along, across = _shift_of_roof(moments.centroid, angle, camera)
    height = height_from_length(long_side)
    shift_along = height * np.interp(long_side, _LENGTHS, _SHIFT_ALONG) * along
    shift_across = height * np.interp(long_side, _LENGTHS, _SHIFT_ACROSS) * across
    length = np.maximum(long_side - shift_along, _LEAST_SIDE)
    width = np.clip(short_side - shift_across, _LEAST_SIDE, length)
    slant = np.hypot(along, across)
    middle = middle_height_from_length(length) + _OBLIQUE_RISE * slant
    position = camera.raise_from_ground(moments.centroid, middle)
    covariance = _covariance(slope * noise_px, position, camera)
    rows = np.arange(len(blobs))
    return Sightings(position, covariance, length, width, angle, moments.area, rows)


def _sides(
    spread: npt.NDArray[np.float64],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return angle and the two sides of the rectangles that have the given spread."""
    xx, xy, yy = spread[:, 0, 0], spread[:, 0, 1], spread[:, 1, 1]
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    middle, half = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    long_side = np.sqrt(12.0 * (middle + half))
    short_side = np.sqrt(12.0 * np.maximum(middle - half, 0.0))
    return angle, long_side, short_side


def _shift_of_roof(
    points: Points, angle: npt.NDArray[np.float64], camera: Camera
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return how far each metre of height reaches over the ground, along and across the axis."""
    shift = (points - np.array(camera.position[:2])) / camera.position[2]
    cos, sin = np.cos(angle), np.sin(angle)
    along = np.abs(shift[:, 0] * cos + shift[:, 1] * sin)
    across = np.abs(shift[:, 1] * cos - shift[:, 0] * sin)
    return along, across


def _covariance(
    slope: npt.NDArray[np.float64], position: Points, camera: Camera
) -> npt.NDArray[np.float64]:
    """Return the covariance of positions from noise in pixels and in the height of vehicles.

    *slope* is how far on the ground one deviation of the noise in pixels reaches.
    """
    towards = (position - np.array(camera.position[:2])) / camera.position[2]
    from_pixels = slope @ slope.transpose(0, 2, 1)
    from_height = _HEIGHT_NOISE**2 * towards[:, :, None] * towards[:, None, :]
    return np.asarray(from_pixels + from_height + _FLOOR_NOISE**2 * np.eye(2))

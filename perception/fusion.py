"""One list of sightings from both cameras, matched on the ground.

As in Heintz (2009), section 8.7.1, pixels of the two cameras are compared by way of the ground,
and the thermal camera is preferred where the two disagree. What only one of them sees is kept.
"""

import numpy as np
import numpy.typing as npt

from perception.camera import Points
from perception.columns import concatenate, select
from perception.locating import Sightings

__all__ = ["fuse", "lies_in"]

_MARGIN = 0.4
_LEAST_SHARE = 0.5
"""A thermal blob with less than this share of the colour blob's area shows only a part of it."""

_LEAST_FILL = 0.75
"""A colour blob that fills less of its rectangle is not a vehicle with a blind thermal spot."""


def fuse(thermal: Sightings, colour: Sightings) -> Sightings:
    """Return the sightings of both cameras without repetition, thermal ones first.

    A colour sighting and a thermal one are the same if the middle of either, or a point half way
    to its front or rear, lies in the other.
    """
    if not len(thermal) or not len(colour):
        return concatenate([thermal, colour])
    same = _reaches_into(colour, thermal) | _reaches_into(thermal, colour).T
    is_alone = (same.sum(axis=0) == 1) & (same.sum(axis=1)[same.argmax(axis=0)] == 1)
    partner = same.argmax(axis=0)
    is_solid = colour.area > _LEAST_FILL * colour.length * colour.width
    partial = is_alone & is_solid[partner]
    partial &= thermal.area < _LEAST_SHARE * colour.area[partner]
    keep_colour = np.asarray(~same.any(axis=1))
    keep_colour[partner[partial]] = True
    return concatenate([select(thermal, ~partial), select(colour, keep_colour)])


def _reaches_into(these: Sightings, others: Sightings) -> npt.NDArray[np.bool_]:
    """Return which of *these* (m) have their middle or a point of their axis in which others."""
    axis = np.column_stack([np.cos(these.angle), np.sin(these.angle)])
    half_way = 0.25 * these.length[:, None] * axis
    middle = these.position
    inside = [lies_in(points, others) for points in (middle, middle + half_way, middle - half_way)]
    return np.asarray(inside[0] | inside[1] | inside[2])


def lies_in(points: Points, sightings: Sightings) -> npt.NDArray[np.bool_]:
    """Return which points (m, 2) lie in which sightings' rectangles: shape (m, n)."""
    offset = points[:, None, :] - sightings.position[None, :, :]
    cos, sin = np.cos(sightings.angle), np.sin(sightings.angle)
    along = np.abs(offset[..., 0] * cos + offset[..., 1] * sin)
    across = np.abs(offset[..., 1] * cos - offset[..., 0] * sin)
    inside = (along < sightings.length / 2 + _MARGIN) & (across < sightings.width / 2 + _MARGIN)
    return np.asarray(inside)

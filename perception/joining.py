"""Join the pieces of a vehicle that one image, or both, show in several blobs.

Where a vehicle has the colour or the warmth of what it covers, a cold car on a painted line for
instance, its blob falls apart. While it is tracked its place and size are known: when none of the
blobs in its footprint is as long as the vehicle, what both cameras show there is one outline.
"""

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from perception.blobs import Blobs
from perception.camera import Camera
from perception.columns import concatenate, select
from perception.fusion import lies_in
from perception.locating import Sightings, locate
from perception.tracking import Tracks, as_sightings

__all__ = ["Outline", "Outlines", "join"]

Outline = npt.NDArray[np.int32]
"""Pixels around a blob, shape (k, 2)."""

Outlines = tuple[Outline, ...]

_HITS_TO_KNOW_SIZE = 8
_LEAST_SHARE = 0.8
"""A blob with less than this share of a vehicle's length is a piece."""

_MOST_SHARE = 1.2
_NOISE_PX = 1.2


def join(
    sightings: Sightings, outlines: Outlines, shown: Sightings, tracks: Tracks, camera: Camera
) -> tuple[Sightings, Outlines]:
    """Return sightings in which pieces of one of *tracks* are replaced by one.

    Args:
        sightings: Fused; `blob` is a row of *outlines*.
        outlines: Pixels of the border of each blob.
        shown: What the cameras show, before fusion.
        tracks: Predicted to the time of the image.
        camera: Where the images were taken.

    Returns:
        The sightings, and the outlines with those of the joined pieces appended.
    """
    known = select(tracks, tracks.hits >= _HITS_TO_KNOW_SIZE)
    if not len(known) or not len(sightings):
        return sightings, outlines
    footprints = as_sightings(known)
    inside = lies_in(sightings.position, footprints)
    longest = np.where(inside, sightings.length[:, None], 0.0).max(axis=0)
    broken = np.flatnonzero((longest > 0.0) & (longest < _LEAST_SHARE * known.length))
    if not len(broken):
        return sightings, outlines
    is_piece = shown.length[:, None] < _MOST_SHARE * known.length
    pieces = lies_in(shown.position, footprints) & is_piece
    hulls = [_hull([outlines[b] for b in shown.blob[pieces[:, row]]]) for row in broken]
    joined = locate(Blobs(tuple(hulls), np.zeros(len(hulls), bool)), camera, noise_px=_NOISE_PX)
    fits = joined.length < _MOST_SHARE * known.length[broken]
    joined.blob[:] += len(outlines)
    replaced = np.count_nonzero(inside[:, broken[fits]], axis=1) > 0
    together = concatenate([select(sightings, ~replaced), select(joined, fits)])
    return together, (*outlines, *hulls)


def _hull(outlines: Sequence[Outline]) -> Outline:
    """Return the corners (k, 2) of the convex hull of several outlines."""
    return np.asarray(cv2.convexHull(np.concatenate(outlines)), dtype=np.int32).reshape(-1, 2)

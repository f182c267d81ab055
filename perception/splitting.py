"""Cut a blob that covers several tracked vehicles into one part for each.

Vehicles that queue or pass one another may grow together in the image. While they are tracked it
is known about where each one is: every pixel of the blob goes to the vehicle in whose footprint
it lies deepest, and each part is located by its own centroid.
"""

import cv2
import numpy as np
import numpy.typing as npt

from perception.camera import Camera, Points
from perception.columns import concatenate, select
from perception.fusion import lies_in
from perception.joining import Outlines
from perception.locating import Sightings, middle_height_from_length
from perception.tracking import Tracks, as_sightings

__all__ = ["split"]

_LEAST_GROWTH = 0.4
"""A blob is cut only if it is larger than its largest vehicle by this share of the others."""

_LONGEST_CAR = 5.7
_WIDEST_CAR = 2.5
"""What is no larger than a car is one, even if its pieces were followed before."""

_LEAST_SHARE = 0.35
"""A part with less than this share of its vehicle's area says nothing: the vehicle is hidden."""

_ROUNDS = 2
_PART_NOISE = 0.25


def split(
    sightings: Sightings, outlines: Outlines, tracks: Tracks, camera: Camera
) -> tuple[Sightings, Outlines, npt.NDArray[np.bool_]]:
    """Return sightings with those that cover several *tracks* cut into parts.

    Args:
        sightings: Where vehicles are seen; `blob` is a row of *outlines*.
        outlines: Pixels of the border of each blob.
        tracks: Those that count, predicted to the time of the image.
        camera: Where the image was taken.

    Returns:
        The sightings, the outlines with those of the parts appended, and which sightings are
        parts.
    """
    merged, members = _find_merged(sightings, tracks)
    kept = np.ones(len(sightings), dtype=bool)
    groups = []
    for row in merged:
        rows = np.flatnonzero(members[:, row])
        outline = outlines[sightings.blob[row]]
        parts, hulls = _cut(outline, select(tracks, rows), camera)
        if len(parts) > 1:
            kept[row] = False
            blob = np.arange(len(outlines), len(outlines) + len(parts))
            groups.append(_as_parts(parts, blob, sightings.covariance[row]))
            outlines = (*outlines, *hulls)
    whole = select(sightings, kept)
    together = concatenate([whole, *groups])
    return together, outlines, np.arange(len(together)) >= len(whole)


def _find_merged(
    sightings: Sightings, tracks: Tracks
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.bool_]]:
    """Return the rows of merged sightings, and which tracks (n, m) lie in which sighting."""
    if len(tracks) < 2 or not len(sightings):  # noqa: PLR2004  (it takes two)
        return np.zeros(0, dtype=np.intp), np.zeros((len(tracks), len(sightings)), dtype=bool)
    expected = as_sightings(tracks)
    inside = lies_in(expected.position, sightings)
    has_own = np.asarray(lies_in(sightings.position, expected).T & ~inside)
    is_single = has_own.any(axis=1, keepdims=True)
    members = np.asarray(inside & ~is_single)
    member_area = np.where(members, expected.area[:, None], 0.0)
    largest, total = member_area.max(axis=0), member_area.sum(axis=0)
    is_larger = sightings.length * sightings.width > largest + _LEAST_GROWTH * (total - largest)
    is_larger &= (sightings.length > _LONGEST_CAR) | (sightings.width > _WIDEST_CAR)
    return np.flatnonzero((members.sum(axis=0) > 1) & is_larger), members


def _cut(
    outline: npt.NDArray[np.int32], tracks: Tracks, camera: Camera
) -> tuple[Sightings, list[npt.NDArray[np.int32]]]:
    """Return the parts of one blob that are large enough, and their outlines."""
    pixels = _pixels_within(outline)
    ground = camera.ground_from_image(pixels.astype(np.float64))
    centres, middle = tracks.states[:, :2], middle_height_from_length(tracks.length)
    owner = np.zeros(len(pixels), dtype=np.intp)
    count = np.zeros(len(tracks), dtype=np.intp)
    for _ in range(_ROUNDS):
        owner = _deepest_footprint(ground, centres, tracks, camera)
        count = np.bincount(owner, minlength=len(tracks))
        sums = [np.bincount(owner, axis, len(tracks)) for axis in ground.T]
        means = np.stack(sums, axis=1) / np.maximum(count, 1)[:, None]
        seen = camera.raise_from_ground(means, middle)
        centres = np.where(count[:, None] > 0, seen, centres)
    area_px = np.abs(np.linalg.det(camera.ground_per_pixel(camera.image_from_ground(centres))))
    large = count * area_px >= _LEAST_SHARE * tracks.length * tracks.width
    parts = as_sightings(tracks)
    parts.position[:] = centres
    chosen = np.flatnonzero(large)
    hulls = [np.asarray(cv2.convexHull(pixels[owner == row]))[:, 0] for row in chosen]
    return select(parts, chosen), hulls


def _pixels_within(outline: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
    """Return the pixels (k, 2) inside an outline and on it."""
    low, high = outline.min(axis=0), outline.max(axis=0) + 1
    mask = np.zeros((high[1] - low[1], high[0] - low[0]), dtype=np.uint8)
    cv2.fillPoly(mask, [outline - low], 255.0)
    rows, columns = np.nonzero(mask)
    return np.asarray(np.column_stack([columns, rows]) + low, dtype=np.int32)


def _deepest_footprint(
    ground: Points, centres: Points, tracks: Tracks, camera: Camera
) -> npt.NDArray[np.intp]:
    """Return for each point under a ray the track in whose rectangle it lies deepest."""
    middle = middle_height_from_length(tracks.length)
    away = camera.position[2] / (camera.position[2] - middle)[:, None]
    below = np.array(camera.position[:2]) + (centres - np.array(camera.position[:2])) * away
    offset = ground[:, None, :] - below[None, :, :]
    cos, sin = np.cos(tracks.heading), np.sin(tracks.heading)
    along = np.abs(offset[..., 0] * cos + offset[..., 1] * sin) - tracks.length / 2
    across = np.abs(offset[..., 1] * cos - offset[..., 0] * sin) - tracks.width / 2
    return np.asarray(np.maximum(along, across).argmin(axis=1))


def _as_parts(
    parts: Sightings, blob: npt.NDArray[np.intp], covariance: npt.NDArray[np.float64]
) -> Sightings:
    """Return parts with the rows of their outlines and a covariance wider than a whole blob's."""
    wider = np.broadcast_to(covariance + _PART_NOISE**2 * np.eye(2), parts.covariance.shape)
    return Sightings(
        parts.position, wider.copy(), parts.length, parts.width, parts.angle, parts.area, blob
    )

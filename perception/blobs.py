"""Connected regions of an image that differ from the background."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from perception.columns import Rows
from perception.painting import Image

__all__ = ["Blobs", "Moments", "find_blobs", "mean_within", "outline_moments", "per_blob_mean"]


@dataclass(frozen=True)
class Blobs:
    """The blobs of one image, each as its outline.

    Attributes:
        outlines: For each blob the pixels of its border in order, shape (k, 2), int32.
        touches_border: shape (n,); part of the blob may lie outside the image.
    """

    outlines: tuple[npt.NDArray[np.int32], ...]
    touches_border: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.outlines)

    def select(self, rows: Rows) -> "Blobs":
        """Return the blobs for which a mask is true, or those with the given positions."""
        (positions,) = np.nonzero(rows) if rows.dtype == np.bool_ else (rows,)
        chosen = tuple(self.outlines[row] for row in positions)
        return Blobs(chosen, self.touches_border[positions])

    @cached_property
    def points(self) -> npt.NDArray[np.int32]:
        """The outlines of all blobs, one after another, shape (m, 2)."""
        return np.concatenate(self.outlines) if self.outlines else np.zeros((0, 2), np.int32)

    @cached_property
    def starts(self) -> npt.NDArray[np.intp]:
        """Where in `points` the outline of each blob begins, shape (n,)."""
        lengths = np.fromiter(map(len, self.outlines), np.intp, len(self.outlines))
        return np.asarray(np.cumsum(lengths) - lengths)

    @cached_property
    def boxes(self) -> npt.NDArray[np.int32]:
        """Left, top, right and lower pixel of each blob, shape (n, 4)."""
        if not len(self):
            return np.zeros((0, 4), np.int32)
        low = np.minimum.reduceat(self.points, self.starts)
        high = np.maximum.reduceat(self.points, self.starts)
        return np.concatenate([low, high], axis=1)

    def meets(self, others: "Blobs") -> npt.NDArray[np.bool_]:
        """Return which blobs have a box in common with any of the blobs of another image."""
        mine, theirs = self.boxes[:, None], others.boxes[None]
        apart = (mine[..., :2] > theirs[..., 2:]) | (theirs[..., :2] > mine[..., 2:])
        is_apart = apart[..., 0] | apart[..., 1]
        return np.asarray(np.count_nonzero(~is_apart, axis=1) > 0)


@dataclass(frozen=True, slots=True)
class Moments:
    """Area, centroid and spread of polygons.

    Attributes:
        area: shape (n,).
        centroid: shape (n, 2).
        spread: shape (n, 2, 2), mean of the squared distances from the centroid.
    """

    area: npt.NDArray[np.float64]
    centroid: npt.NDArray[np.float64]
    spread: npt.NDArray[np.float64]


def find_blobs(
    foreground: Image, *, bridged: int = 1, thinnest: int = 1, min_outline: int = 1
) -> Blobs:
    """Return the connected regions of a mask.

    Args:
        foreground: Not zero where the image differs from the background.
        bridged: Pixels; regions that are less apart than this become one.
        thinnest: Pixels; what is thinner, such as a line on the road, is left out.
        min_outline: Pixels that the border of a region has at least.
    """
    solid = foreground
    if bridged > 1:
        solid = _narrow(_widen(solid, bridged), bridged)
    if thinnest > 1:
        solid = _widen(_narrow(solid, thinnest), thinnest)
    found, _ = cv2.findContours(solid, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    outlines = tuple(
        np.asarray(outline, dtype=np.int32).reshape(-1, 2)
        for outline in found
        if len(outline) >= min_outline
    )
    height, width = foreground.shape
    boxes = Blobs(outlines, np.zeros(len(outlines), dtype=bool)).boxes
    last = np.array([width - 2, height - 2])
    touches = (boxes[:, :2] <= 1) | (boxes[:, 2:] >= last)
    return Blobs(outlines, touches[:, 0] | touches[:, 1])


def _widen(mask: Image, side: int) -> Image:
    kernel = np.ones((side, side), dtype=np.uint8)
    return np.asarray(cv2.dilate(mask, kernel, anchor=(side - 1, side - 1)), dtype=np.uint8)


def _narrow(mask: Image, side: int) -> Image:
    """Undo `_widen`: the opposite anchor keeps even kernels from shifting the mask."""
    kernel = np.ones((side, side), dtype=np.uint8)
    return np.asarray(cv2.erode(mask, kernel, anchor=(0, 0)), dtype=np.uint8)


def outline_moments(points: npt.NDArray[np.float64], starts: npt.NDArray[np.intp]) -> Moments:
    """Return the moments of polygons whose corners (m, 2) stand one after another.

    By Green's theorem, for all polygons at once. A polygon without area has the mean of its
    corners as centroid and no spread.
    """
    lengths = np.diff(np.append(starts, len(points)))
    origin = np.repeat(points[starts], lengths, axis=0)
    x, y = (points - origin).T
    following = np.arange(1, len(points) + 1)
    following[starts + lengths - 1] = starts
    x1, y1 = x[following], y[following]
    cross = x * y1 - x1 * y
    terms = np.stack(
        [
            cross / 2,
            (x + x1) * cross / 6,
            (y + y1) * cross / 6,
            (x * x + x * x1 + x1 * x1) * cross / 12,
            (x * (2 * y + y1) + x1 * (2 * y1 + y)) * cross / 24,
            (y * y + y * y1 + y1 * y1) * cross / 12,
        ]
    )
    area, mx, my, mxx, mxy, myy = np.add.reduceat(terms, starts, axis=1)
    has_area = np.abs(area) > _NO_AREA
    whole = np.where(has_area, area, 1.0)
    corner_mean = np.add.reduceat(np.stack([x, y]), starts, axis=1) / lengths
    cx = np.where(has_area, mx / whole, corner_mean[0])
    cy = np.where(has_area, my / whole, corner_mean[1])
    spread = np.stack(
        [
            mxx / whole - cx * cx,
            mxy / whole - cx * cy,
            mxy / whole - cx * cy,
            myy / whole - cy * cy,
        ],
        axis=-1,
    ).reshape(-1, 2, 2)
    centroid = points[starts] + np.column_stack([cx, cy])
    return Moments(np.abs(area), centroid, np.where(has_area[:, None, None], spread, 0.0))


_NO_AREA = 1e-9


def per_blob_mean(values: npt.NDArray[Any], blobs: Blobs) -> npt.NDArray[np.float64]:
    """Return for each blob the mean of *values*, of which there is one for each of `points`."""
    lengths = np.diff(np.append(blobs.starts, len(values)))
    return np.asarray(np.add.reduceat(values, blobs.starts, dtype=np.float64) / lengths)


def mean_within(
    image: Image, outlines: Sequence[npt.NDArray[np.int32]]
) -> npt.NDArray[np.float32]:
    """Return the mean of the pixels inside each outline: shape (n, channels)."""
    channels = 1 if image.ndim == 2 else image.shape[2]  # noqa: PLR2004  (grey images)
    means = np.zeros((len(outlines), channels), dtype=np.float32)
    for row, outline in enumerate(outlines):
        low, high = outline.min(axis=0), outline.max(axis=0) + 1
        mask = np.zeros((high[1] - low[1], high[0] - low[0]), dtype=np.uint8)
        cv2.fillPoly(mask, [outline - low], 255.0)
        means[row] = cv2.mean(image[low[1] : high[1], low[0] : high[0]], mask=mask)[:channels]
    return means

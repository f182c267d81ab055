"""Smooth curves in the plane, measured along their length."""

from typing import Self

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter1d

__all__ = ["Path"]

Floats = npt.NDArray[np.float64]

_SPACING = 0.25
"""Metres between the points of a path."""

_ROUNDING = 1.5
"""Metres; the width of the bell curve that rounds the corners of a polyline."""

_NOTHING = 1e-6
"""Metres; corners that are closer together are one."""


class Path:
    """A curve through points that lie close together.

    Attributes:
        length: metres.

    Args:
        points: shape (n, 2), n at least 2, metres.
    """

    def __init__(self, points: Floats) -> None:
        steps = np.diff(points, axis=0)
        distance = np.hypot(*steps.T)
        self._points = points
        self._s: Floats = np.concatenate([[0.0], np.cumsum(distance)])
        self._heading: Floats = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
        self._middle: Floats = (self._s[:-1] + self._s[1:]) / 2
        self.length = float(self._s[-1])

    @classmethod
    def along(cls, corners: Floats) -> Self:
        """Return the path along a polyline with its corners rounded; its ends stay."""
        distance = np.hypot(*np.diff(corners, axis=0).T)
        corners = corners[np.concatenate([[True], distance > _NOTHING])]
        s = np.concatenate([[0.0], np.cumsum(distance[distance > _NOTHING])])
        n = max(2, round(float(s[-1]) / _SPACING) + 1)
        even = np.linspace(0.0, s[-1], n)
        points = np.column_stack([np.interp(even, s, column) for column in corners.T])
        spare = min(n - 1, round(4 * _ROUNDING / _SPACING))
        before = 2 * points[0] - points[spare:0:-1]
        after = 2 * points[-1] - points[-2 : -spare - 2 : -1]
        longer = np.concatenate([before, points, after])
        smooth = gaussian_filter1d(longer, _ROUNDING / _SPACING, axis=0, mode="nearest")
        return cls(smooth[spare : spare + n])

    def point(self, s: float, aside: float = 0.0) -> tuple[float, float]:
        """Return x and y at *s* metres along the path, *aside* metres to its left."""
        x, y = (float(np.interp(s, self._s, column)) for column in self._points.T)
        heading = self.heading(s)
        return x - aside * float(np.sin(heading)), y + aside * float(np.cos(heading))

    def heading(self, s: float) -> float:
        """Return the direction at *s*, radians counter-clockwise from east."""
        return float(np.interp(s, self._middle, self._heading))

    def place_of(self, x: float, y: float) -> tuple[float, float]:
        """Return how far along the path a point is, and how far to its left, metres."""
        offset = np.array([x, y]) - self._points
        nearest = int(np.argmin((offset * offset).sum(axis=1)))
        heading = self.heading(float(self._s[nearest]))
        forward = np.array([np.cos(heading), np.sin(heading)])
        along, left = (
            offset[nearest] @ forward,
            forward @ [offset[nearest][1], -offset[nearest][0]],
        )
        return float(self._s[nearest] + along), float(left)

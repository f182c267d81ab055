"""Angles and polylines: projection of many points, each onto its own polyline, at once.

All polylines of a map lie behind one another in flat arrays of segments, so that the work for a
whole frame of points is a handful of numpy operations. Positions along a polyline are metres
from its start (`s`), offsets are metres to its left (`d`).
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

__all__ = [
    "Floats",
    "Indices",
    "Points",
    "Polylines",
    "first_least",
    "group_ranges",
    "has_length",
    "middle_line",
    "offset_line",
    "resampled",
    "without_repetitions",
    "wrapped_angle",
]

Floats = npt.NDArray[np.float64]
Points = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]

_SAME_POINT = 1e-4
"""Points of a line closer than this, in metres, are one."""


def wrapped_angle(angle: npt.ArrayLike) -> Floats:
    """Return *angle*, in radians, brought into (-π, π]."""
    turned = np.asarray(angle, dtype=np.float64)
    return np.asarray(np.pi - np.mod(np.pi - turned, 2 * np.pi))


def group_ranges(
    starts: npt.NDArray[np.intp], counts: npt.NDArray[np.intp]
) -> npt.NDArray[np.intp]:
    """Return the numbers of the ranges `starts[i] : starts[i] + counts[i]`, one after another."""
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    return np.arange(total) - np.repeat(ends - counts - starts, counts)


def first_least(values: Floats, group: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Return, group by group, where the first of its least values stands.

    Args:
        values: shape (n,), what is compared.
        group: shape (n,), the number of each value's group, never falling.
    """
    if not len(values):
        return np.empty(0, dtype=np.intp)
    starts = np.flatnonzero(np.concatenate(([True], group[1:] != group[:-1])))
    counts = np.diff(starts, append=len(values))
    least = np.repeat(np.minimum.reduceat(values, starts), counts)
    (candidates,) = np.nonzero(values == least)
    return candidates[np.searchsorted(candidates, starts)]


def has_length(line: Points) -> bool:
    """Tell whether *line* has two different points."""
    return bool(np.any(np.hypot(*np.diff(line, axis=0).T) > _SAME_POINT))


def without_repetitions(line: Points) -> Points:
    """Return *line* without points that repeat the one before; at least two points remain."""
    if not has_length(line):
        raise ValueError("a line needs two different points")
    steps = np.hypot(*np.diff(line, axis=0).T)
    return line[np.concatenate(([True], steps > _SAME_POINT))]


def resampled(line: Points, fractions: Floats) -> Points:
    """Return the points of *line* at *fractions* of its length."""
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    wanted = fractions * along[-1]
    return np.column_stack([np.interp(wanted, along, line[:, axis]) for axis in (0, 1)])


def middle_line(first: Points, second: Points) -> Points:
    """Return the line midway between two lines that run side by side."""
    fractions = np.unique(np.round([*_fractions(first), *_fractions(second)], 9))
    return (resampled(first, fractions) + resampled(second, fractions)) / 2


def offset_line(line: Points, distance: float) -> Points:
    """Return *line* moved to its left by *distance*; corners are mitred, at most twofold."""
    steps = np.diff(line, axis=0)
    directions = steps / np.hypot(*steps.T)[:, None]
    normals = np.column_stack([-directions[:, 1], directions[:, 0]])
    before = np.vstack([normals[:1], normals])
    after = np.vstack([normals, normals[-1:]])
    mean = before + after
    stretch = np.maximum(np.sum(mean * mean, axis=1), 1.0) / 2
    moved: Points = line + distance * mean / stretch[:, None]
    return moved


class Polylines:
    """Many polylines, in flat arrays of segments.

    Attributes:
        lengths: shape (p,), metres.
        first_segment: shape (p + 1,); polyline i has the segments from `first_segment[i]` up to
            but not including `first_segment[i + 1]`.
        start: shape (q, 2), where each segment starts, metres.
        direction: shape (q, 2), the unit vector along each segment.
        segment_length: shape (q,), metres.
        station: shape (q,), position along its polyline at which each segment starts, metres.
    """

    __slots__ = (
        "_search_base",
        "_search_keys",
        "direction",
        "first_segment",
        "lengths",
        "segment_length",
        "start",
        "station",
    )

    def __init__(self, lines: Sequence[Points]) -> None:
        clean = [without_repetitions(np.asarray(line, dtype=np.float64)) for line in lines]
        counts = np.array([len(line) - 1 for line in clean], dtype=np.intp)
        self.first_segment = np.concatenate(([0], np.cumsum(counts)))
        self.start = _stacked([line[:-1] for line in clean])
        steps = _stacked([np.diff(line, axis=0) for line in clean])
        self.segment_length = np.hypot(steps[:, 0], steps[:, 1])
        self.direction = steps / self.segment_length[:, None]
        travelled = np.concatenate(([0.0], np.cumsum(self.segment_length)))
        self.station = travelled[:-1] - np.repeat(travelled[self.first_segment[:-1]], counts)
        self.lengths = np.diff(travelled[self.first_segment])
        # One metre between polylines keeps the search keys of their ends apart.
        self._search_base = travelled[self.first_segment[:-1]] + np.arange(len(counts))
        self._search_keys = np.repeat(self._search_base, counts) + self.station

    def __len__(self) -> int:
        return len(self.lengths)

    def line(self, index: int) -> Points:
        """Return the corners of one polyline, shape (k, 2)."""
        at = slice(self.first_segment[index], self.first_segment[index + 1])
        end = self.start[at][-1] + self.direction[at][-1] * self.segment_length[at][-1]
        return np.vstack([self.start[at], end])

    def project(self, points: Points, index: npt.NDArray[np.integer]) -> tuple[Floats, Floats]:
        """Return position along and offset to the left, each point on its own polyline.

        The nearest place of the polyline counts. Before the start and behind the end the
        polyline goes on straight: there `s` is negative or greater than the length.

        Args:
            points: shape (n, 2), metres.
            index: shape (n,), the polyline of each point.
        """
        first = self.first_segment[index]
        counts = self.first_segment[np.asarray(index) + 1] - first
        segment = group_ranges(first, counts)
        point = np.repeat(np.arange(len(points)), counts)
        squared = self.squared_distance(points[point], segment)
        nearest = segment[first_least(squared, point)]
        return self._straight(points, index, nearest)

    def distance(self, points: Points, index: npt.NDArray[np.integer]) -> Floats:
        """Return the distance of each point from its own polyline, which ends where it ends."""
        s, d = self.project(points, index)
        beyond = np.maximum(np.maximum(-s, s - self.lengths[index]), 0.0)
        return np.asarray(np.hypot(beyond, d))

    def at(self, index: npt.NDArray[np.integer], s: Floats, d: npt.ArrayLike = 0.0) -> Points:
        """Return the points at *s* along and *d* to the left of the polylines *index*."""
        segment = self._segment_at(index, s)
        along = self.direction[segment]
        left = np.column_stack([-along[:, 1], along[:, 0]])
        offset = np.broadcast_to(np.asarray(d, dtype=np.float64), s.shape)
        travelled = (s - self.station[segment])[:, None] * along
        return np.asarray(self.start[segment] + travelled + offset[:, None] * left)

    def heading_at(self, index: npt.NDArray[np.integer], s: Floats) -> Floats:
        """Return the headings of the polylines *index* at *s*, counter-clockwise from east."""
        along = self.direction[self._segment_at(index, s)]
        return np.asarray(np.arctan2(along[:, 1], along[:, 0]))

    def segments(self) -> tuple[Points, npt.NDArray[np.intp]]:
        """Return the two ends of every segment, shape (q, 2, 2), and the polyline of each."""
        ends = self.start + self.direction * self.segment_length[:, None]
        owner = np.repeat(np.arange(len(self)), np.diff(self.first_segment))
        return np.stack([self.start, ends], axis=1), owner

    def squared_distance(self, points: Points, segment: npt.NDArray[np.intp]) -> Floats:
        """Return the squared distance of each point from its own segment, square metres."""
        offset = points - self.start[segment]
        along = self.direction[segment]
        t = offset[:, 0] * along[:, 0] + offset[:, 1] * along[:, 1]
        np.clip(t, 0.0, self.segment_length[segment], out=t)
        x = offset[:, 0] - t * along[:, 0]
        y = offset[:, 1] - t * along[:, 1]
        return np.asarray(x * x + y * y)

    def _straight(
        self, points: Points, index: npt.NDArray[np.integer], segment: npt.NDArray[np.intp]
    ) -> tuple[Floats, Floats]:
        offset = points - self.start[segment]
        along = self.direction[segment]
        t = offset[:, 0] * along[:, 0] + offset[:, 1] * along[:, 1]
        d = along[:, 0] * offset[:, 1] - along[:, 1] * offset[:, 0]
        is_first = segment == self.first_segment[index]
        is_last = segment == self.first_segment[np.asarray(index) + 1] - 1
        length = self.segment_length[segment]
        within = np.clip(t, np.where(is_first, -np.inf, 0.0), np.where(is_last, np.inf, length))
        # At an outer corner the distance counts, not the offset from one of the two segments.
        d = np.copysign(np.hypot(d, t - within), d)
        return self.station[segment] + within, d

    def _segment_at(self, index: npt.NDArray[np.integer], s: Floats) -> npt.NDArray[np.intp]:
        wanted = self._search_base[index] + np.clip(s, 0.0, self.lengths[index])
        found = np.searchsorted(self._search_keys, wanted, side="right") - 1
        last = self.first_segment[np.asarray(index) + 1] - 1
        return np.asarray(np.clip(found, self.first_segment[index], last))


def _fractions(line: Points) -> Floats:
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    return np.asarray(along / along[-1])


def _stacked(parts: Sequence[Points]) -> Points:
    return np.vstack(parts) if parts else np.empty((0, 2))

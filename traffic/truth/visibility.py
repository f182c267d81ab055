"""Who was inside the ground that a camera sees, and when."""

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt
import shapely

from dyknow.streams.table import Ids
from dyknow.time import TimePoint

__all__ = ["Span", "Visibility", "inside"]

Points = npt.NDArray[np.float64]

_NEVER, _FOREVER = -(1 << 62), 1 << 62

Span = tuple[int, int]
"""The first and the last of the frames in a row, by their times."""


def inside(points: Points, footprint: Points | None) -> npt.NDArray[np.bool_]:
    """Return which *points*, shape (n, 2), lie in the polygon *footprint*, shape (k, 2).

    Without a footprint all of them do.
    """
    if footprint is None:
        return np.ones(len(points), dtype=np.bool_)
    polygon = shapely.Polygon(footprint)
    shapely.prepare(polygon)
    within: npt.NDArray[np.bool_] = shapely.contains_xy(polygon, points[:, 0], points[:, 1])
    return within


class Visibility:
    """Remembers when each vehicle was in view, in spans without a break.

    A vehicle that is in no frame is not in view.
    """

    def __init__(self) -> None:
        self._frame = 0
        self._since = np.empty(0, dtype=np.int64)
        self._until = np.empty(0, dtype=np.int64)
        self._last = np.empty(0, dtype=np.int64)
        self._earlier: dict[int, list[Span]] = {}

    def observe(self, time: TimePoint, ids: Ids, *, in_view: npt.NDArray[np.bool_]) -> None:
        """Take in which vehicles of a frame are in view."""
        self._frame += 1
        self._make_room(ids)
        seen = ids[in_view]
        back = seen[self._last[seen] != self._frame - 1]
        for vehicle in back[self._last[back] > 0].tolist():
            self._earlier.setdefault(vehicle, []).append(self._latest(vehicle))
        self._since[back] = time
        self._until[seen] = time
        self._last[seen] = self._frame

    def spans(self, vehicle: int) -> list[Span]:
        """Return the first and the last time of each span in which the vehicle was in view."""
        if vehicle >= len(self._last) or self._last[vehicle] == 0:
            return []
        return [*self._earlier.get(vehicle, ()), self._latest(vehicle)]

    def common_spans(self, vehicles: Iterable[int]) -> list[Span]:
        """Return the spans in which all of the vehicles were in view."""
        common = [(_NEVER, _FOREVER)]
        for vehicle in vehicles:
            common = [
                (max(begin, first), min(end, last))
                for begin, end in common
                for first, last in self.spans(vehicle)
                if max(begin, first) <= min(end, last)
            ]
        return common

    def _latest(self, vehicle: int) -> Span:
        return int(self._since[vehicle]), int(self._until[vehicle])

    def _make_room(self, ids: Ids) -> None:
        missing = int(ids.max(initial=-1)) + 1 - len(self._last)
        if missing > 0:
            room = np.zeros(missing + 64, dtype=np.int64)
            self._since = np.append(self._since, room)
            self._until = np.append(self._until, room)
            self._last = np.append(self._last, room)

"""Who was inside the ground that a camera sees, and since when."""

import numpy as np
import numpy.typing as npt
import shapely

from dyknow.streams.table import Ids
from dyknow.time import TimePoint

__all__ = ["Visibility", "inside"]

Points = npt.NDArray[np.float64]

_NEVER = -(1 << 62)


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
    """Remembers since when each vehicle has been in view without a break.

    A vehicle that is in no frame is not in view.
    """

    def __init__(self) -> None:
        self._frame = 0
        self._since = np.empty(0, dtype=np.int64)
        self._last = np.empty(0, dtype=np.int64)

    def observe(self, time: TimePoint, ids: Ids, *, in_view: npt.NDArray[np.bool_]) -> None:
        """Take in which vehicles of a frame are in view."""
        self._frame += 1
        self._make_room(ids)
        seen = ids[in_view]
        began = self._last[seen] != self._frame - 1
        self._since[seen] = np.where(began, time, self._since[seen])
        self._last[seen] = self._frame

    def since(self, vehicle: int) -> int | None:
        """Return when the vehicle came into view, or None if it is not in view now."""
        if vehicle >= len(self._last) or self._last[vehicle] != self._frame:
            return None
        return int(self._since[vehicle])

    def _make_room(self, ids: Ids) -> None:
        missing = int(ids.max(initial=-1)) + 1 - len(self._last)
        if missing > 0:
            self._since = np.append(self._since, np.full(missing + 64, _NEVER))
            self._last = np.append(self._last, np.full(missing + 64, _NEVER))

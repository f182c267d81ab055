"""The map of a run as outlines that a page draws: metres, x to the east and y to the south."""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from networks.markings import MarkingKind
from networks.roads import RoadMap
from perception.camera import Camera

__all__ = ["Box", "drawn_map"]

_AROUND = 60.0
"""What lies farther from all objects and from the ground in view is left out, metres."""

_DASHED = (MarkingKind.LANE, MarkingKind.CENTRE_DASHED)

Points = npt.NDArray[np.float64]
Box = tuple[float, float, float, float]
"""The smallest x and y, and the greatest x and y, metres, in the world."""


def drawn_map(road_map: RoadMap, camera: Camera | None, reached: Box | None) -> dict[str, Any]:
    """Return what a page draws of a map.

    Args:
        road_map: The map.
        camera: Whose ground in view is outlined, if there is one.
        reached: What the tracks reach; None without tracks.
    """
    view = None if camera is None else camera.footprint()
    shown = _shown(road_map, view, reached)
    lines = [(m.kind in _DASHED, m.points) for m in road_map.markings]
    signals = road_map.signals
    centres = [road_map.crossing_centre(at) for at in range(len(road_map.crossings))]
    return {
        "box": _screen_box(_first_seen(road_map, view, reached)),
        "roads": _path(_near(road_map.road_polygons(), shown), closed=True),
        "crossings": _path(_near(road_map.crossing_polygons(), shown), closed=True),
        "solid": _path(_near((each for dashed, each in lines if not dashed), shown)),
        "dashed": _path(_near((each for dashed, each in lines if dashed), shown)),
        "buildings": _path(_near(road_map.surroundings.outlines(), shown), closed=True),
        "signals": [
            {"name": name, "line": _path([line])}
            for name, line in zip(signals.names, signals.lines, strict=True)
        ],
        "names": [
            {"name": name, "x": _short(centre[0]), "y": _short(-centre[1])}
            for name, centre in zip(road_map.crossings, centres, strict=True)
            if _is_near(np.array([centre]), shown)
        ],
        "view": None if view is None else _path([view], closed=True),
    }


def _first_seen(road_map: RoadMap, view: Points | None, reached: Box | None) -> Box:
    """Return the box that a page shows at first: the ground in view, or else all tracks."""
    if view is None:
        return road_map.bounds if reached is None else reached
    (left, bottom), (right, top) = view.min(axis=0).tolist(), view.max(axis=0).tolist()
    return left, bottom, right, top


def _shown(road_map: RoadMap, view: Points | None, reached: Box | None) -> Box:
    """Return the box around tracks and view that the map is drawn in."""
    if reached is None:
        return road_map.bounds
    corners = np.array(reached).reshape(2, 2)
    if view is not None:
        corners = np.concatenate([corners, view])
    low, high = corners.min(axis=0) - _AROUND, corners.max(axis=0) + _AROUND
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _near(lines: Iterable[Points], box: Box) -> Iterator[Points]:
    return (each for each in lines if _is_near(each, box))


def _is_near(points: Points, box: Box) -> bool:
    """Return whether the bounds of some points overlap *box*."""
    low, high = points.min(axis=0), points.max(axis=0)
    return bool((low <= box[2:]).all() and (high >= box[:2]).all())


def _path(lines: Iterable[Points], *, closed: bool = False) -> str:
    """Return lines as the data of an SVG path."""
    return "".join(_line(points) + ("Z" if closed else "") for points in lines)


def _line(points: Points) -> str:
    corners = [f"{_short(x)} {_short(-y)}" for x, y in points[:, :2].tolist()]
    return f"M{'L'.join(corners)}"


def _screen_box(box: Box) -> list[float]:
    """Return a box as left, top, width and height on a screen."""
    left, bottom, right, top = box
    return [_short(left), _short(-top), _short(right - left), _short(top - bottom)]


def _short(number: float) -> float:
    """Return a number to the decimetre, without a sign if it is none."""
    return round(float(number), 1) + 0.0

"""Draws the frames of a picture: cut-outs of images, or of the map if there was no camera."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from dyknow.time import MILLISECOND, SECOND
from networks.markings import MarkingKind
from networks.roads import RoadMap
from perception.camera import Camera
from traffic.explaining.drawing import draw_box, draw_name, draw_trail, instants_text, seconds_text
from traffic.explaining.explanation import Frame
from traffic.explaining.images import Image
from traffic.explaining.objects import Objects, corners_of

__all__ = ["Look", "Window", "draw_image", "draw_map", "windows_of"]

_TRAIL = 5 * SECOND
_ASPECT = 4 / 3
_LEAST_PIXELS = 230.0
_MOST_FIXED_PIXELS = 430.0
_LEAST_METRES = 42.0
_MOST_FIXED_METRES = 90.0
_MARGIN = 1.35

_LAND = "#dfe7d8"
_ROAD = "#8d949d"
_CROSSING = "#979ea7"
_PAINT = "#f3f5f7"
_OTHER = "#e9ecef"
_OTHER_EDGE = "#5b6470"
_EDGE = "#10151c"

Points = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Window:
    """What a frame shows: its middle and its width, pixels of the image or metres of the map."""

    x: float
    y: float
    width: float

    @property
    def height(self) -> float:
        """Its height."""
        return self.width / _ASPECT


def windows_of(frames: Sequence[Frame], camera: Camera | None) -> list[Window]:
    """Return what each frame shows: all the same place if it is not too large, at one scale."""
    points = [_points(frame, has_camera=camera is not None) for frame in frames]
    least = _LEAST_METRES if camera is None else _LEAST_PIXELS
    most = _MOST_FIXED_METRES if camera is None else _MOST_FIXED_PIXELS
    everything = np.concatenate(points)
    fixed = _width(everything, least)
    if fixed <= most:
        x, y = _middle(everything)
        return [_inside(Window(x, y, fixed), camera) for _ in frames]
    width = max(_width(of, least) for of in points)
    return [_inside(Window(*_middle(of), width), camera) for of in points]


def draw_image(axes: Axes, frame: Frame, image: Image, window: Window, look: "Look") -> None:
    """Draw a cut-out of *image* with the objects marked."""
    shown = image[..., ::-1] if image.ndim == 3 else image  # noqa: PLR2004, colour has three axes
    axes.imshow(shown, cmap="gray", vmin=0, vmax=255, interpolation="lanczos")
    _frame(axes, window, is_image=True)
    assert look.camera is not None  # there is no image without a camera
    for seen in frame.seen:
        track = look.camera.image_from_ground(_track(look.objects, seen.symbol, frame.time))
        draw_trail(axes, track, look.colours[seen.symbol])
    lowest = _lowest(frame, has_camera=True)
    for seen in frame.seen:
        is_below = seen.symbol == lowest
        draw_box(axes, seen, seen.box, look.colours[seen.symbol], is_below=is_below)
    _title(axes, frame)


def draw_map(axes: Axes, frame: Frame, window: Window, look: "Look") -> None:
    """Draw a cut-out of the map with all cars, and the objects marked."""
    axes.set_facecolor(_LAND)
    _frame(axes, window, is_image=False)
    _draw_roads(axes, look.road_map, window)
    known = {seen.symbol for seen in frame.seen}
    for symbol, corners in look.objects.outlines_at(round(frame.time * MILLISECOND)):
        if symbol not in known:
            axes.fill(*corners.T, facecolor=_OTHER, edgecolor=_OTHER_EDGE, lw=0.8, zorder=4)
    for seen in frame.seen:
        draw_trail(axes, _track(look.objects, seen.symbol, frame.time), look.colours[seen.symbol])
    lowest = _lowest(frame, has_camera=False)
    for seen in frame.seen:
        state = look.objects.state_at(seen.symbol, round(frame.time * MILLISECOND))
        if state is not None:
            x, y, heading = float(state["x"]), float(state["y"]), float(state["heading"])
            corners = corners_of(x, y, heading, *seen.size)
            colour = look.colours[seen.symbol]
            style = "-" if seen.percept is not None else (0, (2, 1.5))
            axes.fill(*corners.T, facecolor=colour, edgecolor=_EDGE, lw=1, ls=style, zorder=6)
            name = seen.symbol if seen.percept is not None else f"{seen.symbol} (predicted)"
            draw_name(axes, name, corners, colour, is_below=seen.symbol == lowest)
        if seen.percept is not None:
            axes.plot(*seen.position, marker="+", ms=7, mew=1.4, color=_EDGE, zorder=9)
    _title(axes, frame)


@dataclass(frozen=True, slots=True)
class Look:
    """What all frames of a strip share.

    Attributes:
        objects: The objects of the run.
        colours: Of those that take part.
        road_map: The map.
        camera: Where the images were taken from; None if there are none.
    """

    objects: Objects
    colours: Mapping[str, str]
    road_map: RoadMap
    camera: Camera | None


def _lowest(frame: Frame, *, has_camera: bool) -> str | None:
    """Return the object that is drawn lowest, if there are several: its name goes below it."""
    rows = {
        seen.symbol: seen.pixel[1] if has_camera and seen.pixel else -seen.position[1]
        for seen in frame.seen
    }
    return max(rows, key=lambda symbol: rows[symbol]) if len(rows) > 1 else None


def _points(frame: Frame, *, has_camera: bool) -> Points:
    found = [seen.pixel if has_camera else seen.position for seen in frame.seen]
    return np.array([each for each in found if each is not None], dtype=np.float64).reshape(-1, 2)


def _middle(points: Points) -> tuple[float, float]:
    x, y = (points.min(axis=0) + points.max(axis=0)) / 2
    return float(x), float(y)


def _width(points: Points, least: float) -> float:
    across, along = np.ptp(points, axis=0)
    return max(least, float(max(across, along * _ASPECT)) * _MARGIN + least / 3)


def _inside(window: Window, camera: Camera | None) -> Window:
    """Return a window of the same size that does not reach beyond the image."""
    if camera is None:
        return window
    width, height = camera.size
    size = min(window.width, width, height * _ASPECT)
    x = float(np.clip(window.x, size / 2, width - size / 2))
    y = float(np.clip(window.y, size / _ASPECT / 2, height - size / _ASPECT / 2))
    return Window(x, y, size)


def _frame(axes: Axes, window: Window, *, is_image: bool) -> None:
    low, high = window.y - window.height / 2, window.y + window.height / 2
    axes.set_xlim(window.x - window.width / 2, window.x + window.width / 2)
    axes.set_ylim((high, low) if is_image else (low, high))
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])


def _title(axes: Axes, frame: Frame) -> None:
    names = instants_text(frame.instants)
    time = seconds_text(frame.time)
    axes.set_title(f"{names}   {time}" if names else time, fontsize=10, fontweight="bold", pad=4)


def _track(objects: Objects, symbol: str, time: float) -> Points:
    until = round(time * MILLISECOND)
    states = objects.states(symbol)
    inside = (states["valid_time"] <= until) & (states["valid_time"] >= until - _TRAIL)
    return states.loc[inside, ["x", "y"]].to_numpy(np.float64)


def _draw_roads(axes: Axes, road_map: RoadMap, window: Window) -> None:
    roads = PolyCollection(road_map.road_polygons(), facecolor=_ROAD, edgecolor="none", zorder=1)
    axes.add_collection(roads)
    crossings = road_map.crossing_polygons()
    axes.add_collection(
        PolyCollection(crossings, facecolor=_CROSSING, edgecolor="none", zorder=1.5)
    )
    dashed = (MarkingKind.LANE, MarkingKind.CENTRE_DASHED)
    for is_dashed in (False, True):
        lines = [m.points for m in road_map.markings if (m.kind in dashed) == is_dashed]
        style = (0, (6, 6)) if is_dashed else "-"
        axes.add_collection(
            LineCollection(lines, colors=_PAINT, linewidths=1.0, linestyles=[style], zorder=2)
        )
    length = 10.0 ** np.floor(np.log10(window.width / 3))
    right, low = window.x + window.width / 2, window.y - window.height / 2
    inset = window.width * 0.04
    ends = [right - inset - length, right - inset]
    axes.plot(ends, [low + inset] * 2, color=_EDGE, lw=2, zorder=9)
    axes.text(
        sum(ends) / 2,
        low + inset * 1.4,
        f"{length:g} m",
        ha="center",
        va="bottom",
        fontsize=7.5,
        zorder=9,
    )

"""Draw what the system believes onto what the cameras see, and write it as a film.

Everything comes as plain values in pixels; whoever calls knows what it means.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

import cv2
import numpy as np
import numpy.typing as npt

from perception.camera import Points
from perception.errors import PerceptionError
from perception.painting import Image

__all__ = ["FilmError", "FilmWriter", "Mark", "Trail", "draw_overlay", "jpeg_from", "side_by_side"]

Colour = tuple[int, int, int]
"""Red, green, blue."""

_FONT = cv2.FONT_HERSHEY_SIMPLEX
_LABEL_SCALE = 0.42
_CAPTION_SCALE = 0.5
_CAPTION_LINE = 20
_CAPTION_MARGIN = 10


class FilmError(PerceptionError):
    """A film cannot be written."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"cannot write a film to '{path}'")
        self.path = path


@dataclass(frozen=True, slots=True, eq=False)
class Mark:
    """A labelled polygon around one thing.

    Attributes:
        label: What is written beside it.
        outline: shape (k, 2), pixels.
        colour: Red, green, blue.
    """

    label: str
    outline: Points
    colour: Colour


@dataclass(frozen=True, slots=True, eq=False)
class Trail:
    """Where something has been, as a line.

    Attributes:
        points: shape (k, 2), pixels, oldest first.
        colour: Red, green, blue.
    """

    points: Points
    colour: Colour


def draw_overlay(
    image: Image, marks: Sequence[Mark], trails: Sequence[Trail], captions: Sequence[str]
) -> Image:
    """Return a colour image with trails, marks and captions drawn over *image*.

    Args:
        image: shape (h, w) or (h, w, 3), blue, green, red; left as it is.
        marks: Drawn over the trails; points that are NaN are left out.
        trails: Older ends are fainter.
        captions: Lines at the lower left corner, the last one lowest.
    """
    canvas = _in_colour(image)
    for trail in trails:
        _draw_trail(canvas, trail)
    for mark in marks:
        _draw_mark(canvas, mark)
    _draw_captions(canvas, captions)
    return canvas


def side_by_side(left: Image, right: Image) -> Image:
    """Return two images of equal height in one, grey ones as colour."""
    return np.concatenate([_in_colour(left), _in_colour(right)], axis=1)


def jpeg_from(image: Image, quality: int) -> bytes:
    """Return *image* as a JPEG file, which loses what the eye misses least.

    Args:
        image: shape (h, w) or (h, w, 3), blue, green, red.
        quality: From 1 to 100.
    """
    _, data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes()


class FilmWriter:
    """Writes frames of one size to an MP4 file; a context manager.

    Raises:
        FilmError: The file cannot be opened for writing.
    """

    def __init__(self, path: Path, size: tuple[int, int], *, frames_per_second: float) -> None:
        """Begin the film *path* of frames of *size* (width, height)."""
        self._size = size
        codec = cv2.VideoWriter.fourcc(*"mp4v")
        self._writer = cv2.VideoWriter(str(path), codec, frames_per_second, size)
        if not self._writer.isOpened():
            raise FilmError(path)

    def write(self, frame: Image) -> None:
        """Add one frame, shrunk to the size of the film if it is larger."""
        if (frame.shape[1], frame.shape[0]) != self._size:
            shrunk = cv2.resize(frame, self._size, interpolation=cv2.INTER_AREA)
            frame = np.asarray(shrunk, dtype=np.uint8)
        self._writer.write(frame)

    def close(self) -> None:
        """Finish the file."""
        self._writer.release()

    def __enter__(self) -> "FilmWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _in_colour(image: Image) -> Image:
    """Return a copy with three channels."""
    if image.ndim == 3:  # noqa: PLR2004  (colour images have three axes)
        return image.copy()
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_GRAY2BGR), dtype=np.uint8)


def _draw_trail(canvas: Image, trail: Trail) -> None:
    points = trail.points[~np.isnan(trail.points).any(axis=1)]
    corners = np.rint(points * 16.0).astype(np.int32).reshape(-1, 2)
    half = len(corners) // 2
    faint = tuple(0.55 * c for c in trail.colour[::-1])
    _draw_line(canvas, corners[: half + 1], faint, closed=False)
    _draw_line(canvas, corners[half:], trail.colour[::-1], closed=False)


def _draw_line(
    canvas: Image, corners: npt.NDArray[np.int32], colour: Sequence[float], *, closed: bool
) -> None:
    """Draw a thin line through corners in sixteenths of a pixel."""
    cv2.polylines(
        canvas,
        [corners],
        isClosed=closed,
        color=colour,
        thickness=1,
        lineType=cv2.LINE_AA,
        shift=4,
    )


def _draw_mark(canvas: Image, mark: Mark) -> None:
    outline = mark.outline[~np.isnan(mark.outline).any(axis=1)]
    if not len(outline):
        return
    colour = mark.colour[::-1]
    corners = np.rint(outline * 16.0).astype(np.int32)
    _draw_line(canvas, corners, colour, closed=True)
    right, top = outline[:, 0].max(), outline[:, 1].min()
    place = (int(right) + 3, int(top) - 2)
    cv2.putText(canvas, mark.label, place, _FONT, _LABEL_SCALE, (0, 0, 0), 2, cv2.LINE_AA)
    cv2.putText(canvas, mark.label, place, _FONT, _LABEL_SCALE, colour, 1, cv2.LINE_AA)


def _draw_captions(canvas: Image, captions: Sequence[str]) -> None:
    """Write lines on a darkened band at the lower edge."""
    if not captions:
        return
    height = canvas.shape[0]
    top = max(0, height - _CAPTION_LINE * len(captions) - 2 * _CAPTION_MARGIN)
    band = canvas[top:]
    band[:] = (band * 0.45).astype(np.uint8)
    for row, caption in enumerate(captions):
        low = top + _CAPTION_MARGIN + _CAPTION_LINE * (row + 1) - 5
        place = (_CAPTION_MARGIN, low)
        white = (245, 245, 245)
        cv2.putText(canvas, caption, place, _FONT, _CAPTION_SCALE, white, 1, cv2.LINE_AA)

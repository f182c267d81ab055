"""A film of what the system believes: both camera views with cars, trails and recognitions."""

import shutil
from collections import deque
from pathlib import Path

import numpy as np
import numpy.typing as npt

from chronicles.events import Recognition
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from perception.camera import Camera
from perception.overlay import FilmWriter, Mark, Trail, draw_overlay, side_by_side

__all__ = ["Overlay"]

Image = npt.NDArray[np.uint8]
Points = npt.NDArray[np.float64]

_FRAMES_PER_SECOND = 25.0
_TRAIL_TABLES = 30
_CAPTION_LASTS = 6 * SECOND
_MAX_CAPTIONS = 6
_PREDICTED = (170, 170, 170)
_PALETTE = (
    (90, 220, 110), (255, 200, 60), (90, 180, 255), (255, 120, 120), (210, 140, 255),
    (90, 230, 220), (255, 160, 80), (240, 240, 120),
)  # fmt: skip


class Overlay:
    """Receives images, cars and recognitions, and writes a frame for each pair of images.

    A car's box is where the car was last believed to be, carried on to the time of the image at
    its velocity; boxes of cars that are only predicted are grey. Those of reckless drivers say so.
    Close it to keep the film.

    Args:
        working: File to write to.
        camera: Where the images are taken from.
    """

    def __init__(self, working: Path, camera: Camera) -> None:
        self._camera = camera
        width, height = camera.size
        size = (2 * width, height)
        self._film = FilmWriter(working, size, frames_per_second=_FRAMES_PER_SECOND)
        self._working = working
        self._colour: Sample[Image] | None = None
        self._cars: Sample[Table] | None = None
        self._recent: deque[Table] = deque(maxlen=_TRAIL_TABLES)
        self._captions: deque[tuple[TimePoint, str]] = deque(maxlen=_MAX_CAPTIONS)
        self._reckless: frozenset[int] = frozenset()

    def receive_colour(self, sample: Sample[Image]) -> None:
        """Take in a colour image."""
        self._colour = sample

    def receive_thermal(self, sample: Sample[Image]) -> None:
        """Take in a thermal image, and write a frame if a colour image has its time."""
        if self._colour is None or self._colour.valid_time != sample.valid_time:
            return
        marks, trails = self._marks(sample.valid_time), self._trails()
        captions = [
            text for time, text in self._captions if sample.valid_time - time < _CAPTION_LASTS
        ]
        colour = draw_overlay(self._colour.value, marks, trails, captions)
        thermal = draw_overlay(sample.value, marks, trails, ())
        self._film.write(side_by_side(colour, thermal))

    def receive_cars(self, sample: Sample[Table]) -> None:
        """Take in the cars that are believed in."""
        self._cars = sample
        self._recent.append(sample.value)

    def receive_reckless_drivers(self, sample: Sample[Table]) -> None:
        """Take in which cars belong to reckless drivers."""
        drivers = sample.value
        self._reckless = frozenset(drivers["car"].tolist()) if len(drivers) else frozenset()

    def receive_recognitions(self, sample: Sample[tuple[Recognition, ...]]) -> None:
        """Take in what was recognised."""
        for recognition in sample.value:
            values = ", ".join(recognition.arguments.values())
            name = recognition.chronicle.replace("_", " ")
            at = recognition.end / SECOND
            self._captions.append((sample.available_time, f"{at:6.1f} s  {name}: {values}"))

    def close(self, path: Path | None = None) -> None:
        """Finish the film, and move it to *path*; without a path it is thrown away."""
        self._film.close()
        if path is not None:
            shutil.move(self._working, path)
        self._working.unlink(missing_ok=True)

    def _marks(self, time: TimePoint) -> list[Mark]:
        if self._cars is None or not len(self._cars.value):
            return []
        cars = self._cars.value
        elapsed = (time - self._cars.valid_time) / SECOND
        centre = cars["position"] + cars["velocity"] * elapsed
        seen = np.flatnonzero(self._camera.sees(centre))
        corners = _corners(cars.select(seen), centre[seen])
        pixels = self._camera.image_from_ground(corners.reshape(-1, 2)).reshape(-1, 4, 2)
        return [
            Mark(self._label(cars, car), outline, _colour(car) if observed else _PREDICTED)
            for car, observed, outline in zip(
                cars.ids[seen].tolist(), cars["observed"][seen].tolist(), pixels, strict=True
            )
        ]

    def _label(self, cars: Table, car: int) -> str:
        return f"{cars.symbol(car)}{' reckless' if car in self._reckless else ''}"

    def _trails(self) -> list[Trail]:
        places: dict[int, list[Points]] = {}
        for table in self._recent:
            observed = table.select(table["observed"])
            for car, position in zip(observed.ids.tolist(), observed["position"], strict=True):
                places.setdefault(car, []).append(position)
        return [
            Trail(self._camera.image_from_ground(np.array(points)), _colour(car))
            for car, points in places.items()
            if len(points) > 1
        ]


def _corners(cars: Table, centre: Points) -> Points:
    """Return the corners of the cars' outlines on the ground, shape (n, 4, 2)."""
    heading = cars["heading"]
    forward = np.column_stack([np.cos(heading), np.sin(heading)]) * cars["length"][:, None] / 2
    left = np.column_stack([-np.sin(heading), np.cos(heading)]) * cars["width"][:, None] / 2
    signs = ((1, 1), (1, -1), (-1, -1), (-1, 1))
    return np.stack([centre + a * forward + b * left for a, b in signs], axis=1)


def _colour(car: int) -> tuple[int, int, int]:
    return _PALETTE[car % len(_PALETTE)]

"""The images in which the objects of a recognition were seen, and where in them."""

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt
import pandas as pd

from dyknow.time import MILLISECOND
from perception.camera import Camera
from traffic.explaining.explanation import Frame, Seen
from traffic.explaining.kept import KeptRun
from traffic.explaining.objects import Objects, corners_of
from traffic.explaining.symbols import id_of, sort_of_symbol

__all__ = ["Frames"]


class Frames:
    """Finds the percepts behind objects, and the images that they were seen in.

    Args:
        run: The run.
        objects: Its objects.
        camera: Where the images were taken from; None if there are none.
    """

    def __init__(self, run: KeptRun, objects: Objects, camera: Camera | None) -> None:
        self._run = run
        self._objects = objects
        self._camera = camera

    @cached_property
    def _image_times(self) -> Mapping[str, npt.NDArray[np.int64]]:
        images = self._run.images
        return {
            label: images.loc[images["stream"] == label, "valid_time"].to_numpy(np.int64)
            for label in self._run.roles.images
        }

    def frames(self, moments: Mapping[int, list[str]], symbols: Sequence[str]) -> list[Frame]:
        """Return a frame for each of some times (nanoseconds), with what it shows of *symbols*."""
        found = [self._frame(time, names, symbols) for time, names in sorted(moments.items())]
        return [frame for frame in found if frame is not None]

    def _frame(self, time: int, instants: list[str], symbols: Sequence[str]) -> Frame | None:
        known = [label for label in self._run.roles.percepts if label in self._sorts]
        if not known:
            return None
        label = known[0]
        percepts = self._percepts(label, time)
        taken = time if percepts.empty else int(percepts["valid_time"].iloc[0])
        return Frame(
            time=taken / MILLISECOND,
            instants=instants,
            percepts=label,
            images=self._numbers(taken),
            seen=[seen for each in symbols if (seen := self._seen(each, time, percepts))],
        )

    @property
    def _sorts(self) -> Mapping[str, str]:
        return self._run.description.sorts

    def _percepts(self, label: str, time: int) -> pd.DataFrame:
        """Return the newest table of percepts that was there at *time*."""
        window = [("valid_time", "<=", time), ("valid_time", ">", time - 1000 * MILLISECOND)]
        rows = self._run.read("percepts", window)
        rows = rows[rows["stream"] == label]
        newest: pd.DataFrame = rows[rows["valid_time"] == rows["valid_time"].max()]
        return newest

    def _numbers(self, time: int) -> dict[str, int]:
        found = {}
        for label, times in self._image_times.items():
            at = int(np.searchsorted(times, time, side="right")) - 1
            if at >= 0:
                found[label] = at
        return found

    def _seen(self, symbol: str, time: int, percepts: pd.DataFrame) -> Seen | None:
        state = self._objects.state_at(symbol, time)
        if state is None:
            return None
        percept = self._objects.structure_at(symbol, time)[-1]
        is_percept = sort_of_symbol(percept) in {
            self._sorts.get(p) for p in self._run.roles.percepts
        }
        rows = percepts[percepts["id"] == (id_of(percept) if is_percept else -1)]
        row = state if rows.empty else rows.iloc[0]
        x, y = float(row["x"]), float(row["y"])
        length, width = float(row["length"]), float(row["width"])
        pixel = box = None
        in_view = False
        if self._camera is not None:
            corners = corners_of(x, y, float(state["heading"]), length, width)
            pixels = self._camera.image_from_ground(np.vstack([[[x, y]], corners])).tolist()
            pixel, box = tuple(pixels[0]), [tuple(corner) for corner in pixels[1:]]
            in_view = bool(self._camera.sees(np.array([[x, y]]))[0])
        return Seen(
            symbol=symbol,
            percept=None if rows.empty else percept,
            position=(x, y),
            size=(length, width),
            pixel=pixel,
            box=box,
            in_view=in_view,
        )

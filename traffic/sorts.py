"""What the sorts of the specification contain, as far as that can be told from a value."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from chronicles.events import Event, Recognition
from dyknow.streams.table import Table
from perception.camera import Camera

__all__ = ["SORTS"]

_KINDS = {"f": "numbers", "i": "whole numbers", "u": "whole numbers", "b": "truth values"}
_POINT = ("f", 2)
_NUMBER = ("f",)
_COUNT = ("i",)
_TRUTH = ("b",)
_COLOUR = ("f", 3)

Columns = Mapping[str, tuple[str | int, ...]]
"""Of each column that is needed: the kind of its elements, then the shape of one of them."""

_BODY: Columns = {"length": _NUMBER, "width": _NUMBER, "observed_at": _COUNT}
_SEEN: Columns = {**_BODY, "colour": _COLOUR, "temperature": _NUMBER}
_MOVING: Columns = {**_SEEN, "position": _POINT, "velocity": _POINT, "observed": _TRUTH}
_ON_ROAD: Columns = {
    **_MOVING,
    "speed": _NUMBER,
    "heading": _NUMBER,
    "road": _COUNT,
    "s": _NUMBER,
    "d": _NUMBER,
}
_PAIR: Columns = {"first": _COUNT, "second": _COUNT}


@dataclass(frozen=True, slots=True)
class _Tables:
    """The sort of tables that have certain columns; a table of nothing need not have them.

    Attributes:
        columns: Those that are needed.
    """

    columns: Columns

    def __call__(self, value: Any) -> str | None:
        if not isinstance(value, Table):
            return "expected a table"
        if len(set(value.ids.tolist())) < len(value):
            return "expected each object once"
        if not len(value):
            return None
        faults = (self._fault(name, value) for name in self.columns)
        return next((fault for fault in faults if fault is not None), None)

    def _fault(self, name: str, table: Table) -> str | None:
        kind, *shape = self.columns[name]
        if name not in table:
            return f"expected a column '{name}'"
        column = table[name]
        if _KINDS.get(column.dtype.kind) != _KINDS[str(kind)]:
            return f"expected {_KINDS[str(kind)]} in column '{name}', found {column.dtype}"
        if list(column.shape[1:]) != shape:
            found = column.shape[1:]
            return f"expected values of shape {tuple(shape)} in column '{name}', found {found}"
        return None


def _fault_of_image(n_channels: int, value: Any) -> str | None:
    if not isinstance(value, np.ndarray) or value.dtype != np.uint8:
        return "expected an array of bytes"
    expected = 3 if n_channels > 1 else 2
    if value.ndim != expected or (n_channels > 1 and value.shape[2] != n_channels):
        return f"expected an image of {n_channels} channel(s), found the shape {value.shape}"
    return None


def _fault_of_all(kind: type, value: Any) -> str | None:
    if not isinstance(value, tuple) or not all(isinstance(each, kind) for each in value):
        return f"expected a tuple of {kind.__name__}"
    return None


def _fault_of_camera(value: Any) -> str | None:
    return None if isinstance(value, Camera) else "expected a camera"


SORTS: Mapping[str, Callable[[Any], str | None]] = {
    "vehicles": _Tables(
        {"position": _POINT, "heading": _NUMBER, "speed": _NUMBER, "length": _NUMBER}
    ),
    "signals": _Tables({"state": _COUNT, "since": _COUNT, "observed": _TRUTH}),
    "camera_pose": _fault_of_camera,
    "colour_image": partial(_fault_of_image, 3),
    "thermal_image": partial(_fault_of_image, 1),
    "percepts": _Tables({**_SEEN, "position": _POINT, "velocity": _POINT}),
    "world_objects": _Tables(_MOVING),
    "on_road_objects": _Tables(_ON_ROAD),
    "cars": _Tables({**_ON_ROAD, "lane": _COUNT, "link": _COUNT, "crossing": _COUNT}),
    "standing_cars": _Tables({"standing": _TRUTH, "crossing": _COUNT, "observed": _TRUTH}),
    "car_stop_lines": _Tables({"over": _COUNT, "beyond": _COUNT, "observed": _TRUTH}),
    "car_sides": _Tables({"wrong_side": _TRUTH, "observed": _TRUTH}),
    "car_pairs": _Tables({**_PAIR, "ahead": _NUMBER, "left": _NUMBER}),
    "car_relations": _Tables({**_PAIR, **dict.fromkeys(("behind", "in_front", "close"), _COUNT)}),
    "headways": _Tables({**_PAIR, "time_gap": _NUMBER, "deviation": _NUMBER, "aside": _NUMBER}),
    "car_following": _Tables({**_PAIR, "follows": _TRUTH, "tailgates": _TRUTH}),
    "car_dangers": _Tables({**_PAIR, "collision_course": _TRUTH}),
    "car_places": _Tables({"beside_building": _COUNT, "observed": _TRUTH}),
    "car_swings": _Tables({"swing": _COUNT}),
    "car_acts": _Tables(
        {"recognised": _TRUTH, "n_recognised": _COUNT, "recognised_at": _COUNT, "present": _TRUTH}
    ),
    "reckless_drivers": _Tables(
        {"car": _COUNT, "since": _COUNT, "n_acts": _COUNT, "last_act_at": _COUNT}
    ),
    "events": partial(_fault_of_all, Event),
    "recognitions": partial(_fault_of_all, Recognition),
}
"""What is wrong with a value that is not of the sort; None if nothing is."""

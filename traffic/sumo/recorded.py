"""Recorded poses: written from a simulation, replayed as one.

A recording is a table with a row for each vehicle at each time, as CSV or as NumPy's `.npz`:
`t` (milliseconds), `vehicle` (text), `x`, `y` (centre of the body, metres), `heading` (radians
counter-clockwise from east), `speed` (m/s), `length`, `width` (metres), and if known `height`
(metres), `red`, `green`, `blue` (0 to 255), `vehicle_class` (a word of `VEHICLE_CLASSES`), `lane`
(text) and `lane_position` (metres). Rows are in order of time; a time may have any number of
rows.
"""

import warnings
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from dyknow.source_text import nearest_name
from dyknow.streams.table import Column, Table
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import RecordingError
from traffic.sumo.simulation import VEHICLE, VEHICLE_CLASSES, Frame

__all__ = ["RecordedSimulation", "write_recording"]

_NEEDED = ("t", "vehicle", "x", "y", "heading", "speed", "length", "width")
_DEFAULTS: dict[str, float | str] = {
    "height": 1.5,
    "red": 128,
    "green": 128,
    "blue": 128,
    "vehicle_class": "passenger",
    "lane": "",
    "lane_position": 0.0,
}
_TEXTS = ("vehicle", "vehicle_class", "lane")
_COLOURS = ("red", "green", "blue")


class RecordedSimulation:
    """A replay (`traffic.sumo.simulation.Simulation`); the whole recording is read at once.

    Args:
        path: A recording, ending in `.csv` or `.npz`.

    Raises:
        RecordingError: The file is missing or broken, lacks a column, has values that are no
            numbers, has times out of order, or has a vehicle twice at one time.
    """

    def __init__(self, path: Path) -> None:
        rows = _checked(_read(path), path)
        vehicles, names = pd.factorize(rows["vehicle"])
        lanes, lane_names = pd.factorize(rows["lane"].where(rows["lane"] != ""))
        self.names: Sequence[str] = tuple(map(str, names))
        self.lanes: Sequence[str] = tuple(map(str, lane_names))
        self._frames: Iterator[Frame] = _frames(
            rows, vehicles.astype(np.int64), lanes.astype(np.int32)
        )

    def step(self) -> Frame | None:
        """Return the next frame, or None after the last."""
        return next(self._frames, None)

    def close(self) -> None:
        """End the replay."""
        self._frames = iter(())


def write_recording(
    frames: Iterable[Frame], names: Sequence[str], lanes: Sequence[str], path: Path
) -> None:
    """Write *frames* as a recording that `RecordedSimulation` replays.

    Args:
        frames: In order of time.
        names: Of the vehicles, by id; read after *frames*.
        lanes: Of the lanes, by number; read after *frames*.
        path: Ending in `.csv` or `.npz`; replaced if it exists.
    """
    parts = [_rows(frame) for frame in frames]
    rows = pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=list(_NEEDED))
    rows["vehicle"] = [names[i] for i in rows["vehicle"]]
    if parts:
        rows["lane"] = [lanes[i] if i >= 0 else "" for i in rows["lane"]]
    if path.suffix == ".npz":
        with path.open("wb") as file:
            np.savez_compressed(file, allow_pickle=False, **_arrays(rows))
    else:
        rows.to_csv(path, index=False)


def _rows(frame: Frame) -> pd.DataFrame:
    vehicles, hidden = frame.vehicles, frame.hidden
    classes = np.array(VEHICLE_CLASSES)[vehicles["vehicle_class"]]
    return pd.DataFrame(
        {
            "t": frame.time / MILLISECOND,
            "vehicle": vehicles.ids,
            "x": vehicles["position"][:, 0],
            "y": vehicles["position"][:, 1],
            **{name: vehicles[name] for name in ("heading", "speed", "length", "width", "height")},
            **{name: vehicles["colour"][:, i] for i, name in enumerate(_COLOURS)},
            "vehicle_class": classes,
            "lane": hidden["lane"],
            "lane_position": hidden["lane_position"],
        }
    )


def _arrays(rows: pd.DataFrame) -> dict[str, Any]:
    return {
        name: rows[name].to_numpy(dtype=str if name in _TEXTS else np.float64)
        for name in rows.columns
    }


def _read(path: Path) -> pd.DataFrame:
    try:
        return _read_arrays(path) if path.suffix == ".npz" else _read_text(path)
    except OSError as error:
        raise RecordingError(path, f"cannot be read: {error.strerror or error}") from error
    except (ValueError, zipfile.BadZipFile, pd.errors.ParserWarning) as error:
        raise RecordingError(path, f"is not a recording: {error}") from error


def _read_arrays(path: Path) -> pd.DataFrame:
    with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
        return pd.DataFrame({name: arrays[name] for name in arrays.files})


def _read_text(path: Path) -> pd.DataFrame:
    texts = dict.fromkeys(_TEXTS, str)
    with warnings.catch_warnings():
        # pandas only warns of rows that are longer than the head
        warnings.simplefilter("error", pd.errors.ParserWarning)
        return pd.read_csv(
            path, dtype=texts, keep_default_na=False, na_values=[""], index_col=False
        )


def _checked(rows: pd.DataFrame, path: Path) -> pd.DataFrame:
    """Return *rows* with all columns, or complain."""
    for name in _NEEDED:
        if name not in rows:
            nearest = nearest_name(name, rows.columns)
            hint = f"; is it '{nearest}'?" if nearest else ""
            raise RecordingError(path, f"the column '{name}' is missing{hint}")
    rows = rows.assign(**{k: v for k, v in _DEFAULTS.items() if k not in rows})
    rows = rows.assign(**{name: rows[name].fillna("").astype(str) for name in _TEXTS})
    for name in rows.columns.intersection([*_NEEDED, *_DEFAULTS]):
        if name not in _TEXTS:
            rows[name] = _numbers(rows[name], path)
    _check_order(rows, path)
    return rows


def _numbers(column: "pd.Series[Any]", path: Path) -> "pd.Series[float]":
    numbers = pd.to_numeric(column, errors="coerce")
    broken = ~np.isfinite(numbers.to_numpy(dtype=np.float64))
    if broken.any():
        at = int(np.argmax(broken))
        found = column.iloc[at]
        raise RecordingError(
            path, f"row {at + 1}: expected a number for '{column.name}', found '{found}'"
        )
    return numbers.astype(np.float64)


def _check_order(rows: pd.DataFrame, path: Path) -> None:
    late = np.flatnonzero(np.diff(rows["t"]) < 0)
    if len(late):
        at = int(late[0]) + 1
        raise RecordingError(
            path, f"row {at + 1}: time {rows['t'].iloc[at]:g} follows {rows['t'].iloc[at - 1]:g}"
        )
    twice = np.flatnonzero(rows.duplicated(["t", "vehicle"]))
    if len(twice):
        row = rows.iloc[int(twice[0])]
        raise RecordingError(
            path,
            f"row {int(twice[0]) + 1}: vehicle '{row['vehicle']}' is there twice at {row['t']:g}",
        )
    unknown = ~rows["vehicle_class"].isin(VEHICLE_CLASSES)
    if unknown.any():
        at = int(np.argmax(unknown))
        found, known = rows["vehicle_class"].iloc[at], ", ".join(VEHICLE_CLASSES)
        raise RecordingError(path, f"row {at + 1}: expected one of {known}, found '{found}'")


def _frames(
    rows: pd.DataFrame, vehicles: npt.NDArray[np.int64], lanes: npt.NDArray[np.int32]
) -> Iterator[Frame]:
    times = rows["t"].to_numpy()
    bounds = np.flatnonzero(np.diff(times, prepend=np.nan, append=np.nan) != 0)
    columns: dict[str, Column] = {
        name: rows[name].to_numpy() for name in ("heading", "speed", "length", "width", "height")
    }
    columns["position"] = rows[["x", "y"]].to_numpy()
    columns["colour"] = rows[list(_COLOURS)].to_numpy().clip(0, 255).astype(np.uint8)
    codes = {name: code for code, name in enumerate(VEHICLE_CLASSES)}
    columns["vehicle_class"] = rows["vehicle_class"].map(codes).to_numpy().astype(np.int8)
    hidden = {"lane": lanes, "lane_position": rows["lane_position"].to_numpy()}
    for first, last in pairwise(bounds):
        part = slice(first, last)
        yield Frame(
            TimePoint(round(times[first] * MILLISECOND)),
            Table(VEHICLE, vehicles[part], {name: c[part] for name, c in columns.items()}),
            Table(VEHICLE, vehicles[part], {name: c[part] for name, c in hidden.items()}),
        )

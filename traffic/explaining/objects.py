"""The objects of a recognition: their links down to the percepts, their states, their gaps."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from dyknow.time import MILLISECOND
from perception.camera import Camera
from traffic.explaining.explanation import Gap, LinkStep, ObjectExplanation, State
from traffic.explaining.kept import KeptRun, records_of
from traffic.explaining.symbols import id_of, sort_of_symbol

__all__ = ["Objects", "corners_of"]

_SIGNS = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)]) / 2

Floats = npt.NDArray[np.float64]


class Objects:
    """What is known of the objects of a run.

    Args:
        run: The run.
        camera: Where its images were taken from; None if there are none.
    """

    def __init__(self, run: KeptRun, camera: Camera | None) -> None:
        self._run = run
        self._camera = camera
        self._states: dict[str, pd.DataFrame] = {}

    @cached_property
    def _label_by_sort(self) -> Mapping[str, str]:
        sorts = self._run.description.sorts
        return {sorts[label]: label for label in self._run.roles.anchored if label in sorts}

    @cached_property
    def _links_by_upper(self) -> Mapping[str, list[dict[str, Any]]]:
        found: dict[str, list[dict[str, Any]]] = {}
        for row in records_of(self._run.links):
            found.setdefault(row["upper"], []).append(row)
        return found

    def are_among(self, symbols: Iterable[str]) -> list[str]:
        """Return those of some words that are objects with states, each once."""
        return [each for each in dict.fromkeys(symbols) if len(self.states(each))]

    def states(self, symbol: str) -> pd.DataFrame:
        """Return all states of an object in order of time; none if it is no object."""
        if symbol not in self._states:
            label = self._label_by_sort.get(sort_of_symbol(symbol) or "")
            rows = self._run.read("states", [("id", "=", id_of(symbol) if label else -1)])
            rows = rows[rows["stream"] == label].sort_values("valid_time", kind="stable")
            self._states[symbol] = rows.reset_index(drop=True)
        return self._states[symbol]

    def state_at(self, symbol: str, time: int) -> pd.Series | None:
        """Return the last state of an object that was valid at *time* or before; None without."""
        states = self.states(symbol)
        at = int(np.searchsorted(states["valid_time"].to_numpy(np.int64), time, side="right"))
        return states.iloc[at - 1] if at else None

    def outlines_at(self, time: int) -> list[tuple[str, Floats]]:
        """Return the symbols of all objects with a state at *time*, and their corners (4, 2)."""
        rows = self._run.read("states", [("valid_time", "=", time)])
        sorts = self._run.description.sorts
        return [
            (
                f"{sorts[str(row['stream'])]}{row['id']}",
                corners_of(row["x"], row["y"], row["heading"], row["length"], row["width"]),
            )
            for row in records_of(rows)
        ]

    def structure_at(self, symbol: str, time: int) -> list[str]:
        """Return an object and the objects below it at one time, down to the percept."""
        found = [symbol]
        while (below := self._standing(found[-1], time)) is not None:
            found.append(below)
        return found

    def explained(
        self, symbol: str, variables: Sequence[str], moments: Mapping[int, list[str]], until: int
    ) -> ObjectExplanation:
        """Return what explains an object.

        Args:
            symbol: The object.
            variables: Of which it is the value.
            moments: The times at which its state is told, nanoseconds, and their instants.
            until: Up to when its links are told.
        """
        states = self.states(symbol)
        first = int(states["valid_time"].iloc[0])
        begin, end = min(moments, default=until), max(moments, default=until)
        told = [self._state(symbol, time, names) for time, names in sorted(moments.items())]
        return ObjectExplanation(
            symbol=symbol,
            variables=list(variables),
            stream=str(states["stream"].iloc[0]),
            first_seen=first / MILLISECOND,
            links=list(self._links_below([(symbol, 0, until)])),
            states=[state for state in told if state is not None],
            gaps=list(self._gaps(symbol, begin, end)),
        )

    def _standing(self, upper: str, time: int) -> str | None:
        for row in reversed(self._links_by_upper.get(upper, [])):
            if row["begin"] <= time and (pd.isna(row["end"]) or time < row["end"]):
                return str(row["lower"])
        return None

    def _links_below(self, uppers: Sequence[tuple[str, int, int]]) -> Iterator[LinkStep]:
        """Yield the links of some objects between two times each, and of those below them."""
        below: list[tuple[str, int, int]] = []
        for upper, begin, end in uppers:
            for row in self._links_by_upper.get(upper, []):
                stop = end if pd.isna(row["end"]) else min(end, row["end"])
                if row["begin"] <= end and stop >= begin:
                    yield self._step(row)
                    below.append((row["lower"], max(begin, row["begin"]), stop))
        if below:
            yield from self._links_below(below)

    def _step(self, row: Mapping[str, Any]) -> LinkStep:
        label = str(row["stream"])
        conditions = self._run.conditions.get(label, {})
        why = str(row["ended_by"]) or None
        return LinkStep(
            stream=label,
            upper=row["upper"],
            lower=row["lower"],
            begin=row["begin"] / MILLISECOND,
            made_by=str(row["made_by"]),
            condition=conditions.get(str(row["made_by"]), ""),
            end=None if pd.isna(row["end"]) else row["end"] / MILLISECOND,
            ended_by=why,
            end_condition=conditions.get("maintain") if why == "violated" else None,
        )

    def _state(self, symbol: str, time: int, instants: list[str]) -> State | None:
        row = self.state_at(symbol, time)
        if row is None:
            return None
        x, y = float(row["x"]), float(row["y"])
        return State(
            time=int(row["valid_time"]) / MILLISECOND,
            instants=instants,
            position=(x, y),
            heading=_degrees(row["heading"]),
            speed=None if pd.isna(row["speed"]) else float(row["speed"]),
            observed=bool(row["observed"]),
            observed_at=_milliseconds(row["observed_at"]),
            place=self._place(row),
            structure=self.structure_at(symbol, int(row["valid_time"])),
            pixel=self._pixel(x, y),
        )

    def _place(self, row: pd.Series) -> dict[str, str | float]:
        found: dict[str, str | float] = {}
        for column in ("lane", "link", "crossing"):
            if pd.notna(row[column]) and row[column] >= 0:
                found[column] = self._run.value_of(column, int(row[column])) or ""
        for column in ("s", "d"):
            if pd.notna(row[column]):
                found[column] = float(row[column])
        return found

    def _pixel(self, x: float, y: float) -> tuple[float, float] | None:
        point = np.array([[x, y]])
        if self._camera is None or not self._camera.sees(point)[0]:
            return None
        ((u, v),) = self._camera.image_from_ground(point).tolist()
        return u, v

    def _gaps(self, symbol: str, begin: int, end: int) -> Iterator[Gap]:
        states = self.states(symbol)
        times = states["valid_time"].to_numpy(np.int64)
        inside = (times >= begin) & (times <= end)
        times, seen = times[inside], states["observed"].to_numpy(bool)[inside]
        edges = np.flatnonzero(np.diff(np.concatenate([[True], seen, [True]])))
        for first, after in zip(edges[::2], edges[1::2], strict=True):
            last = times[after] if after < len(times) else end
            yield Gap(begin=times[first] / MILLISECOND, end=last / MILLISECOND)


def corners_of(x: float, y: float, heading: float, length: float, width: float) -> Floats:
    """Return the corners (4, 2) of a rectangle on the ground."""
    forward = np.array([np.cos(heading), np.sin(heading)]) * length
    left = np.array([-np.sin(heading), np.cos(heading)]) * width
    return np.array([x, y]) + _SIGNS[:, :1] * forward + _SIGNS[:, 1:] * left


def _degrees(heading: Any) -> float | None:
    return None if pd.isna(heading) else math.degrees(float(heading)) % 360.0


def _milliseconds(time: Any) -> float | None:
    return None if pd.isna(time) else int(time) / MILLISECOND

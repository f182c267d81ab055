"""Which stop line a car has just driven past."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from networks.roads import RoadMap
from traffic.features.carrying import CarriedColumns

__all__ = ["StopLines"]

_NONE = np.int32(-1)
_FAR = 4.0
"""Metres across the road within which a lane with a signal is the lane of a car."""

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int32]


class StopLines(Reactive):
    """Computes which signal's stop line the front of each car is past; one table for each one in.

    While a car is on a road that leads to signals, its signal is that of the lane nearest to its
    place across the road. It remembers it in the crossing, on the ways that go on from that
    road; anywhere else it has none. Columns, both the number of a signal on the map, or -1:

    * `over`: the front is past the line; holds until it is *slack* before it;
    * `beyond`: the front is at least *beyond* past the line; holds until it is *slack* less.

    Args:
        roads: The road network.
        beyond: Metres from the line to the front.
        slack: Metres by which a front that is past must come back.
    """

    def __init__(self, roads: RoadMap, *, beyond: float, slack: float) -> None:
        if beyond <= 0 or slack < 0:
            raise ValueError(f"expected beyond > 0 and slack >= 0, found {beyond} and {slack}")
        self._beyond = beyond
        self._slack = slack
        signals = roads.signals
        road = np.asarray(roads.lane_columns.road[signals.lane], dtype=np.int32)
        s, d = roads.project(signals.lines.mean(axis=1), road)
        self._of_road = {r: np.flatnonzero(road == r) for r in np.unique(road).tolist()}
        self._across = d
        # The last element is what the signal -1 has.
        self._line_at = np.append(s, np.inf)
        self._road_of_signal = np.append(road, _NONE)
        self._length = np.asarray(roads.road_length, dtype=np.float64)
        self._entry = np.full(len(roads.roads), _NONE, dtype=np.int32)
        for before in self._of_road:
            self._entry[list(roads.successors(before))] = before
        self._state = CarriedColumns({"signal": _NONE, "over": _NONE, "beyond": _NONE})

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the lines that the cars of the newest table are past."""
        (sample,) = inputs
        cars: Table = sample.value
        self._state.align(cars.ids)
        signal = self._signals(cars)
        past = self._past(cars, signal)
        self._state["signal"] = signal
        over = self._held("over", signal, past, 0.0)
        beyond = self._held("beyond", signal, past, self._beyond)
        columns = {"over": over, "beyond": beyond, "observed": cars["observed"]}
        yield Sample(Table("car", cars.ids, columns), sample.valid_time, now)

    def _signals(self, cars: Table) -> Integers:
        """Return the signal of each car, or -1."""
        road, d = cars["road"], cars["d"]
        before = self._state["signal"]
        goes_on = (before >= 0) & (self._entry[road] == self._road_of_signal[before])
        signal = np.where(goes_on & (road >= 0), before, _NONE).astype(np.int32)
        for each, candidates in self._of_road.items():
            (rows,) = np.nonzero(road == each)
            if len(rows):
                apart = np.abs(d[rows, None] - self._across[candidates])
                nearest = candidates[apart.argmin(axis=1)]
                signal[rows] = np.where(apart.min(axis=1) <= _FAR, nearest, _NONE)
        return signal

    def _past(self, cars: Table, signal: Integers) -> Floats:
        """Return the metres from the line to the front of each car; negative before the line."""
        approach = self._road_of_signal[signal]
        behind = np.where(cars["road"] != approach, self._length[approach], 0.0)
        past: Floats = cars["s"] + cars["length"] / 2 + behind - self._line_at[signal]
        return past

    def _held(self, name: str, signal: Integers, past: Floats, least: float) -> Integers:
        """Return the signals whose line is *least* metres behind, with hysteresis."""
        stays = (self._state[name] == signal) & (past >= least - self._slack)
        held = np.where((signal >= 0) & ((past >= least) | stays), signal, _NONE)
        self._state[name] = held.astype(np.int32)
        return held.astype(np.int32)

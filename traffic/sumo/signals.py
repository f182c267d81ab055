"""What traffic lights show, read once per step into columns."""

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Table
from networks.signals import permissive
from traffic.sumo.simulation import SIGNAL

__all__ = ["SignalReader"]


class SignalReader:
    """Reads the state of the signal of every lane that has a controlled way out.

    Args:
        libsumo: The running simulator.
        number_of: Gives each lane its number in the frames.
    """

    def __init__(self, libsumo: ModuleType, number_of: Callable[[str], int]) -> None:
        self._api: Any = libsumo.trafficlight
        self._lights: tuple[str, ...] = tuple(sorted(self._api.getIDList()))
        self._ways = [self._ways_of(light) for light in self._lights]
        lanes = sorted({lane for ways in self._ways for lane in ways})
        row = {lane: i for i, lane in enumerate(lanes)}
        self._rows = [np.array([row[lane] for lane in ways], np.intp) for ways in self._ways]
        self._ids = np.array([number_of(lane) for lane in lanes], dtype=np.int64)
        self._known: dict[tuple[int, str], npt.NDArray[np.int8]] = {}

    def read(self) -> Table:
        """Return the states of all signals."""
        state = np.zeros(len(self._ids), dtype=np.int8)
        for i, light in enumerate(self._lights):
            state[self._rows[i]] = self._states(i, self._api.getRedYellowGreenState(light))
        return Table(SIGNAL, self._ids, {"state": state})

    def _ways_of(self, light: str) -> dict[str, list[int]]:
        """Return the places in the light's state of all ways out of each lane."""
        ways: dict[str, list[int]] = {}
        for place, links in enumerate(self._api.getControlledLinks(light)):
            for link in links:
                ways.setdefault(link[0], []).append(place)
        return ways

    def _states(self, light: int, letters: str) -> npt.NDArray[np.int8]:
        """Return the states of the lanes of a light; it takes few different ones, remembered."""
        known = self._known.get((light, letters))
        if known is None:
            shown = [
                permissive("".join(letters[place] for place in places))
                for places in self._ways[light].values()
            ]
            known = self._known[light, letters] = np.array(shown, dtype=np.int8)
        return known

"""Who truly drives past a red light."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dyknow.time import SECOND, Duration, TimePoint
from networks.roads import RoadMap
from networks.signals import SignalState
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.places import TruePlaces

__all__ = ["RedLightWatcher"]

_RED_FOR = Duration(SECOND)
_BEYOND = 4.0
_NOWHERE = -1

Points = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Passing:
    """A vehicle has passed a stop line while its signal was red.

    Attributes:
        signal: The number of the lane that has the signal.
        time: The first frame in which the front bumper was in the crossing.
        front: Where the front bumper was then, x and y, metres.
    """

    signal: int
    time: TimePoint
    front: Points


class RedLightWatcher:
    """Watches who gets into a crossing from a lane whose signal is red.

    A vehicle has driven past a red light if its front bumper gets from a lane with a signal into
    the crossing while that signal has been red for at least 1 s, and is 4 m beyond before the
    signal shows anything else. So those are none who stop just behind the line, or who pass on
    yellow or just as it turns. The manoeuvre lasts from the first frame in the crossing to the
    first one in which the front is 4 m beyond the place where it was then.

    A lane's signal is red when it is red for every way out of the lane
    (`networks.signals.permissive`).
    """

    def __init__(self) -> None:
        self._state: dict[int, tuple[int, TimePoint]] = {}
        self._lane: dict[int, int] = {}
        self._passings: dict[int, _Passing] = {}

    @classmethod
    def on(cls, _: RoadMap) -> "RedLightWatcher":
        """Return a watcher, which is the same for every map."""
        return cls()

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return who was 4 m beyond a red light in it."""
        self._read_signals(frame)
        ids, lanes = frame.vehicles.ids.tolist(), frame.hidden["lane"].tolist()
        fronts = _fronts(frame)
        for row, vehicle in enumerate(ids):
            signal = self._lane.get(vehicle, _NOWHERE)
            if places.crossing[row] >= 0 and self._has_been_red(signal, frame.time):
                self._passings[vehicle] = _Passing(signal, frame.time, fronts[row])
        found = [
            TrueManoeuvre("red_light", (vehicle,), (), passing.time, frame.time)
            for row, vehicle in enumerate(ids)
            if (passing := self._passings.get(vehicle)) is not None
            and self._is_red(passing.signal)
            and np.hypot(*(fronts[row] - passing.front)) >= _BEYOND
        ]
        over = {each.vehicles[0] for each in found}
        self._passings = {
            vehicle: passing
            for vehicle, passing in self._passings.items()
            if vehicle not in over and self._is_red(passing.signal)
        }
        self._lane = dict(zip(ids, lanes, strict=True))
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return nothing: who is not 4 m beyond yet may still stop."""
        return []

    def _read_signals(self, frame: Frame) -> None:
        """Note since when each signal has been showing what it shows."""
        signals = frame.signals
        for lane, state in zip(signals.ids.tolist(), signals["state"].tolist(), strict=True):
            if self._state.get(lane, (_NOWHERE, frame.time))[0] != state:
                self._state[lane] = state, frame.time

    def _is_red(self, lane: int) -> bool:
        return self._state.get(lane, (_NOWHERE, 0))[0] == SignalState.RED

    def _has_been_red(self, lane: int, now: TimePoint) -> bool:
        return self._is_red(lane) and now - self._state[lane][1] >= _RED_FOR


def _fronts(frame: Frame) -> Points:
    """Return where the front bumpers are, shape (n, 2), metres."""
    vehicles = frame.vehicles
    heading = vehicles["heading"]
    forward = np.column_stack([np.cos(heading), np.sin(heading)])
    front: Points = vehicles["position"] + forward * vehicles["length"][:, None] / 2
    return front

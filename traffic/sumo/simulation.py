"""What a simulation is, and what it tells at each step."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = [
    "SIGNAL",
    "VEHICLE",
    "VEHICLE_CLASSES",
    "Frame",
    "Simulation",
    "class_code",
    "headings_of",
]

VEHICLE: Final = "vehicle"
"""The sort of the vehicles in a frame."""

SIGNAL: Final = "signal"
"""The sort of the signals in a frame."""

VEHICLE_CLASSES: Final = (
    "passenger", "delivery", "truck", "bus", "motorcycle", "bicycle", "other",
)  # fmt: skip
"""The column `vehicle_class` holds positions in this tuple."""

_CODE_BY_SUMO_CLASS = {
    "passenger": 0, "private": 0, "taxi": 0, "hov": 0, "vip": 0, "evehicle": 0, "custom1": 0,
    "custom2": 0, "authority": 0, "army": 0, "ignoring": 0,
    "delivery": 1, "emergency": 1,
    "truck": 2, "trailer": 2,
    "bus": 3, "coach": 3,
    "motorcycle": 4, "moped": 4,
    "bicycle": 5, "scooter": 5,
}  # fmt: skip


def _no_signals() -> Table:
    return Table(SIGNAL, (), {"state": np.empty(0, dtype=np.int8)})


@dataclass(slots=True)
class Frame:
    """All vehicles and signals at one time; immutable by convention.

    Attributes:
        time: Since the begin of the scenario.
        vehicles: What can be seen. Columns: `position` (n, 2), centre of the body, metres, in
            the world frame; `heading` (n,), radians counter-clockwise from east; `speed`, m/s;
            `length`, `width`, `height`, metres; `colour` (n, 3), uint8, red, green, blue;
            `vehicle_class` (n,), int8, position in `VEHICLE_CLASSES`.
        hidden: What only ground truth may use, row by row. Columns: `lane` (n,), int32,
            position in `Simulation.lanes`, -1 off the road; `lane_position` (n,), metres of the
            front bumper along that lane. A vehicle on the opposite lane is on a lane of the
            other direction.
        signals: What the signal of each lane shows that has one. The id is the number of the lane
            in `Simulation.lanes`; column `state` (n,), int8, of `networks.signals.SignalState`.
    """

    time: TimePoint
    vehicles: Table
    hidden: Table
    signals: Table = field(default_factory=_no_signals)


class Simulation(Protocol):
    """Vehicles that move in steps, simulated or replayed."""

    @property
    def names(self) -> Sequence[str]:
        """The simulator's own id of each vehicle, by the id in the tables; grows."""

    @property
    def lanes(self) -> Sequence[str]:
        """The name of each lane, by its number in frames; grows."""

    def step(self) -> Frame | None:
        """Return the next frame, beginning with that of time 0, or None after the last."""

    def close(self) -> None:
        """Release what the simulation holds; does nothing the second time."""


def class_code(sumo_class: str) -> int:
    """Return the position in `VEHICLE_CLASSES` of one of SUMO's vehicle classes."""
    return _CODE_BY_SUMO_CLASS.get(sumo_class, VEHICLE_CLASSES.index("other"))


def headings_of(angles: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return headings, radians counter-clockwise from east, of degrees clockwise from north."""
    turned: npt.NDArray[np.float64] = np.radians(90.0 - angles)
    return np.remainder(turned + np.pi, 2 * np.pi) - np.pi

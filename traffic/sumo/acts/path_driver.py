"""A driver who follows a curve exactly, on the road or off it, at any speed."""

import numpy as np

from traffic.sumo.acts.native_driver import NativeDriver
from traffic.sumo.acts.paths import Path
from traffic.sumo.acts.stage import Stage

__all__ = ["PathDriver", "towards"]

_ANYWHERE = 2
"""SUMO's `keepRoute`: exactly where it is told, whatever lies below, on the road or not."""

_SLOWEST = 0.05
"""m/s; below it the vehicle keeps its angle."""

_SIGHT = 100.0
"""Metres in which a driver minds who is ahead."""

_LEAST_GAP = 1.0
"""Metres between bumpers that are left when both stand, beside SUMO's own."""


class PathDriver:
    """Moves one vehicle along a path, to the side of it if wanted, in place of SUMO.

    The vehicle must be moved before every step: one that is off the road and is not moved is
    taken away by SUMO, and one that is on the road is SUMO's again. Others brake for it as for any
    vehicle while it is on a lane.

    Attributes:
        vehicle: SUMO's id.
        path: What it follows.
        s: How far along the path the front bumper is, metres.
        aside: How far it is to the left of the path, metres.
        speed: Along the path, m/s.

    Args:
        stage: Where the vehicle is.
        vehicle: SUMO's id of a vehicle that is there.
        path: What it follows; it begins where on the path it is now.

    Raises:
        VehicleGoneError: The vehicle is not there.
    """

    def __init__(self, stage: Stage, vehicle: str, path: Path) -> None:
        self.vehicle = vehicle
        self._native = NativeDriver(stage, vehicle)
        self._stage = stage
        self.path = path
        self.speed = self._native.speed
        self.s, self.aside = path.place_of(*self._native.position)
        self._angle = float(stage.api.vehicle.getAngle(vehicle))

    @property
    def is_at_end(self) -> bool:
        """Whether the path has been driven to its end."""
        return self.s >= self.path.length

    def safe_speed(self, braking: float) -> float:
        """Return the highest speed at which the vehicle can stop behind whoever is ahead.

        Args:
            braking: How hard it would brake, m/s²; it needs a second before it does.
        """
        ahead = self._stage.api.vehicle.getLeader(self.vehicle, _SIGHT)
        if ahead is None or not ahead[0]:
            return np.inf
        leader, gap = ahead
        others = float(self._stage.api.vehicle.getSpeed(leader))
        room = max(0.0, gap - _LEAST_GAP)
        return float(np.sqrt(braking**2 + others**2 + 2 * braking * room)) - braking

    def move(self, speed: float, aside: float = 0.0) -> None:
        """Let the coming step bring the vehicle further along the path.

        Args:
            speed: Along the path, m/s; the caller changes it smoothly (`towards`).
            aside: Where it is to the left of the path then, metres; to be changed smoothly.

        Raises:
            VehicleGoneError: The vehicle has left, or SUMO took it away.
        """
        ahead = speed * self._stage.step_length
        s = min(self.s + ahead, self.path.length)
        x, y = self.path.point(s, aside)
        if speed > _SLOWEST:
            sideways = np.arctan2(aside - self.aside, max(s - self.s, 1e-3))
            self._angle = 90.0 - float(np.degrees(self.path.heading(s) + sideways))
        self._native.require_here()
        self._stage.api.vehicle.moveToXY(
            self.vehicle, "", -1, x, y, self._angle % 360.0, keepRoute=_ANYWHERE
        )
        self.s, self.aside, self.speed = s, aside, speed


def towards(value: float, wanted: float, largest_step: float) -> float:
    """Return the number nearest to *wanted* that is at most *largest_step* from *value*."""
    return float(np.clip(wanted, value - largest_step, value + largest_step))

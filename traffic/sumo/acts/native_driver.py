"""A driver who stays in SUMO's hands and is told how fast to drive and which lane to take."""

from types import TracebackType
from typing import Any, Self

from traffic.sumo.acts.performance import VehicleGoneError
from traffic.sumo.acts.stage import Stage

__all__ = ["NativeDriver"]

_WITHIN_LIMITS = 6
"""SUMO's speed mode: accelerates and brakes as vehicles can, and minds nobody."""

_CAREFUL = 31
_ONLY_OURS = 0
_OWN_LANE_CHANGES = 1621
_FOREVER = 1e6


class NativeDriver:
    """Drives one vehicle by SUMO's own commands; a `with` block gives it back at its end.

    A vehicle that has not come in yet is *expected*; one that was there and is gone makes
    every question raise `VehicleGoneError`.

    Args:
        stage: Where the vehicle is.
        vehicle: SUMO's id.
    """

    def __init__(self, stage: Stage, vehicle: str) -> None:
        self.vehicle = vehicle
        self._stage = stage
        self._api: Any = stage.api.vehicle
        self._has_come = False

    @property
    def is_here(self) -> bool:
        """Whether the vehicle has come in.

        Raises:
            VehicleGoneError: It has left, or SUMO took it away.
        """
        here = self._stage.is_here(self.vehicle)
        if self._has_come and not here:
            raise VehicleGoneError(self.vehicle)
        self._has_come = here
        return here

    def require_here(self) -> None:
        """Do nothing if the vehicle is there.

        Raises:
            VehicleGoneError: It is not, or not any more.
        """
        if not self.is_here:
            raise VehicleGoneError(self.vehicle)

    @property
    def position(self) -> tuple[float, float]:
        """Where the middle of the front bumper is, x and y in metres."""
        x, y = self._there().getPosition(self.vehicle)
        return float(x), float(y)

    @property
    def speed(self) -> float:
        """m/s."""
        return float(self._there().getSpeed(self.vehicle))

    @property
    def road(self) -> str:
        """The edge below the vehicle; begins with `:` inside a crossing."""
        return str(self._there().getRoadID(self.vehicle))

    @property
    def lane(self) -> str:
        """The lane below the vehicle."""
        return str(self._there().getLaneID(self.vehicle))

    @property
    def place(self) -> float:
        """How far the front bumper is along the lane, metres."""
        return float(self._there().getLanePosition(self.vehicle))

    def is_on(self, road: str, place: float) -> bool:
        """Whether the front bumper has come to *place* metres on *road*, and is on it still."""
        return self.road == road and self.place >= place

    def drive_at(self, speed: float, *, careful: bool = False) -> None:
        """Drive at *speed* from now on.

        Args:
            speed: m/s.
            careful: Keep a safe distance, right of way and red lights; else mind nobody.
        """
        self._there().setSpeedMode(self.vehicle, _CAREFUL if careful else _WITHIN_LIMITS)
        self._api.setSpeed(self.vehicle, speed)

    def keep_lane(self) -> None:
        """Change lanes only when told to."""
        self._there().setLaneChangeMode(self.vehicle, _ONLY_OURS)

    def change_lane(self, lane: int) -> None:
        """Go to lane *lane*, counted from the outer side, and stay there."""
        self.keep_lane()
        self._api.changeLane(self.vehicle, lane, _FOREVER)

    def release(self) -> None:
        """Give speed and lanes back to SUMO; does nothing if the vehicle is not there."""
        if self._stage.is_here(self.vehicle):
            self._api.setSpeed(self.vehicle, -1)
            self._api.setSpeedMode(self.vehicle, _CAREFUL)
            self._api.setLaneChangeMode(self.vehicle, _OWN_LANE_CHANGES)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.release()

    def _there(self) -> Any:
        self.require_here()
        return self._api

"""Acts of drivers who come too near to others, and of those who only seem to."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import AfterValidator

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Roads, Speeds, TypeWeights

__all__ = ["BrakeLate", "CrossWithRoom", "CutOff"]


def _moving(value: tuple[float, float]) -> tuple[float, float]:
    if value[0] <= 0:
        raise ValueError("expected a speed above 0")
    return value


_Speeds = Annotated[Speeds, AfterValidator(_moving)]


class _Crossing(Act):
    """Two drivers whose ways cross; the one of the act goes first, whoever has right of way.

    Attributes:
        place: How far from the begin of the first road the driver comes in, metres.
        other_route: The roads that the other driver passes.
        other_types: Weight of each vehicle type of the other driver.
        other_place: How far from the begin of its first road the other one comes in, metres.
        other_speed: Of the other one, m/s; the first one drives so that they meet as they should.
    """

    place: Distances
    other_route: Roads
    other_types: TypeWeights
    other_place: Distances
    other_speed: _Speeds

    @property
    def casts(self) -> Mapping[str, TypeWeights]:
        """The weights of both drivers' vehicle types."""
        return {"types": self.types, "other_types": self.other_types}

    @property
    def routes(self) -> Mapping[str, Roads]:
        """The roads of both drivers."""
        return {"route": self.route, "other_route": self.other_route}


class CutOff(_Crossing):
    """Crosses in front of another driver so closely that the other one must brake hard.

    Attributes:
        kind: `cut_off`.
        brakes_at: How long before the collision the other one brakes.
    """

    kind: Literal["cut_off"]
    brakes_at: DurationRange


class CrossWithRoom(_Crossing):
    """Crosses in front of another driver who need not brake for it.

    Attributes:
        kind: `cross_with_room`.
        gap: How long after the first one is gone the other one gets there.
    """

    kind: Literal["cross_with_room"]
    gap: DurationRange


class BrakeLate(Act):
    """Sees too late who stands ahead on the lane, and brakes as hard as one can.

    Somebody else stops on the lane first.

    Attributes:
        kind: `brake_late`.
        speed: Of the driver, m/s.
        place: How far from the begin of the last road the other one stands, metres.
        duration: How long the other one stands.
        braking: How hard the driver brakes in the end, m/s².
        left: What is left between them, metres.
    """

    kind: Literal["brake_late"]
    speed: _Speeds
    place: Distances
    duration: DurationRange
    braking: Distances = (8.0, 9.0)
    left: Distances = (0.6, 1.0)

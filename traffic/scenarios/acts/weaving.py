"""Acts of drivers who do not keep straight: those who sway, and those who go around something."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Speeds

__all__ = ["Swerve", "Weave"]


def _not_instant(value: tuple[int, int]) -> tuple[int, int]:
    if value[0] <= 0:
        raise ValueError("expected a duration above 0")
    return value


_Period = Annotated[DurationRange, AfterValidator(_not_instant)]


class Weave(Act):
    """Sways left and right about its lane, as a drunk driver does; slows down for who is ahead.

    Each swing draws its own width and duration.

    Attributes:
        kind: `weave`.
        speed: m/s.
        lane: On every road, counted from the outer side.
        place: How far from the begin of the route it begins, metres.
        duration: How long it lasts.
        width: From the one side to the other, metres.
        period: From left to right and back.
    """

    kind: Literal["weave"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    place: Distances
    duration: DurationRange
    width: Distances
    period: _Period


class Swerve(Act):
    """Goes around something on its lane once: aside, past it, and back.

    Attributes:
        kind: `swerve`.
        speed: m/s.
        lane: On every road, counted from the outer side.
        place: How far from the begin of the route it begins, metres.
        width: How far aside, to the left, metres; to the right if `rightwards`.
        rightwards: On which side it passes.
        going: How long it takes to go aside, and to come back.
        staying: How long it stays aside.
    """

    kind: Literal["swerve"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    place: Distances
    width: Distances
    rightwards: bool = False
    going: _Period
    staying: DurationRange

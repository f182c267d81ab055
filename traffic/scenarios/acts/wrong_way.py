"""Acts of drivers who are on the side on which one drives the other way."""

from typing import Annotated, Literal

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Speeds

__all__ = ["DriveOpposite"]


class DriveOpposite(Act):
    """Goes over to the opposite side, drives there for a while, and comes back.

    Begins at the place, or behind it as soon as nobody can come towards the driver for as long as
    it takes, and nobody is near on the own side.

    Attributes:
        kind: `drive_opposite`.
        speed: m/s.
        lane: On every road, counted from the outer side.
        place: How far from the begin of the route it begins, metres.
        aside: How far over, metres to the left.
        going: How long it takes to go over, and to come back.
        duration: How long it stays there in between.
    """

    kind: Literal["drive_opposite"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    place: Distances
    aside: Distances
    going: DurationRange
    duration: DurationRange

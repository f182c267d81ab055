"""Acts that any scenario may need: to drive at a speed, and to halt on the lane."""

from typing import Annotated, Literal

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Speeds

__all__ = ["Drive", "Halt"]


class Drive(Act):
    """Drives along the route at a speed of its own, keeps its lane, and brakes for others.

    Attributes:
        kind: `drive`.
        speed: m/s.
        lane: On the first road, counted from the outer side; None for the best one.
    """

    kind: Literal["drive"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] | None = None


class Halt(Act):
    """Stops on its lane for a while, as someone does who lets a friend get in, and drives on.

    Attributes:
        kind: `halt`.
        place: How far from the begin of the last road it stands, metres.
        duration: How long it stands.
        lane: On the last road, counted from the outer side.
    """

    kind: Literal["halt"]
    place: Distances
    duration: DurationRange
    lane: Annotated[int, Field(ge=0)] = 0

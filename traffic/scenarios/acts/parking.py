"""Acts of drivers who park: in a bay or at the kerb."""

from typing import Annotated, Literal

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Speeds

__all__ = ["Park"]

_Place = Annotated[float, Field(ge=0, le=100_000)]


class Park(Act):
    """Drives to a free place beside the lane, stands there, and joins the traffic again.

    If no place is free when one is chosen, the driver goes on.

    Attributes:
        kind: `park`.
        speed: On the way, m/s.
        lane: On every road, counted from the outer side.
        places: How far from the begin of the route the front bumper stands, metres; one is drawn.
        aside: How far the vehicle stands to the right of the middle of the lane, metres; to the
            left of it if `leftwards`.
        leftwards: On which side it parks.
        duration: How long it stands.
    """

    kind: Literal["park"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    places: Annotated[tuple[_Place, ...], Field(min_length=1)]
    aside: Distances
    leftwards: bool = False
    duration: DurationRange

"""Acts at crossings: of those who mind no red light, who halt inside, and who only seem to."""

from typing import Annotated, Literal

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Speeds

__all__ = ["CreepOverLine", "HaltInCrossing", "RunRedLight"]


class RunRedLight(Act):
    """Drives past the signal at the end of the first road although it is red.

    The driver comes in so that the signal has been red for a while when the front passes the
    line, and passes it if nobody stands before it; who finds traffic in the crossing stops and
    goes as soon as there is none, still at red.

    Attributes:
        kind: `run_red_light`.
        speed: m/s.
        lane: On every road, counted from the outer side.
        after: How long the signal is to be red then.
    """

    kind: Literal["run_red_light"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    after: DurationRange


class CreepOverLine(Act):
    """Stops a little past the stop line at the end of the first road, and waits there for green.

    Attributes:
        kind: `creep_over_line`.
        speed: m/s.
        lane: On every road, counted from the outer side.
        over: How far past the line the front stops, metres.
    """

    kind: Literal["creep_over_line"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    over: Distances


class HaltInCrossing(Act):
    """Halts inside the crossing at the end of the first road for a while, and drives on.

    Attributes:
        kind: `halt_in_crossing`.
        speed: m/s.
        lane: On every road, counted from the outer side.
        into: How far past the end of the road the front stops, metres.
        duration: How long it stands.
    """

    kind: Literal["halt_in_crossing"]
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    into: Distances
    duration: DurationRange

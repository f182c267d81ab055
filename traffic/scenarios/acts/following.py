"""Acts of drivers who follow others: too closely, in a row, or wherever they turn."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import Distances, DurationRange, Roads, Speeds

__all__ = ["CloseUp", "Column", "Tail", "Tailgate"]

_Lane = Annotated[int, Field(ge=0)]


def _reachable(value: tuple[int, int]) -> tuple[int, int]:
    if value[0] <= 0:
        raise ValueError("expected time gaps above 0")
    return value


def _ordered(value: tuple[int, int]) -> tuple[int, int]:
    if value[0] > value[1]:
        raise ValueError(f"expected the smaller number first, in {list(value)}")
    return value


TimeGaps = Annotated[DurationRange, AfterValidator(_reachable)]
"""How long a driver needs for the gap to who is ahead, from bumper to bumper."""

_Counts = Annotated[
    tuple[Annotated[int, Field(ge=2, le=50)], Annotated[int, Field(ge=2, le=50)]],
    AfterValidator(_ordered),
]


class Column(Act):
    """Several drive one behind the other, as they would behind somebody slow.

    Whether this is a convoy, or one after the other at a distance, or a crawling queue, depends on
    the time gaps and on the speed.

    Attributes:
        kind: `column`.
        speed: Of the first, m/s; the others keep up with it.
        lane: Counted from the outer side; None for the best one.
        place: How far from the begin of the first road they come in, metres.
        number: The fewest and the most vehicles.
        time_gap: Of each to the one ahead.
    """

    kind: Literal["column"]
    speed: Speeds
    lane: _Lane | None = None
    place: Distances | None = None
    number: _Counts
    time_gap: TimeGaps


class Tailgate(Act):
    """Drives close behind somebody who cannot, or will not, drive faster.

    Attributes:
        kind: `tailgate`.
        speed: Of the one ahead, m/s.
        lane: Of both, counted from the outer side; None for the best one.
        time_gap: That the one behind keeps.
    """

    kind: Literal["tailgate"]
    speed: Speeds
    lane: _Lane | None = None
    time_gap: TimeGaps


class CloseUp(Act):
    """Follows at a distance, comes close for a moment now and then, and falls back.

    Attributes:
        kind: `close_up`.
        speed: Of the one ahead, m/s.
        lane: Of both, counted from the outer side; None for the best one.
        distance: The time gap that the one behind keeps.
        time_gap: To which it comes close.
        moment: How long it stays so close.
        pause: How long it keeps its distance in between.
    """

    kind: Literal["close_up"]
    speed: Speeds
    lane: _Lane | None = None
    distance: TimeGaps
    time_gap: TimeGaps
    moment: DurationRange
    pause: DurationRange


class Tail(Act):
    """Comes some time behind somebody and drives the same way, or another.

    Attributes:
        kind: `tail`.
        lag: How long after the other it comes in.
        tail_route: The roads that it passes; None for those of the other.
    """

    kind: Literal["tail"]
    lag: DurationRange
    tail_route: Roads | None = None

    @property
    def routes(self) -> Mapping[str, Roads]:
        """The roads of either, by the key that holds them."""
        own = {} if self.tail_route is None else {"tail_route": self.tail_route}
        return {"route": self.route, **own}

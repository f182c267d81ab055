"""Acts of two drivers of whom one overtakes the other, tries to, or keeps beside it."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from traffic.scenarios.acts.base import Act
from traffic.scenarios.fields import (
    Distances,
    DurationRange,
    Roads,
    Settings,
    Speeds,
    TypeWeights,
)

__all__ = ["AbortOvertake", "DriveBeside", "Oncoming", "Overtake", "Pair"]

_Aside = Annotated[float, Field(ge=-20, le=20)]
_Count = Annotated[int, Field(ge=1, le=20)]


class Pair(Act):
    """What acts of two drivers have in common; the driver of the act comes behind the other.

    Both come in on the same lane. The other keeps its speed unless somebody is in its way.

    Attributes:
        others: Weight of each vehicle type of the other driver.
        speed: Of the other driver, m/s.
        lane: On every road, counted from the outer side.
        place: How far from the begin of the route the other one is when it begins, metres.
        gap: Between the bumpers of the two before it begins, metres.
        aside: How far to the left of the lane one drives beside the other, metres; to the right
            if it is negative.
        going: How long it takes to go aside, and to come back.
    """

    others: TypeWeights
    speed: Speeds
    lane: Annotated[int, Field(ge=0)] = 0
    place: Distances
    gap: Distances
    aside: _Aside
    going: DurationRange

    @property
    def casts(self) -> Mapping[str, TypeWeights]:
        """The weights of vehicle types that the act names, by the key that holds them."""
        return {**super().casts, "others": self.others}


class Oncoming(Settings):
    """Somebody who comes towards a driver that overtakes, too near or far enough away.

    Attributes:
        types: Weight of each vehicle type.
        route: The roads it passes; on the first one, which is that on which the other is
            overtaken in the opposite direction, it appears when the driver goes aside.
        lane: On every road, counted from the outer side.
        speed: m/s.
        spare: How long after the driver begins to come back the two would meet.
    """

    types: TypeWeights
    route: Roads
    lane: Annotated[int, Field(ge=0)] = 0
    speed: Speeds
    spare: DurationRange


class Overtake(Pair):
    """Goes aside, passes the other driver, and comes back in front of it.

    Attributes:
        kind: `overtake`.
        faster: By how much it drives faster than the other, m/s.
        ahead: Gap between the bumpers at which it begins to come back, metres.
        oncoming: Who comes towards it; None for nobody on purpose.
    """

    kind: Literal["overtake"]
    faster: Speeds
    ahead: Distances
    oncoming: Oncoming | None = None

    @property
    def casts(self) -> Mapping[str, TypeWeights]:
        """The weights of vehicle types that the act names, by the key that holds them."""
        met = {} if self.oncoming is None else {"oncoming": self.oncoming.types}
        return {**super().casts, **met}

    @property
    def routes(self) -> Mapping[str, Roads]:
        """The roads that the act names, by the key that holds them."""
        met = {} if self.oncoming is None else {"oncoming": self.oncoming.route}
        return {**super().routes, **met}


class AbortOvertake(Pair):
    """Goes aside, gets beside the other driver, falls back and comes back behind it; repeatedly.

    Attributes:
        kind: `abort_overtake`.
        attempts: How often, the least and the most.
        level: How far in front of the front bumper of the other its own one gets, metres; behind
            it if it is negative.
        faster: By how much it drives faster than the other then, m/s.
        staying: How long it stays level.
        waiting: How long it drives behind between two attempts.
    """

    kind: Literal["abort_overtake"]
    attempts: tuple[_Count, _Count] = (1, 1)
    level: tuple[_Aside, _Aside]
    faster: Speeds
    staying: DurationRange
    waiting: DurationRange


class DriveBeside(Pair):
    """Drives beside the other driver for a while, now a little ahead and now a little behind.

    Attributes:
        kind: `drive_beside`.
        sway: How far ahead and behind, metres.
        period: How long it takes from one to the next time ahead.
        duration: How long.
    """

    kind: Literal["drive_beside"]
    sway: Distances
    period: DurationRange
    duration: DurationRange

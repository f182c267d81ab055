"""Every kind of manoeuvre that the truth knows, and how it is compared with recognitions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from dyknow.time import SECOND, Duration
from networks.roads import RoadMap
from networks.turns import Turn
from traffic.truth.aborted_overtakes import AbortedOvertakeWatcher
from traffic.truth.facing_traffic import FacingTrafficWatcher
from traffic.truth.following import CONVOY, TAILGATING, FollowedWatcher, FollowingWatcher
from traffic.truth.manoeuvres import Watcher
from traffic.truth.near_collisions import NearCollisionWatcher
from traffic.truth.overtakes import OvertakeWatcher
from traffic.truth.parking import ParkingWatcher
from traffic.truth.red_lights import RedLightWatcher
from traffic.truth.standing import StandingWatcher
from traffic.truth.turns import TurnWatcher
from traffic.truth.weaving import WeavingWatcher
from traffic.truth.wrong_way import WrongWayWatcher

__all__ = ["WATCHERS", "Definition"]

_MARGIN = Duration(2 * SECOND)
_TOLERANCE = Duration(3 * SECOND)


@dataclass(frozen=True, slots=True)
class Definition:
    """Who finds the manoeuvres of a kind, and how they are compared with recognitions.

    Attributes:
        watcher: Makes what finds them on a map; kinds with the same one share what it makes.
        score: The line of the score in which they count, if several kinds share one; by default
            the kind itself.
        margin: A manoeuvre has been seen if its vehicles were in view from so long before it to
            so long after: a turn needs the links it leads from and to, an overtake being behind
            and being in front.
        part: Of what may go on for long, such as a convoy, how much must have been in view, with
            the margin; None if all of it must.
        tolerance: How far apart in time a recognition and the manoeuvre that explains it may be.
    """

    watcher: Callable[[RoadMap], Watcher]
    score: str | None = None
    margin: Duration = _MARGIN
    part: Duration | None = None
    tolerance: Duration = _TOLERANCE


WATCHERS: Mapping[str, Definition] = {
    **{f"turn_{turn.value}": Definition(TurnWatcher.on, score="turn") for turn in Turn},
    "overtake": Definition(OvertakeWatcher.on),
    "overtake_left": Definition(OvertakeWatcher.on),
    "overtake_right": Definition(OvertakeWatcher.on),
    "overtake_aborted": Definition(AbortedOvertakeWatcher.on),
    "overtake_wrong_side": Definition(OvertakeWatcher.on),
    "overtake_facing_traffic": Definition(FacingTrafficWatcher),
    "overtake_again_and_again": Definition(AbortedOvertakeWatcher.on),
    "tailgating": Definition(FollowingWatcher, part=TAILGATING),
    "convoy": Definition(FollowingWatcher, part=CONVOY),
    "followed": Definition(FollowedWatcher.on),
    "weaving": Definition(WeavingWatcher.on),
    "parking_beside_building": Definition(ParkingWatcher),
    "near_collision": Definition(NearCollisionWatcher),
    "red_light": Definition(RedLightWatcher.on),
    "stop_in_crossing": Definition(StandingWatcher),
    "wrong_way": Definition(WrongWayWatcher),
}
"""By kind, in the order in which scores are shown."""

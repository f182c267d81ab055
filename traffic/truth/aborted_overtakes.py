"""The overtakes that were truly begun and broken off, and who does so again and again."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dyknow.time import MINUTE, Duration, TimePoint
from networks.roads import RoadMap
from traffic.sumo.simulation import Frame
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.overtakes import aside_of, neighbours
from traffic.truth.places import TruePlaces

__all__ = ["AbortedOvertakeWatcher"]

_REACH = 60.0
_CLEARANCE = 1.0
_IN_LINE = 1.6
_MOVING = 3.0
_LONGEST: Duration = MINUTE
_TIMES = 3
_TOGETHER = Duration(2 * MINUTE)

_Pair = tuple[int, int]


@dataclass(slots=True)
class _Attempt:
    """How far one vehicle has come with overtaking another.

    Attributes:
        begin: The last frame in which it was behind the other and in line with it.
        is_out: Whether it has left the line since.
        was_level: Whether it has been level with the other since it left the line.
    """

    begin: TimePoint
    is_out: bool = False
    was_level: bool = False


class AbortedOvertakeWatcher:
    """Watches who leaves the line behind another one, gets level, and comes back behind it.

    A is *behind* B if its centre is behind B's by at least half of both lengths and 1 m, along
    the link on which both travel the same way, at most 60 m apart; it is *level* if neither is
    behind the other; it is *in line* if its centre is less than 1.6 m to the left or right of
    B's. An `overtake_aborted` begins in the last frame in which A is behind B and in line before
    it leaves the line, and ends in the first one in which it is so again, at most 60 s later. It
    was level in between, and never in front, and both were faster than 3 m/s all the while.

    When three of them by one vehicle end within two minutes, that is an
    `overtake_again_and_again`, from the end of the first to that of the third; the next one
    counts from anew.
    """

    def __init__(self) -> None:
        self._attempts: dict[_Pair, _Attempt] = {}
        self._ends: defaultdict[int, list[TimePoint]] = defaultdict(list)

    @classmethod
    def on(cls, _: RoadMap) -> "AbortedOvertakeWatcher":
        """Return a watcher, which is the same for every map."""
        return cls()

    def observe(self, frame: Frame, places: TruePlaces) -> list[TrueManoeuvre]:
        """Take in a frame and return what was broken off with it."""
        before, self._attempts = self._attempts, {}
        found: list[TrueManoeuvre] = []
        for pair, is_behind, is_in_line in _placed(frame, places):
            found += self._follow(frame.time, pair, before.get(pair), (is_behind, is_in_line))
        return found

    def finish(self) -> list[TrueManoeuvre]:
        """Return nothing: who is beside another at the end may still overtake it."""
        return []

    def _follow(
        self, time: TimePoint, pair: _Pair, attempt: _Attempt | None, now: tuple[bool, bool]
    ) -> Iterator[TrueManoeuvre]:
        """Go on with the attempt of a pair, which is behind and in line *now*, or not."""
        is_behind, is_in_line = now
        if is_behind and is_in_line:
            if attempt is not None and attempt.was_level and time - attempt.begin <= _LONGEST:
                yield TrueManoeuvre("overtake_aborted", pair, (), attempt.begin, time)
                yield from self._count(time, pair[0])
            self._attempts[pair] = _Attempt(time)
        elif attempt is not None:
            is_out = attempt.is_out or not is_in_line
            has_come_back = attempt.is_out and is_in_line
            if is_out and not has_come_back:
                was_level = attempt.was_level or not is_behind
                self._attempts[pair] = _Attempt(attempt.begin, is_out, was_level)

    def _count(self, time: TimePoint, vehicle: int) -> Iterator[TrueManoeuvre]:
        ends = [end for end in self._ends[vehicle] if time - end <= _TOGETHER] + [time]
        if len(ends) == _TIMES:
            yield TrueManoeuvre("overtake_again_and_again", (vehicle,), (), ends[0], time)
            ends = []
        self._ends[vehicle] = ends


def _placed(frame: Frame, places: TruePlaces) -> Iterator[tuple[_Pair, bool, bool]]:
    """Yield all moving pairs near each other, unless the first is clearly in front.

    Yields:
        The ids, whether the first is clearly behind the second, and whether it is in line.
    """
    vehicles = frame.vehicles
    behind, ahead = neighbours(places, _REACH)
    fast = vehicles["speed"] > _MOVING
    both = fast[behind] & fast[ahead]
    behind, ahead = behind[both], ahead[both]
    gap = places.progress[ahead] - places.progress[behind]
    clear = gap >= (vehicles["length"][behind] + vehicles["length"][ahead]) / 2 + _CLEARANCE
    in_line = np.abs(aside_of(vehicles, behind, ahead)) < _IN_LINE
    first, second = vehicles.ids[behind].tolist(), vehicles.ids[ahead].tolist()
    for one, other, is_behind, is_in_line in zip(
        first, second, clear.tolist(), in_line.tolist(), strict=True
    ):
        yield (one, other), is_behind, is_in_line
        if not is_behind:
            yield (other, one), False, is_in_line

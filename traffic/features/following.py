"""Who follows whom, and who does so too closely.

Relations between a car and the next one ahead of it on its lane, with hysteresis. What makes a
relation true is stricter than what keeps it true, and either has to be so by more than the
uncertainty of what is compared: an uncertain estimate changes nothing.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table, positions_of
from dyknow.time import SECOND, Duration, TimePoint
from networks.geometry import group_ranges
from traffic.features.carrying import CarriedColumns
from traffic.features.pairs import pair_id

__all__ = ["FOLLOWING", "Following"]

FOLLOWING = ("follows", "tailgates")

Truths = npt.NDArray[np.bool_]

_DETOUR = 1.0
"""Metres; a way over a third car that is longer by less is the same way."""

_SLACK = 1.25
"""What keeps a relation true may be so much more than what makes it true."""

_SURER = 2.0
"""Times the certainty with which tailgating begins: the estimated speed of who closes up, and
brakes, is late, so that the time gap seems to be short before it is."""


class Following(Reactive):
    """Computes of each pair of cars, one behind the other, whether the first follows the second.

    One table comes out for each table of headways that goes in.

    * `follows`: the second car is the next one ahead on the lane of the first, which means that
      nobody drives on the way between them, at a time gap of at most *near*, and both are faster
      than *moving*;
    * `tailgates`: it is the next one ahead at a time gap of less than *close*, and the first car
      is faster than *fast*.

    A relation that is true stays so up to a time gap one and a quarter times as long, and down to
    speeds one and a quarter times lower. Time gaps, places in the lane and the speed of a
    tailgater count with *certainty* standard deviations against every change; time gaps with twice
    as many against the begin of tailgating. Cars are in one lane if they are at most *offset*
    aside. Where ways part, a car may have a next one on each of them.

    Args:
        near: Time gap up to which a car follows.
        close: Time gap below which a car tailgates.
        moving: Speed of a car that follows or is followed, m/s.
        fast: Speed of a car that tailgates, m/s.
        offset: Half of a lane, metres.
        certainty: Standard deviations.
    """

    def __init__(
        self,
        *,
        near: Duration,
        close: Duration,
        moving: float,
        fast: float,
        offset: float,
        certainty: float,
    ) -> None:
        if not 0 < close <= near:
            raise ValueError(f"expected 0 < close <= near, found {close} and {near}")
        self._near = near / SECOND
        self._close = close / SECOND
        self._moving = moving
        self._fast = fast
        self._offset = offset
        self._certainty = certainty
        self._state = CarriedColumns(dict.fromkeys(("same_lane", *FOLLOWING), np.False_))

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the relations of the newest table of headways."""
        (sample,) = inputs
        headways: Table = sample.value
        self._state.align(headways.ids)
        speed, margin = headways["speed"], self._certainty * headways["speed_deviation"]
        slower = np.minimum(speed, headways["speed_of_second"])
        time_gap, deviation = headways["time_gap"], headways["deviation"]
        at_least = time_gap - self._certainty * deviation
        at_most = time_gap + self._certainty * deviation
        surely_at_most = time_gap + _SURER * self._certainty * deviation
        is_next = self._next_ahead(headways, at_least <= _SLACK * self._near)
        self._hold(
            "follows",
            is_next & (at_most <= self._near) & (slower > self._moving),
            is_next & (at_least <= _SLACK * self._near) & (_SLACK * slower > self._moving),
        )
        self._hold(
            "tailgates",
            is_next & (surely_at_most < self._close) & (speed - margin > self._fast),
            is_next & (at_least < _SLACK * self._close) & (_SLACK * (speed + margin) > self._fast),
        )
        relations = {name: self._state[name] for name in FOLLOWING}
        columns = {"first": headways["first"], "second": headways["second"], **relations}
        yield Sample(Table("following", headways.ids, columns), sample.valid_time, now)

    def _next_ahead(self, headways: Table, asked: Truths) -> Truths:
        """Return in which of the pairs asked for the second car is the next one on the lane."""
        aside, margin = headways["aside"], self._certainty * headways["aside_deviation"]
        self._hold(
            "same_lane",
            aside + margin <= self._offset,
            aside - margin <= _SLACK * self._offset,
        )
        (rows,) = np.nonzero(self._state["same_lane"])
        is_next = self._state["same_lane"] & asked
        is_next[rows] &= ~_someone_between(headways.select(rows), asked[rows])
        return is_next

    def _hold(self, name: str, begins: Truths, stays: Truths) -> None:
        self._state[name] = begins | (self._state[name] & stays)


def _someone_between(headways: Table, asked: Truths) -> Truths:
    """Return in which of the pairs asked for a third car drives on the way between the two."""
    first, second, ahead = headways["first"], headways["second"], headways["ahead"]
    cars, car = np.unique(first, return_inverse=True)
    reach = np.zeros(len(cars))
    np.maximum.at(reach, car[asked], ahead[asked])
    (legs,) = np.nonzero(ahead <= reach[car] + _DETOUR)  # to cars that may be in between
    order = np.argsort(first, kind="stable")
    begin, end = (np.searchsorted(first[order], second[legs], side=s) for s in ("left", "right"))
    near = np.repeat(legs, end - begin)
    far = order[group_ranges(begin, end - begin)]  # from there on
    whole = positions_of(pair_id(first[near], second[far]), headways.ids)
    on_way = (whole >= 0) & (ahead[near] + ahead[far] <= ahead[whole] + _DETOUR)
    between = np.zeros(len(first), dtype=np.bool_)
    between[whole[on_way]] = True
    return between

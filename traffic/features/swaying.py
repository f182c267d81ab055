"""How cars sway: the swings of each car from one side to the other.

A swing is a movement to one side, across the road, that is wider than noise and narrower than
a change of lanes. Who sways goes left and right in turn; others keep straight, change lanes, or
go around something once.
"""

from collections.abc import Iterable
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, Duration, TimePoint
from traffic.features.carrying import CarriedColumns

__all__ = ["SWINGS", "Swaying"]

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

SWINGS: Final = ("left", "right")
"""The column `swing` holds positions in this tuple, -1 for none."""

_NONE, _LEFT, _RIGHT = -1, 0, 1


class Swaying(Reactive):
    """Tells to which side each car swings; one table comes out for each one that goes in.

    The only column is `swing`. It becomes `left` when a car is further to the left than it has
    been lately, by at least *least* metres and *certainty* standard deviations of where it is
    across the road, `right` likewise, and keeps that value until the car swings to the other
    side. It becomes `no_swing` when the car

    * goes on for more than *most* metres to one side: it changes lanes;
    * swings to no side for the duration *rest*;
    * is slower than *moving* m/s, gets into a crossing, or travels on another link.

    What is slower than *drift* is no swing but how the car follows its lane. Where a road ends and
    the next begins, places across the roads are joined. Unobserved cars stay as they are.

    Args:
        least: Metres from the one side to the other.
        most: Metres.
        rest: Duration.
        moving: m/s.
        drift: m/s across the road.
        certainty: Standard deviations.
    """

    def __init__(
        self,
        *,
        least: float,
        most: float,
        rest: Duration,
        moving: float,
        drift: float,
        certainty: float,
    ) -> None:
        self._least, self._most = least, most
        self._rest = rest
        self._moving = moving
        self._drift = drift
        self._certainty = certainty
        self._state = CarriedColumns(
            {
                "swing": np.int8(_NONE),
                "low": np.float64(0),
                "high": np.float64(0),
                "offset": np.float64(0),
                "d": np.float64(0),
                "road": np.int32(-1),
                "link": np.int32(-1),
                "turned_at": np.int64(0),
                "seen_at": np.int64(0),
            }
        )

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the swings of the newest table of cars."""
        (sample,) = inputs
        cars: Table = sample.value
        time = sample.valid_time
        state = self._state
        is_new = state.align(cars.ids)
        observed: Flags = cars["observed"]
        across = self._joined(cars, observed, is_new=is_new)
        way = 2 * cars["link_of_road"].astype(np.int32) + (cars["direction_in_link"] > 0)
        is_other = (way != state["link"]) | (cars["link_of_road"] < 0)
        rests = time - state["turned_at"] > self._rest
        begins = is_new | is_other | (cars["speed"] < self._moving)
        begins |= rests & (state["swing"] != _NONE)
        self._leak((time - state["seen_at"]) / SECOND)
        self._begin(across, begins & observed)
        self._swing(across, np.sqrt(cars["d_variance"]), observed & ~begins, time)
        state["link"] = np.where(observed, way, state["link"])
        state["seen_at"] = np.full(len(cars), time)
        yield Sample(Table("car", cars.ids, {"swing": state["swing"]}), time, now)

    def _joined(self, cars: Table, observed: Flags, *, is_new: Flags) -> Floats:
        """Return where each car is across its road, without jumps from road to road."""
        state = self._state
        d, road = cars["d"], cars["road"]
        jump = np.where(observed & ~is_new & (road != state["road"]), state["d"] - d, 0.0)
        state["offset"] = state["offset"] + jump
        state["d"] = np.where(observed, d, state["d"])
        state["road"] = np.where(observed, road, state["road"])
        joined: Floats = d + state["offset"]
        return joined

    def _leak(self, elapsed: Floats) -> None:
        """Let the sides that are remembered come nearer."""
        self._state["low"] = self._state["low"] + self._drift * elapsed
        self._state["high"] = self._state["high"] - self._drift * elapsed

    def _begin(self, across: Floats, which: Flags) -> None:
        """Forget all swings of some cars."""
        state = self._state
        state["swing"] = np.where(which, np.int8(_NONE), state["swing"])
        state["low"] = np.where(which, across, state["low"])
        state["high"] = np.where(which, across, state["high"])

    def _swing(self, across: Floats, deviation: Floats, which: Flags, time: TimePoint) -> None:
        """Take in where some cars are now."""
        state = self._state
        least = self._least + self._certainty * deviation
        low = np.minimum(state["low"], across)
        high = np.maximum(state["high"], across)
        swing = state["swing"]
        leftwards = which & (swing != _LEFT) & (across - low >= least)
        rightwards = which & (swing != _RIGHT) & (high - across >= least) & ~leftwards
        turned = leftwards | rightwards
        # While a car swings to one side, the other side of its path is where that swing began.
        state["low"] = np.where(which, low, state["low"])
        state["high"] = np.where(which, high, state["high"])
        state["high"] = np.where(leftwards, across, state["high"])
        state["low"] = np.where(rightwards, across, state["low"])
        side = np.where(leftwards, _LEFT, _RIGHT)
        state["swing"] = np.where(turned, side, swing).astype(np.int8)
        state["turned_at"] = np.where(turned, time, state["turned_at"])
        too_wide = which & (state["high"] - state["low"] > self._most)
        self._begin(across, too_wide)

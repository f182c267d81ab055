"""Qualitative spatial relations between two cars, relative to the road.

The relations of Heintz (2009), section 8.7.5, are taken along and across the road instead of
from the direction between the cars, so that they hold in bends too. Each of them changes when
the estimated places say so by enough standard deviations, and is dated back to when they
began to say so (`traffic.features.decisions`). So noise in the positions makes relations late,
but neither wrong nor flickering, and without noise they are what the positions say.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint
from networks.roads import RoadMap
from traffic.features.decisions import Codes, Decisions
from traffic.features.stability import UNKNOWN

__all__ = ["RELATIONS", "CarRelations"]

RELATIONS = (
    "behind", "in_front", "left", "right", "in_line", "beside", "beside_left", "beside_right",
    "beside_wrong", "close",
)  # fmt: skip

Floats = npt.NDArray[np.float64]

_N_DECIDED = 6

_LEAST_DEVIATION = 0.25
"""Metres by which a distance between two cars is uncertain at least, however good the percepts
are: a shape is not quite a rectangle, and a map not quite the road."""


class CarRelations(Reactive):
    """Computes the qualitative relations of each pair of cars.

    For each table of pairs one comes out that is valid *within* earlier. For a pair (first,
    second), with the gap between bumpers along the road:

    * `behind`: the first car is behind the second, gap at least *gap*;
    * `in_front`: the same with the roles exchanged;
    * `left`, `right`: the first car is to the left (right) of the second by at least *offset*;
    * `in_line`: neither left nor right;
    * `beside`: neither behind nor in front, and not known to be in line with the other: two
      bodies cannot be in one place, so who is level with another is beside it, unless the
      two symbols have been mixed up;
    * `beside_left`, `beside_right`: beside, and more to the left (right) than not;
    * `beside_wrong`: beside on the side on which one does not overtake, the right one where one
      drives on the right;
    * `close`: the gap is below *near*.

    A relation is unknown until it is certain, and while one of those is that it is made of.

    Args:
        roads: The road network.
        gap: Metres between bumpers.
        offset: Metres between centre lines.
        near: Metres between bumpers.
        certainty: Standard deviations from which an estimate is believed.
        within: How long it may take to become certain.
    """

    def __init__(
        self,
        roads: RoadMap,
        *,
        gap: float,
        offset: float,
        near: float,
        certainty: float,
        within: Duration,
    ) -> None:
        self._wrong = "beside_left" if roads.left_hand else "beside_right"
        self._gap = gap
        self._offset = offset
        self._near = near
        self._certainty = certainty
        self._decisions = Decisions(_N_DECIDED, certainty=certainty, within=within)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the relations on which the newest table of pairs decides."""
        (sample,) = inputs
        pairs: Table = sample.value
        evidence = self._evidence(pairs)
        for time, table, codes in self._decisions.push(sample.valid_time, pairs, evidence):
            yield Sample(self._relations(table, codes), time, now)

    def _evidence(self, pairs: Table) -> Floats:
        """Return the evidence for behind, in front, left, right, more to the left, and close."""
        along = np.hypot(pairs["ahead_deviation"], _LEAST_DEVIATION)
        across = np.hypot(pairs["left_deviation"], _LEAST_DEVIATION)
        gap_ahead = pairs["ahead"] - pairs["clearance"]
        gap_back = -pairs["ahead"] - pairs["clearance"]
        left = pairs["left"]
        return np.stack(
            (
                (gap_ahead - self._gap) / along,
                (gap_back - self._gap) / along,
                (left - self._offset) / across,
                (-left - self._offset) / across,
                left / across,
                (self._near - np.maximum(gap_ahead, gap_back)) / along,
            ),
            axis=1,
        )

    def _relations(self, pairs: Table, codes: Codes) -> Table:
        behind, in_front, left, right, side, close = codes.T
        beside = _neither(behind, in_front)
        beside = np.where((beside == 1) & self._is_in_line(pairs), 0, beside)
        found = {
            "behind": behind,
            "in_front": in_front,
            "left": left,
            "right": right,
            "in_line": _neither(left, right),
            "beside": beside,
            "beside_left": _both(beside, side),
            "beside_right": _both(beside, _opposite(side)),
            "close": close,
        }
        found["beside_wrong"] = found[self._wrong]
        columns = {name: found[name].astype(np.int32) for name in RELATIONS}
        ends = {"first": pairs["first"], "second": pairs["second"]}
        return Table("car_relation", pairs.ids, {**ends, **columns})

    def _is_in_line(self, pairs: Table) -> npt.NDArray[np.bool_]:
        """Return which cars are known to be no farther aside than the offset at this time."""
        across = np.hypot(pairs["left_deviation"], _LEAST_DEVIATION)
        in_line: npt.NDArray[np.bool_] = (
            np.abs(pairs["left"]) + self._certainty * across < self._offset
        )
        return in_line


def _opposite(truth: Codes) -> Codes:
    return np.where(truth == UNKNOWN, UNKNOWN, 1 - truth).astype(np.int32)


def _both(one: Codes, other: Codes) -> Codes:
    """Return whether both are true; false if one is false, whatever is known of the other."""
    unknown = (one == UNKNOWN) | (other == UNKNOWN)
    false = (one == 0) | (other == 0)
    return np.where(false, 0, np.where(unknown, UNKNOWN, 1)).astype(np.int32)


def _neither(one: Codes, other: Codes) -> Codes:
    return _both(_opposite(one), _opposite(other))

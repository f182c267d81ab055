"""Candidates for being linked again: pairs of an unlinked lower and an unlinked upper object.

For each such pair the reestablish condition is evaluated from the moment at which both are
unlinked (Heintz 2009, figure 8.4). Not all pairs are looked at. Beyond a certain distance, the
*reach*, every comparison of the distance with a number is as true as infinitely far away. Pairs of
one lower object that were always beyond it, and that began at the same time, have one residual in
common, as long as it does not matter what else is true of the upper objects. A pair gets a
residual of its own, which inherits the common one, when it first comes within reach or when
something else begins to matter. What comes out is the same as if all pairs were evaluated.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from anchoring.conditions import Condition
from anchoring.links import LinkUnit
from anchoring.motion import Floats
from anchoring.rows import Mask, Rows
from dyknow.mtl.monitors import MonitorColumns
from dyknow.streams.table import Ids, Table, positions_of
from dyknow.time import Duration, TimePoint

__all__ = ["Candidates", "Unlinked", "best_pairs"]

Steps = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Unlinked:
    """Objects without a link, and the number of the first state that their conditions are about.

    Attributes:
        table: The states of the objects.
        since: shape (n,), the number of a state.
    """

    table: Table
    since: Steps


class Candidates:
    """Evaluates the reestablish condition for all pairs of unlinked objects."""

    def __init__(self, condition: Condition, unit: LinkUnit) -> None:
        self._condition = condition
        self._unit = unit
        self._pairs = MonitorColumns(condition.table)
        self._lower: Ids = np.empty(0, dtype=np.int64)
        self._upper: Ids = np.empty(0, dtype=np.int64)
        self._begin: Steps = np.empty(0, dtype=np.int64)
        self._far = MonitorColumns(condition.table)
        self._far_lower: Ids = np.empty(0, dtype=np.int64)
        self._far_begin: Steps = np.empty(0, dtype=np.int64)
        self._time: TimePoint | None = None

    def step(
        self, now: TimePoint, step: int, lower: Unlinked, upper: Unlinked
    ) -> tuple[Rows, Rows]:
        """Take in one state and return the rows of *lower* and *upper* to be linked.

        Each row occurs at most once. Pairs become true at the same time as others are chosen by
        `best_pairs`.
        """
        if self._condition.is_false:
            return _NO_ROWS, _NO_ROWS
        if not len(lower.table) + len(self._lower) + len(self._far_lower):
            self._time = now
            return _NO_ROWS, _NO_ROWS
        self._keep(lower, upper)
        self._begin_far(step, lower, upper)
        self._add(lower, upper, *self._within_reach(lower.table, upper.table))
        self._step_far(now, lower, upper)
        self._time = now
        rows = self._rows(lower, upper)
        pairs = lower.table.select(rows[0]), upper.table.select(rows[1])
        true = self._pairs.step(now, self._condition.truth(*pairs)) > 0
        rows = rows[0][true], rows[1][true]
        if not len(rows[0]):
            return rows
        chosen = lower.table.select(rows[0]), upper.table.select(rows[1])
        return best_pairs(*rows, *self._condition.separation(*chosen))

    def _keep(self, lower: Unlinked, upper: Unlinked) -> None:
        """Drop the pairs of which an object is gone, or was linked in the meantime."""
        at, on = self._rows(lower, upper)
        kept = (at >= 0) & (on >= 0)
        begin = np.maximum(lower.since[at[kept]], upper.since[on[kept]])
        kept[kept] = begin == self._begin[kept]
        self._pairs.keep(kept)
        self._lower, self._upper = self._lower[kept], self._upper[kept]
        self._begin = self._begin[kept]
        at = positions_of(self._far_lower, lower.table.ids)
        self._keep_far(at >= 0)
        since = lower.since[at[at >= 0]]
        later = (self._far_begin > since) & np.isin(self._far_begin, upper.since)
        self._keep_far((self._far_begin == since) | later)

    def _keep_far(self, kept: Mask) -> None:
        self._far.keep(kept)
        self._far_lower, self._far_begin = self._far_lower[kept], self._far_begin[kept]

    def _begin_far(self, step: int, lower: Unlinked, upper: Unlinked) -> None:
        """Begin a common residual for the pairs that begin with this state."""
        begins = (
            np.ones(len(lower.since), dtype=np.bool_)
            if (upper.since == step).any()
            else lower.since == step
        )
        new = lower.table.ids[begins]
        self._far.add(len(new))
        self._far_lower = np.concatenate((self._far_lower, new))
        self._far_begin = np.concatenate((self._far_begin, np.full(len(new), step)))

    def _within_reach(self, lower: Table, upper: Table) -> tuple[Rows, Rows]:
        """Return the rows of all pairs that are not farther apart than the reach."""
        if not len(lower) or not len(upper):
            return _NO_ROWS, _NO_ROWS
        points, rows = self._unit.places(upper)
        near = cKDTree(lower["position"]).sparse_distance_matrix(
            cKDTree(points), self._condition.reach, output_type="ndarray"
        )
        pairs = np.unique(near["i"] * len(upper) + rows[near["j"]])
        return pairs // len(upper), pairs % len(upper)

    def _add(self, lower: Unlinked, upper: Unlinked, at: Rows, on: Rows) -> None:
        """Give a residual of their own to the pairs of these rows that have none yet."""
        first, second = lower.table.ids[at], upper.table.ids[on]
        begin = np.maximum(lower.since[at], upper.since[on])
        source = _find(self._far_lower, self._far_begin, first, begin)
        new = (source >= 0) & (_find(self._lower, self._upper, first, second) < 0)
        rows = self._pairs.add(int(new.sum()))
        self._pairs.residuals[rows] = self._far.residuals[source[new]]
        self._lower = np.concatenate((self._lower, first[new]))
        self._upper = np.concatenate((self._upper, second[new]))
        self._begin = np.concatenate((self._begin, begin[new]))

    def _step_far(self, now: TimePoint, lower: Unlinked, upper: Unlinked) -> None:
        """Take in one state for all pairs that have a residual in common."""
        at = positions_of(self._far_lower, lower.table.ids)
        far = lower.table.select(at)
        elapsed = Duration(1) if self._time is None else Duration(now - self._time)
        table, residuals = self._condition.table, self._far.residuals
        following = [
            table.progress(residuals, truth, elapsed)
            for truth in self._condition.truth_beyond_reach(far)
        ]
        apart = np.any([other != following[0] for other in following], axis=0)
        apart |= table.verdicts(following[0]) > 0
        for row in np.flatnonzero(apart):
            begin = np.maximum(lower.since[at[row]], upper.since)
            on = np.flatnonzero(begin == self._far_begin[row])
            self._add(lower, upper, np.full(len(on), at[row]), on)
        self._far.residuals = following[0]
        self._keep_far(~apart & (table.verdicts(following[0]) == 0))

    def _rows(self, lower: Unlinked, upper: Unlinked) -> tuple[Rows, Rows]:
        return (
            positions_of(self._lower, lower.table.ids),
            positions_of(self._upper, upper.table.ids),
        )


def best_pairs(at: Rows, on: Rows, separation: Floats, gate: float) -> tuple[Rows, Rows]:
    """Return which of the pairs (at[i], on[i]) to take, so that no number occurs twice.

    The sum of squared separations is least, where each left-out member of *at* counts as one pair
    separated by *gate*, or by more if some pair is. The nearest pairs win, and a row of vehicles
    that all have moved on by the same amount is not shifted by one.
    """
    first, row = np.unique(at, return_inverse=True)
    second, column = np.unique(on, return_inverse=True)
    limit = max(gate, 1.01 * float(separation.max()) + 0.01)
    forbidden = 4 * limit**2 + 1
    cost = np.full((len(first), len(second) + len(first)), forbidden)
    cost[:, len(second) :] = limit**2
    cost[row, column] = separation**2
    chosen_row, chosen_column = linear_sum_assignment(cost)
    paired = chosen_column < len(second)
    return first[chosen_row[paired]], second[chosen_column[paired]]


def _find(first: Ids, second: Ids, wanted_first: Ids, wanted_second: Ids) -> Rows:
    """Return where each wanted pair stands among the pairs (first[i], second[i]), or -1."""
    return positions_of(_key(wanted_first, wanted_second), _key(first, second))


def _key(first: Ids, second: Ids) -> Ids:
    """Return one number for two that are below 2³¹."""
    return (first << np.int64(32)) | second


_NO_ROWS: Rows = np.empty(0, dtype=np.intp)

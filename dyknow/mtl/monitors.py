"""Monitors: a formula followed along one stream of states, or along many at once.

Both rest on a `ProgressionTable`, which several of them may share, and which knows the time
model (see `dyknow.mtl.semantics`).
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.errors import StateOrderError
from dyknow.mtl.decisions import Times
from dyknow.mtl.products import taken_apart
from dyknow.mtl.progression import ProgressionTable, Residuals, Truths, Verdicts
from dyknow.mtl.rules import NEVER, Shape
from dyknow.mtl.syntax import Formula, TimeModel, Verdict
from dyknow.time import Duration, TimePoint

__all__ = ["Monitor", "MonitorColumns", "check_order"]


class MonitorColumns:
    """One formula followed for many objects or pairs, which come and go; one row for each.

    Rows are numbered from 0 in the order in which they were added. `keep` closes the gaps, as
    selecting rows of a table with the same mask does. The formula of a row is about the states
    from the first `step` after the row was added (or restarted). A decided row keeps its verdict.

    Attributes:
        table: The formula and its residuals; may be shared with other monitors.
        residuals: shape (n,), the number of each row's residual in *table*.
    """

    def __init__(self, table: ProgressionTable) -> None:
        self.table = table
        self.residuals: Residuals = np.empty(0, dtype=np.int64)
        self._time: TimePoint | None = None
        table.register(self)

    def __len__(self) -> int:
        return len(self.residuals)

    def add(self, count: int) -> npt.NDArray[np.intp]:
        """Append *count* rows, in which no state has been seen, and return their numbers."""
        first = len(self.residuals)
        new = np.full(count, self.table.initial, dtype=np.int64)
        self.residuals = np.concatenate((self.residuals, new))
        return np.arange(first, first + count, dtype=np.intp)

    def keep(self, rows: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> None:
        """Keep the rows for which a mask is true, or those with the given numbers, in order."""
        self.residuals = self.residuals[rows]

    def restart(self, rows: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> None:
        """Let the formula of these rows begin anew with the next state."""
        self.residuals[rows] = self.table.initial

    def step(self, now: TimePoint, truth: Truths) -> Verdicts:
        """Take in the states of all rows at *now* and return the verdict of each row.

        Args:
            now: The time of the states, later than that of the step before.
            truth: shape (n_atoms, n), bool, the truth of `table.atoms` in each row, as
                `dyknow.mtl.columns.evaluate_atoms` computes it.

        Returns:
            shape (n,), int8: 1 true, 0 undecided, -1 false (`Verdict`).
        """
        elapsed = _elapsed(self._time, now)
        self.residuals = self.table.progress(self.residuals, truth, elapsed)
        self._time = now
        verdicts = self.table.verdicts(self.residuals)
        self.table.collect_when_full()
        return verdicts

    @property
    def verdicts(self) -> Verdicts:
        """The present verdict of each row, shape (n,), int8."""
        return self.table.verdicts(self.residuals)

    def residual(self, row: int) -> Formula:
        """Return what must hold from now on in one row."""
        return self.table.residual(int(self.residuals[row]))


class Monitor:
    """One formula followed along one stream of states.

    Attributes:
        table: The formula and its residuals; may be shared with other monitors.
    """

    def __init__(
        self,
        formula: Formula | ProgressionTable,
        time_model: TimeModel | str = TimeModel.HOLD,
    ) -> None:
        """Begin before the first state; a table given has a time model already."""
        if not isinstance(formula, ProgressionTable):
            formula = ProgressionTable(formula, time_model=time_model)
        self.table: ProgressionTable = formula
        self._product = taken_apart(formula)
        whole = formula.rules.initial
        self._shape: Shape = whole if self._product is None else self._product.initial
        self._past: Times = (NEVER,)

    def step(self, now: TimePoint, state: Mapping[str, Any]) -> Verdict:
        """Take in the state at *now*, later than the one before, and return the verdict.

        Args:
            now: The time of the state.
            state: The features by their printed terms; more than needed may be given. When the
                formula is decided, none are needed.

        Raises:
            FeatureError: A feature is missing, of the wrong kind, or NaN; nothing has changed.
            StateOrderError: The state is not later than the one before; nothing has changed.
        """
        shape, past = self._shape, self._past
        if now <= past[0]:
            raise StateOrderError(now, TimePoint(past[0]))
        bits = 0 if shape.verdict else self.table.columns.of_state(state)
        following = shape[bits](now, past) or self._learn(bits, now)
        self._shape, self._past = following
        return following[0].verdict

    def step_bits(self, now: TimePoint, bits: int) -> Verdict:
        """Take in a state as `step` does; bit i of *bits* is the truth of `table.atoms[i]`."""
        # The same as above, without a call between the two: this is where monitors spend time.
        past = self._past
        if now <= past[0]:
            raise StateOrderError(now, TimePoint(past[0]))
        following = self._shape[bits](now, past) or self._learn(bits, now)
        self._shape, self._past = following
        return following[0].verdict

    def _learn(self, bits: int, now: TimePoint) -> tuple[Shape, Times]:
        return self.table.rules.learn(self._shape, self._past, bits, now)

    @property
    def verdict(self) -> Verdict:
        """The present verdict."""
        return self._shape.verdict

    @property
    def residual(self) -> Formula:
        """What must hold from now on."""
        if self._product is not None:
            return self._product.formula_left(self._shape)
        return self.table.formula_left(self._shape, self._past)


def _elapsed(last: TimePoint | None, now: TimePoint) -> Duration:
    """Return the time since the last state; one nanosecond if there was none."""
    check_order(last, now)
    return Duration(1 if last is None else now - last)


def check_order(last: TimePoint | None, now: TimePoint) -> None:
    """Raise `StateOrderError` unless *now* is later than *last*, if there was a last state."""
    if last is not None and now <= last:
        raise StateOrderError(now, last)

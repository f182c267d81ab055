"""Progression of one formula for many objects at once, by tables that are filled in lazily.

Residuals are numbered. A step looks up, for each object, (residual, truth of the atoms) in the
table for the time that has elapsed, and only pairs that no object has shown before are worked
out, by the rules that have been learnt (`dyknow.mtl.rules`). With steady sampling the tables are
soon complete and a step is one `numpy.take`; with irregular sampling each elapsed time has a
table of its own, of which the last few are kept, and a step costs some microseconds more for
each different pair.
"""

from collections import OrderedDict
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol
from weakref import WeakSet

import numpy as np
import numpy.typing as npt

from dyknow.mtl.check import check
from dyknow.mtl.columns import AtomColumns
from dyknow.mtl.decisions import Times
from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.rules import NEVER, RuleBook, Shape
from dyknow.mtl.syntax import FALSE, TRUE, Atom, Formula, TimeModel, Verdict
from dyknow.mtl.wording import formula_from_residual
from dyknow.time import Duration

__all__ = [
    "DEFAULT_LIMIT",
    "Holder",
    "Memory",
    "ProgressionTable",
    "Residuals",
    "Truths",
    "Verdicts",
]

Residuals = npt.NDArray[np.int64]
Truths = npt.NDArray[np.bool_]
Verdicts = npt.NDArray[np.int8]

DEFAULT_LIMIT = 1 << 15
"""How many residuals a table keeps."""

_FALSE, _TRUE, _INITIAL = 0, 1, 2
_CELLS = 1 << 21
_MOST_TABULATED_ATOMS = 8
_VERDICTS = (Verdict.FALSE, Verdict.TRUE)
_UNKNOWN = -1
_DENSE = 16
_NO_TABLE = np.empty(0, dtype=np.int64)


_Residual = tuple[Shape, Times]


@dataclass(frozen=True, slots=True)
class Memory:
    """What a table keeps.

    Attributes:
        residuals: The number of residuals.
        rules: The number of rules.
        limit: The limit on each of them.
        cells: The number of entries of tables, of eight bytes.
    """

    residuals: int
    rules: int
    limit: int
    cells: int


class Holder(Protocol):
    """Something that holds numbers of residuals, which a table may change."""

    residuals: Residuals


class ProgressionTable:
    """The residuals of one formula and how they follow from one another.

    A residual says what must hold after the last state. Numbers 0 and 1 stand for false and
    true. A table may be shared; when it has more than *limit* residuals, `collect_when_full`
    forgets those that no registered holder has, and renumbers the others. Memory is bounded by
    *limit* residuals (half a kilobyte each), or twice those in use if that is more, by *limit*
    rules (about 2 kB each), and by 16 MB of tables (or that of one elapsed time, if it is
    more); `memory` says how much of that is used.

    Attributes:
        formula: The formula.
        atoms: Its boolean features and comparisons, in the order in which `progress` wants
            their truth.
        columns: The same, ready to be evaluated over columns.
        initial: The number of the residual before the first state.
        time_model: At which time-points there is a state.
        limit: How many residuals, and how many rules, are kept before unused ones are forgotten.
        rules: How the residuals follow from one another.
    """

    def __init__(
        self,
        formula: Formula,
        limit: int = DEFAULT_LIMIT,
        time_model: TimeModel | str = TimeModel.HOLD,
    ) -> None:
        """Make the table.

        Raises:
            SpecificationErrors: An interval ends before it begins, or the like.
            ValueError: There is a quantifier in the formula (see `dyknow.mtl.quantifiers`), or
                no time model of this name.
        """
        check(formula)
        self.time_model = TimeModel(time_model)
        self._graph = graph = FormulaGraph(formula, self.time_model)
        self.formula = formula
        self.atoms: tuple[Atom, ...] = graph.atoms
        self.columns = AtomColumns(self.atoms)
        self.initial = _INITIAL
        self.limit = limit
        self.rules = RuleBook(graph, limit)
        self._width = 1 << len(self.atoms)
        self._holders: WeakSet[Holder] = WeakSet()
        self._in_use = 0
        self._forget_all()

    def _forget_all(self) -> None:
        rules = self.rules
        self._residuals: list[_Residual] = [
            (rules.false, (0,)),
            (rules.true, (0,)),
            (rules.initial, (NEVER,)),
        ]
        self._number: dict[tuple[int, Times], int] = {}
        self._tables: OrderedDict[int, npt.NDArray[np.int64]] = OrderedDict()

    def __len__(self) -> int:
        """Return how many residuals are known, true, false, and the initial one included."""
        return len(self._residuals)

    def register(self, holder: Holder) -> None:
        """Keep the residuals of *holder* when others are forgotten, as long as it lives."""
        self._holders.add(holder)

    def progress(
        self,
        residuals: Residuals,
        truth: Truths,
        elapsed: Duration | npt.NDArray[np.int64],
    ) -> Residuals:
        """Return what is left after a new state of each of n objects.

        Args:
            residuals: shape (n,), what was left after the state before.
            truth: shape (n_atoms, n), the truth of the atoms in the new state.
            elapsed: The time since the state before, at least one nanosecond, for all objects
                or for each. It is ignored where no state has been seen.
        """
        if isinstance(elapsed, np.ndarray):
            return self._progress_by_elapsed(residuals, truth, elapsed)
        if elapsed < 1:
            raise ValueError(f"expected a positive elapsed time, found {elapsed}")
        if truth.shape != (len(self.atoms), len(residuals)):
            expected = (len(self.atoms), len(residuals))
            raise ValueError(f"expected truth of shape {expected}, found {truth.shape}")
        if not len(residuals):
            return residuals
        if len(self.atoms) > _MOST_TABULATED_ATOMS:
            return self._progress_sparsely(residuals, truth, elapsed)
        keys = residuals * self._width
        for number, values in enumerate(truth):
            keys += values.astype(np.int64) << number
        table = self._table(elapsed)
        following = table.take(keys, mode="clip")
        if len(following) and following.min() < 0:
            table = self._fill(elapsed, _distinct(keys[following < 0], len(table)))
            following = table.take(keys, mode="clip")
        return following

    def verdicts(self, residuals: Residuals) -> Verdicts:
        """Return 1 where a residual is true, -1 where it is false, and 0 elsewhere."""
        verdicts: Verdicts = (residuals == _TRUE).astype(np.int8)
        verdicts -= residuals == _FALSE
        return verdicts

    def verdict(self, number: int) -> Verdict:
        """Return the verdict of one residual."""
        return _VERDICTS[number] if number < _INITIAL else Verdict.UNDECIDED

    def residual(self, number: int) -> Formula:
        """Return a residual as a formula about the time after the last state.

        An interval that reaches back before 0 speaks of instants that have been seen already
        and at which the body is not decided yet.
        """
        return self.formula_left(*self._residuals[number])

    def formula_left(self, shape: Shape, past: Times) -> Formula:
        """Return what `residual` returns, for a shape of `rules` and its times."""
        residual = self.rules.residual(shape, past)
        if residual is not None:
            return formula_from_residual(self._graph, self.rules.progression, residual)
        constants = {Verdict.FALSE: FALSE, Verdict.TRUE: TRUE}
        return constants.get(shape.verdict, self.formula)

    @property
    def memory(self) -> "Memory":
        """How much is kept at present."""
        cells = sum(map(len, self._tables.values()))
        return Memory(len(self._residuals), self.rules.size, self.limit, cells)

    def collect_when_full(self) -> None:
        """Forget residuals that no holder has, if there are more than `limit`."""
        if len(self._residuals) <= max(self.limit, 2 * self._in_use):
            return
        kept = self._residuals
        holders = list(self._holders)
        self._forget_all()
        new = np.zeros(len(kept), dtype=np.int64)
        used = np.concatenate([_NO_TABLE, *(holder.residuals for holder in holders)])
        for number in np.unique(used).tolist():
            new[number] = number if number <= _INITIAL else self._number_of(*kept[number])
        for holder in holders:
            holder.residuals = new[holder.residuals]
        self._in_use = len(self._residuals)

    def _progress_by_elapsed(
        self, residuals: Residuals, truth: Truths, elapsed: npt.NDArray[np.int64]
    ) -> Residuals:
        following = np.empty_like(residuals)
        for duration in np.unique(elapsed).tolist():
            rows = elapsed == duration
            following[rows] = self.progress(residuals[rows], truth[:, rows], Duration(duration))
        return following

    def successor(self, number: int, bits: int, elapsed: Duration) -> int:
        """Return what `progress` returns, for one object; bit i of *bits* is atom number i."""
        if number < _INITIAL:
            return number
        shape, past = self._residuals[number]
        now = past[0] + elapsed
        following, times = self.rules.follow(shape, past, bits, now)
        return self._number_of(following, times)

    def _number_of(self, shape: Shape, times: Times) -> int:
        if shape.verdict is not Verdict.UNDECIDED:
            return _TRUE if shape.verdict is Verdict.TRUE else _FALSE
        past = _closed_up(times, shape.reach)
        number = self._number.setdefault((shape.number, past), len(self._residuals))
        if number == len(self._residuals):
            self._residuals.append((shape, past))
        return number

    def _table(self, elapsed: int) -> npt.NDArray[np.int64]:
        """Return the table for one elapsed time, long enough for all residuals."""
        table = self._tables.pop(elapsed, _NO_TABLE)
        missing = len(self._residuals) * self._width - len(table)
        if missing > 0:
            rows = np.full(missing + len(table), _UNKNOWN, dtype=np.int64)
            table = np.concatenate((table, rows))
            table[: 2 * self._width] = np.repeat((_FALSE, _TRUE), self._width)
        self._tables[elapsed] = table
        while len(self._tables) > 1 and sum(map(len, self._tables.values())) > _CELLS:
            self._tables.popitem(last=False)
        return table

    def _fill(self, elapsed: int, keys: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        table = self._tables[elapsed]
        for key in keys.tolist():
            number, bits = divmod(key, self._width)
            table[key] = self.successor(number, bits, Duration(elapsed))
        return table

    def _progress_sparsely(
        self, residuals: Residuals, truth: Truths, elapsed: Duration
    ) -> Residuals:
        """Progress a formula with so many atoms that a table would be mostly empty."""
        rows = np.concatenate(
            (
                residuals[None].view(np.uint8).reshape(len(residuals), 8).T,
                np.packbits(truth, axis=0, bitorder="little"),
            )
        )
        pairs, places = np.unique(rows, axis=1, return_inverse=True)
        numbers = pairs[:8].T.copy().view(np.int64).ravel().tolist()
        bits = [int.from_bytes(column.tobytes(), "little") for column in pairs[8:].T]
        following = [self.successor(k, b, elapsed) for k, b in zip(numbers, bits, strict=True)]
        return np.array(following, dtype=np.int64)[places]


def _distinct(keys: npt.NDArray[np.int64], limit: int) -> npt.NDArray[np.int64]:
    """Return the different *keys*, which lie below *limit*."""
    if limit > _DENSE * len(keys):
        return np.unique(keys)
    found = np.zeros(limit, dtype=np.bool_)
    found[keys] = True
    return np.flatnonzero(found)


def _closed_up(times: Times, reach: int) -> Times:
    """Return *times*, in descending order, relative to the first, with gaps of at most *reach*.

    Times are only ever compared with one another and durations up to *reach*, so that a longer
    gap is as good as any longer one.
    """
    past = [0]
    for later, earlier in pairwise(times):
        past.append(past[-1] - min(later - earlier, reach))
    return tuple(past)

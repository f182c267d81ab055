"""Objects about which something was recognised, so that conditions of links can name it."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from chronicles.events import Recognition
from chronicles.ordering import InputOrder
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.table import Column, Ids, Table, concatenate, positions_of
from dyknow.time import Duration, TimePoint

__all__ = ["RecognitionMarks"]

_NEVER = -1
_NOT_AT_ALL = Duration(0)


class RecognitionMarks:
    """Adds what was recognised about the objects of a stream of tables, its first input.

    The other inputs are streams of recognitions. One table comes out for each that goes in, valid
    at the same time, with three more columns:

    * `recognised`: whether anything was recognised about the object since the table before, up to
      and including the valid time of this one;
    * `n_recognised`: how much was so far;
    * `recognised_at`: when it was last, in nanoseconds; -1 for never.

    What counts is **when a recognition became certain** (`recognised_at`), not when what was
    recognised happened: that is over when it is known, and tables of that time are out. A table
    waits until all recognitions up to its valid time are known, as the heartbeats of a recogniser
    tell, or until *max_delay* after its valid time. What is recognised too late even so counts in
    the next table.

    An object is meant if its symbol is an argument of a recognition, under one of the names in
    *arguments*. Recognitions about objects that are not known, any more or yet, are counted in
    `n_unknown`.

    A table without objects may be without columns, and stays so.

    With *remember*, objects with a mark stay in the tables that come out until that time after
    they have left those that come in, as they were last. There is a column `present` then, which
    tells whether they are in the table; the column `observed` is left out, since nobody has to be
    seen to have been recognised.

    Args:
        arguments: Names of parameters of chronicles, without their mark, separated by spaces.
        chronicles: Names of the chronicles that count; all if there are none.
        max_delay: How long after its valid time a recognition may arrive.
        remember: How long an object is known after it has left.

    Attributes:
        n_unknown: How many arguments of recognitions stood for no object that is known.
    """

    def __init__(
        self,
        *,
        arguments: str,
        chronicles: tuple[str, ...] = (),
        max_delay: Duration | None = None,
        remember: Duration = _NOT_AT_ALL,
    ) -> None:
        self.n_unknown = 0
        self._arguments = tuple(arguments.split())
        if not self._arguments:
            raise ValueError("expected at least one name of a parameter in 'arguments'")
        self._chronicles = frozenset(chronicles)
        self._max_delay = max_delay
        self._remember = remember
        self._order = InputOrder(max_delay, with_equals=True)
        self._is_open = False
        self._last: Table | None = None
        self._last_time = TimePoint(-1)
        self._left: Table | None = None
        self._left_at: Ids = np.empty(0, dtype=np.int64)
        self._marks: dict[int, tuple[int, int]] = {}
        self._new: list[Recognition] = []

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Element]:
        """Take in the new samples among *inputs* and emit the tables that are complete."""
        if not self._is_open:
            self._is_open = True
            for at in range(len(inputs)):
                self._order.open(at, max_delay=self._max_delay, is_awaited=at > 0)
        self._order.take(now, inputs)
        return self.advance(now)

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> list[Element]:
        """Take in how far an input is complete and emit the tables that are complete by that."""
        self._order.hear(at, heartbeat)
        return self.advance(now)

    def advance(self, now: TimePoint) -> list[Element]:
        """Emit the tables that have waited long enough."""
        ready = list(self._order.ready(now))
        ready.sort(key=lambda one: (one[1].valid_time, one[0] == 0))
        return list(self._tables(ready, now))

    def due(self) -> TimePoint | None:
        """Return when the next table has waited long enough, if time alone can tell."""
        return self._order.ready_when()

    def _tables(
        self, ready: list[tuple[int, Sample[Any]]], now: TimePoint
    ) -> Iterator[Sample[Table]]:
        for at, sample in ready:
            if at:
                self._new += (each for each in sample.value if self._counts(each))
            elif isinstance(sample.value, Table):
                yield Sample(self._marked(sample.value, sample.valid_time), sample.valid_time, now)

    def _marked(self, table: Table, time: TimePoint) -> Table:
        self._note_leaving(table)
        self._forget(time)
        recognised = np.array(sorted(self._mark(table)), dtype=np.int64)
        everybody = self._with_present(table) if self._remember else table
        if not len(everybody) and not table.columns:
            return table
        if not self._remember:
            return self._with_marks(table, recognised)
        columns = {n: c for n, c in everybody.columns.items() if n != "observed"}
        return self._with_marks(Table(table.sort, everybody.ids, columns), recognised)

    def _note_leaving(self, table: Table) -> None:
        """Keep the last states of objects that are in the table no more."""
        last, self._last = self._last, table
        if last is None or not self._remember:
            return
        if self._left is not None:
            back = positions_of(self._left.ids, table.ids) >= 0
            self._left, self._left_at = self._left.select(~back), self._left_at[~back]
        gone = last.select(positions_of(last.ids, table.ids) < 0)
        if len(gone):
            at = np.full(len(gone), self._last_time, dtype=np.int64)
            self._left = _joined(self._left, gone)
            self._left_at = np.concatenate((self._left_at, at))

    def _forget(self, time: TimePoint) -> None:
        """Forget the objects, and their marks, that left too long ago."""
        self._last_time = time
        known = set() if self._last is None else set(self._last.ids.tolist())
        if self._left is not None:
            kept = time - self._left_at <= self._remember
            self._left, self._left_at = self._left.select(kept), self._left_at[kept]
            known.update(self._left.ids.tolist())
        self._marks = {each: mark for each, mark in self._marks.items() if each in known}

    def _mark(self, table: Table) -> set[int]:
        """Take in what was recognised since the last table; return the objects meant."""
        known = set(table.ids.tolist())
        if self._left is not None:
            known.update(self._left.ids.tolist())
        meant: set[int] = set()
        for recognition in self._new:
            for symbol in self._symbols(recognition):
                object_id = table.id_of(symbol)
                if object_id is None or object_id not in known:
                    self.n_unknown += 1
                    continue
                meant.add(object_id)
                count, latest = self._marks.get(object_id, (0, _NEVER))
                time = max(latest, recognition.recognised_at)
                self._marks[object_id] = (count + 1, time)
        self._new.clear()
        return meant

    def _counts(self, recognition: Recognition) -> bool:
        return not self._chronicles or recognition.chronicle in self._chronicles

    def _symbols(self, recognition: Recognition) -> set[str]:
        arguments = recognition.arguments
        return {arguments[name] for name in self._arguments if name in arguments}

    def _with_present(self, table: Table) -> Table:
        """Return the objects of a table, and those with a mark that have left."""
        there = table.with_columns(present=np.ones(len(table), dtype=np.bool_))
        if self._left is None:
            return there
        marked = np.isin(self._left.ids, np.array(list(self._marks), dtype=np.int64))
        left = self._left.select(marked)
        return _joined(there, left.with_columns(present=np.zeros(len(left), dtype=np.bool_)))

    def _with_marks(self, table: Table, recognised: Ids) -> Table:
        ids = np.array(list(self._marks), dtype=np.int64)
        marks = np.array(list(self._marks.values()), dtype=np.int64).reshape(-1, 2)
        at = positions_of(table.ids, ids)
        return table.with_columns(
            recognised=np.isin(table.ids, recognised),
            n_recognised=_picked(marks[:, 0], at, 0),
            recognised_at=_picked(marks[:, 1], at, _NEVER),
        )


def _joined(one: Table | None, other: Table) -> Table:
    """Return the rows of both tables; one without rows may have no columns either."""
    if one is None or not len(one):
        return other if len(other) or one is None else one
    return concatenate([one, other]) if len(other) else one


def _picked(column: Column, at: Column, otherwise: int) -> Column:
    """Return the entries of a column at some places, and *otherwise* where the place is -1."""
    picked = np.full(len(at), otherwise, dtype=np.int64)
    picked[at >= 0] = column[at[at >= 0]]
    return picked

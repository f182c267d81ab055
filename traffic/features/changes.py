"""From attributes in columns to the events that chronicles are made of.

A primitive event is a change of the value of an attribute (Heintz 2009, section 8.7.3).
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from chronicles.events import Event
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Column, Table, positions_of
from dyknow.time import TimePoint
from traffic.features.stability import UNKNOWN

__all__ = ["Changes"]

_NONE = -1
_ARGUMENTS = ("first", "second")


class Changes(Reactive):
    """Emits the changes of attributes from one table to the next, as a tuple of events.

    One tuple comes out for each table that goes in, also an empty one: it says that nothing
    changed up to its time. The attribute *of*`.`*column* of an object changes when the value
    of that column differs from the last one. The value is unknown (None) before an object
    appears, after it is gone, and while the column holds `UNKNOWN`; other integers are looked up
    in the vocabulary of their column, where -1 is `no_` and the column's name. Columns without a
    vocabulary are `true` or `false`.

    Args:
        vocabularies: The names of the values of a column, by column.
        of: The first part of the attributes' names.
        arguments: Sort of the objects that the attributes are about. A table with columns
            `first` and `second` is about two of them, any other about its own `id`. Objects of a
            sort that has a vocabulary are called as that says, others by sort and number.
    """

    def __init__(
        self, vocabularies: Mapping[str, Sequence[str]], *, of: str, arguments: str
    ) -> None:
        self._vocabularies = vocabularies
        self._of = of
        self._sort = arguments
        self._names = vocabularies.get(arguments)
        self._last = Table("none", (), {})

    def push(
        self, now: TimePoint, inputs: tuple[Sample[Any], ...]
    ) -> Iterable[Sample[tuple[Event, ...]]]:
        """Emit what has changed since the table before."""
        (sample,) = inputs
        events = tuple(self._events(sample.value, sample.valid_time))
        self._last = sample.value
        yield Sample(events, sample.valid_time, now)

    def _events(self, table: Table, time: TimePoint) -> Iterator[Event]:
        last = self._last
        before = positions_of(table.ids, last.ids)
        gone = last.select(positions_of(last.ids, table.ids) < 0)
        for name in table.columns:
            if name in _ARGUMENTS:
                continue
            old = np.full(len(table), UNKNOWN)
            if name in last:
                old[before >= 0] = _codes(last[name])[before[before >= 0]]
                yield from self._changes(gone, name, _codes(gone[name]), UNKNOWN, time)
            yield from self._changes(table, name, old, _codes(table[name]), time)

    def _changes(
        self, table: Table, name: str, old: Column, new: Column | int, time: TimePoint
    ) -> Iterator[Event]:
        changed = np.flatnonzero(old != new)
        if not len(changed):
            return
        rows = (
            self._arguments(table.select(changed)),
            old[changed].tolist(),
            np.broadcast_to(new, len(old))[changed].tolist(),
        )
        attribute = f"{self._of}.{name}"
        for arguments, was, becomes in zip(*rows, strict=True):
            yield Event(
                attribute, arguments, self._value(name, was), self._value(name, becomes), time
            )

    def _arguments(self, table: Table) -> list[tuple[str, ...]]:
        if "first" not in table:
            return [(self._name(one),) for one in table.ids.tolist()]
        pairs = zip(table["first"].tolist(), table["second"].tolist(), strict=True)
        return [(self._name(one), self._name(other)) for one, other in pairs]

    def _name(self, one: int) -> str:
        return f"{self._sort}{one}" if self._names is None else self._names[one]

    def _value(self, name: str, code: int) -> str | None:
        if code == UNKNOWN:
            return None
        if name not in self._vocabularies:
            return "true" if code else "false"
        return f"no_{name}" if code == _NONE else self._vocabularies[name][code]


def _codes(column: Column) -> Column:
    return column.astype(np.int32)

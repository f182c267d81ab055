"""The stream of one object's states out of a stream of tables.

A table has the states of many objects at one valid time; a stream of the states of one of them
(an object state stream of Heintz 2009, definition 8.5.2) is a view of it.
"""

from typing import Any

from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = ["View"]


class View(Reactive):
    """Emits the state of one object, as a mapping from column to value, for each table with it.

    Both times of a sample stay as they are. Nothing is emitted for a table without the object.

    Raises:
        TypeError: While it works: a value is no table.
    """

    def __init__(self, symbol: str) -> None:
        """Look at the object called *symbol*, such as `car3`: its sort and its id."""
        self._symbol = symbol

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> tuple[Sample[Any], ...]:
        """Emit what the new table says about the object."""
        (sample,) = inputs
        if sample.value is NO_VALUE:
            return ()
        state = self._state(sample.value)
        return () if state is None else (Sample(state, sample.valid_time, now),)

    def _state(self, table: Any) -> dict[str, Any] | None:
        if not isinstance(table, Table):
            kind = type(table).__name__
            raise TypeError(f"expected a table to look for '{self._symbol}' in, found {kind}")
        object_id = table.id_of(self._symbol)
        return None if object_id is None else table.row(object_id)

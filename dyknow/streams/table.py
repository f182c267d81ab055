"""The states of several objects at one valid time, as columns.

A stream of tables is the columnar form of the object state streams of Heintz (2009),
definitions 8.5.1 and 8.5.2: row i is the object state of the object `ids[i]`. Work is done on
whole columns; the states of one object are a view (`Table.row`).
"""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Column", "Ids", "Table", "concatenate", "positions_of"]

Column = npt.NDArray[Any]
Ids = npt.NDArray[np.int64]


class Table:
    """States of objects of one sort at the same valid time; immutable by convention.

    Attributes:
        sort: The sort of the objects, such as `car`; with the id it makes the symbol `car3`.
        ids: shape (n,), int64, each object once.
        columns: Name to array; the first axis of each has n entries.
    """

    __slots__ = ("columns", "ids", "sort")

    def __init__(self, sort: str, ids: npt.ArrayLike, columns: Mapping[str, Column]) -> None:
        self.sort = sort
        self.ids: Ids = np.asarray(ids, dtype=np.int64)
        self.columns: dict[str, Column] = dict(columns)
        for name, column in self.columns.items():
            if len(column) != len(self.ids):
                raise ValueError(
                    f"column '{name}' has {len(column)} rows, expected {len(self.ids)}"
                )

    def __len__(self) -> int:
        return len(self.ids)

    def __getitem__(self, name: str) -> Column:
        return self.columns[name]

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __repr__(self) -> str:
        return f"Table({self.sort!r}, {len(self)} rows, {', '.join(self.columns)})"

    def symbol(self, object_id: int) -> str:
        """Return the symbol of one object, such as `car3`."""
        return f"{self.sort}{object_id}"

    def id_of(self, symbol: str) -> int | None:
        """Return the id that a symbol stands for, or None if it is none of this sort."""
        number = symbol.removeprefix(self.sort)
        is_ours = symbol.startswith(self.sort) and number.isdecimal()
        return int(number) if is_ours and self.symbol(int(number)) == symbol else None

    def select(self, rows: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> "Table":
        """Return the rows for which a mask is true, or those with the given positions."""
        found = Table.__new__(Table)  # of columns that have been checked
        found.sort = self.sort
        found.ids = self.ids[rows]
        found.columns = {name: column[rows] for name, column in self.columns.items()}
        return found

    def with_columns(self, **columns: Column) -> "Table":
        """Return the same objects with *columns* added or replaced."""
        return Table(self.sort, self.ids, {**self.columns, **columns})

    def row(self, object_id: int) -> dict[str, Any] | None:
        """Return the state of one object, or None if the table does not hold it."""
        (found,) = np.nonzero(self.ids == object_id)
        if not len(found):
            return None
        return {name: column[found[0]] for name, column in self.columns.items()}


def positions_of(wanted: Ids, ids: Ids) -> npt.NDArray[np.intp]:
    """Return, for each id of *wanted*, its position in *ids*, or -1; *ids* need no order."""
    if not len(ids) or not len(wanted):
        return np.full(len(wanted), -1, dtype=np.intp)
    order = np.argsort(ids, kind="stable")
    at = np.minimum(np.searchsorted(ids, wanted, sorter=order), len(ids) - 1)
    found = order[at]
    return np.where(ids[found] == wanted, found, -1)


def concatenate(tables: Iterable[Table]) -> Table:
    """Return all rows of *tables*, which have one sort and the same columns."""
    parts = list(tables)
    first = parts[0]
    columns = {name: np.concatenate([t[name] for t in parts]) for name in first.columns}
    return Table(first.sort, np.concatenate([t.ids for t in parts]), columns)

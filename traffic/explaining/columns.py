"""Tables of a run as columns of the files in which they are kept."""

import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from traffic.explaining.changing import ABSENT, changes_of

__all__ = ["Columns", "changes_kept", "digest_of_table", "states_kept"]

Columns = dict[str, Any]
"""Arrays, or one value for all rows, by the names of the columns in a file."""

_PARTIES = ("first", "second")
_VARIANCE = "_variance"
_BYTES_OF_TIME = 8


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """Several tables as one."""

    tables: Sequence[Table]
    valid_times: npt.NDArray[np.int64]

    @classmethod
    def of(cls, samples: Sequence[Sample[Table]]) -> "_Rows":
        tables = [sample.value for sample in samples]
        lengths = [len(table) for table in tables]
        return cls(tables, np.repeat([sample.valid_time for sample in samples], lengths))

    def column(self, name: str) -> npt.NDArray[Any] | None:
        """Return a column; None if not every table with rows has it."""
        parts = [table.columns.get(name) for table in self.tables if len(table)]
        known = [part for part in parts if part is not None]
        return np.concatenate(known) if known and len(known) == len(parts) else None

    def ids(self) -> npt.NDArray[np.int64]:
        return np.concatenate([table.ids for table in self.tables])


def states_kept(samples: Sequence[Sample[Table]], wanted: Iterable[str]) -> Columns:
    """Return the states of all objects in *samples*; `x` and `y` are those of `position`."""
    rows = _Rows.of(samples)
    kept: Columns = {"valid_time": rows.valid_times, "id": rows.ids()}
    position = rows.column("position")
    for name in wanted:
        if name in ("x", "y"):
            kept[name] = None if position is None else position[:, "xy".index(name)]
        elif name not in kept:
            kept[name] = rows.column(name)
    return kept


def changes_kept(
    samples: Sequence[Sample[Table]], previous: Table, wanted: Sequence[str]
) -> tuple[Columns, Columns]:
    """Return the changes of qualities from table to table, and the quantities at these times.

    Args:
        samples: One after another.
        previous: The table before them.
        wanted: The columns in which changes are looked for.
    """
    tables = [previous, *(sample.value for sample in samples)]
    valid = np.array([sample.valid_time for sample in samples], dtype=np.int64)
    available = np.array([sample.available_time for sample in samples], dtype=np.int64)
    rows = _Rows(tables, np.empty(0, dtype=np.int64))
    ids = rows.ids()
    parties = {name: rows.column(name) for name in _PARTIES}
    found = changes_of(wanted, tables[1:], previous)
    table = np.concatenate([each.table for each in found])
    row = np.concatenate([each.row for each in found])
    after = np.concatenate([each.after for each in found])
    changes: Columns = {
        "column": np.repeat([each.name for each in found], [len(each.row) for each in found]),
        "valid_time": valid[table],
        "available_time": available[table],
        "id": ids[row],
        **{name: None if of is None else of[row] for name, of in parties.items()},
        "before": np.concatenate([each.before for each in found]),
        "after": after,
    }
    is_there = after != ABSENT
    return changes, _quantities(rows, valid[table[is_there]], row[is_there])


def _quantities(
    rows: _Rows, valid_times: npt.NDArray[np.int64], row: npt.NDArray[np.intp]
) -> Columns:
    """Return the quantities in some *row*s, one line each."""
    example = next((table for table in rows.tables if len(table)), None)
    names = quantities_of(example) if example is not None else ()
    columns = {name: rows.column(name) for name in names}
    known = {name: column for name, column in columns.items() if column is not None}
    row, first = np.unique(row, return_index=True)
    n = len(known)
    values = [column[row].astype(np.float32) for column in known.values()]
    return {
        "column": np.repeat(list(known), len(row)),
        "valid_time": np.tile(valid_times[first], n),
        "id": np.tile(rows.ids()[row], n),
        "value": np.concatenate(values) if values else np.empty(0, dtype=np.float32),
    }


def qualities_of(table: Table) -> tuple[str, ...]:
    """Return the names of the columns of truth values and of whole numbers that stand for names.

    The two objects that a row is about are none.
    """
    return tuple(
        name
        for name, column in table.columns.items()
        if column.ndim == 1
        and (
            column.dtype.kind == "b"
            or (column.dtype.kind == "i" and column.dtype.itemsize < _BYTES_OF_TIME)
        )
        and name not in _PARTIES
    )


def quantities_of(table: Table) -> tuple[str, ...]:
    """Return the names of the columns with one number for each object, without variances."""
    return tuple(
        name
        for name, column in table.columns.items()
        if column.ndim == 1 and column.dtype.kind == "f" and not name.endswith(_VARIANCE)
    )


def digest_of_table(table: Table) -> int:
    """Return a number that is another one if any object of *table* is another or elsewhere."""
    digest = zlib.crc32(table.ids.tobytes())
    for name in ("position", "heading"):
        if name in table:
            digest = zlib.crc32(table[name].tobytes(), digest)
    return digest

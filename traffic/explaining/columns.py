"""Tables of a run as columns of the files in which they are kept."""

import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table, positions_of
from traffic.explaining.changing import ABSENT, changes_of

__all__ = ["Columns", "changes_kept", "digest_of", "states_kept"]

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
    samples: Sequence[Sample[Table]],
    previous: Table,
    wanted: Sequence[str],
    beside: Sequence[Sample[Table]] = (),
) -> tuple[Columns, Columns]:
    """Return the changes of qualities from table to table, and the quantities at these times.

    Args:
        samples: One after another.
        previous: The table before them.
        wanted: The columns in which changes are looked for.
        beside: Further tables with quantities of the same objects at the same times.
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
    keys = _Keys(valid[table[is_there]], ids[row[is_there]])
    told = [_quantities(keys, each) for each in _by_columns([*samples, *beside])]
    return changes, {
        name: np.concatenate([each[name] for each in told]) if told else []
        for name in ("column", "valid_time", "id", "value")
    }


class _Keys:
    """Objects at times, each once."""

    def __init__(self, times: npt.NDArray[np.int64], ids: npt.NDArray[np.int64]) -> None:
        both = np.unique(np.stack([times, ids]), axis=1)
        self._times, self._ids = both

    def at(self, time: int) -> npt.NDArray[np.int64]:
        """Return the objects at one time."""
        first, last = np.searchsorted(self._times, [time, time + 1])
        found: npt.NDArray[np.int64] = self._ids[first:last]
        return found


def _by_columns(samples: Iterable[Sample[Table]]) -> list[list[Sample[Table]]]:
    """Return the tables with quantities, those with the same ones together."""
    groups: dict[tuple[str, ...], list[Sample[Table]]] = {}
    for sample in samples:
        if len(sample.value) and (names := quantities_of(sample.value)):
            groups.setdefault(names, []).append(sample)
    return list(groups.values())


def _quantities(keys: _Keys, samples: Sequence[Sample[Table]]) -> Columns:
    """Return the quantities of some objects at some times, one line each."""
    names = quantities_of(samples[0].value)
    told: list[tuple[int, Table]] = []
    for sample in samples:
        wanted = keys.at(sample.valid_time)
        at = positions_of(wanted, sample.value.ids) if len(wanted) else wanted
        if (at >= 0).any():
            told.append((sample.valid_time, sample.value.select(at[at >= 0])))
    times = np.repeat([time for time, _ in told], [len(table) for _, table in told])
    ids = np.concatenate([np.empty(0, dtype=np.int64), *(table.ids for _, table in told)])
    values = [table[name].astype(np.float32) for name in names for _, table in told]
    return {
        "column": np.repeat(np.array(names, dtype=object), len(ids)),
        "valid_time": np.tile(times.astype(np.int64), len(names)),
        "id": np.tile(ids, len(names)),
        "value": np.concatenate([np.empty(0, dtype=np.float32), *values]),
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


def digest_of(values: Iterable[Any]) -> int:
    """Return a number that is another one if anything in the tables among *values* is another."""
    digest = 0
    for table in values:
        if isinstance(table, Table):
            digest = zlib.crc32(table.ids.tobytes(), digest)
            for column in table.columns.values():
                digest = zlib.crc32(column.tobytes(), digest)
    return digest

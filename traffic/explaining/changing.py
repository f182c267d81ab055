"""When the columns of a stream of tables change, found for many tables at once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Table

__all__ = ["ABSENT", "ColumnChanges", "changes_of"]

ABSENT = -3
"""The code of an object that is not in the table."""

Codes = npt.NDArray[np.int32]
Rows = npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class ColumnChanges:
    """The changes of one column, in order of time.

    Attributes:
        name: Of the column.
        table: Which table shows the change, counted from 0.
        row: Of the rows of all tables, one after another, with those of the table before them,
            the row that changed; the last one of an object that is gone.
        before: Its code in the table before.
        after: Its code in this table.
    """

    name: str
    table: Rows
    row: Rows
    before: Codes
    after: Codes


def changes_of(
    names: Sequence[str], tables: Sequence[Table], previous: Table
) -> list[ColumnChanges]:
    """Return how columns of whole numbers or truth values change from table to table.

    An object that comes or goes changes from or to `ABSENT`.

    Args:
        names: Of the columns.
        tables: One after another.
        previous: The table before them; without rows at the beginning.
    """
    everything = [previous, *tables]
    number = np.repeat(np.arange(len(everything)), [len(each) for each in everything])
    ids = np.concatenate([each.ids for each in everything])
    order = np.lexsort((number, ids))
    at, who = number[order], ids[order]
    goes_on = (who[1:] == who[:-1]) & (at[1:] == at[:-1] + 1)
    follows = np.concatenate([[False], goes_on])[: len(order)]
    stays = np.concatenate([goes_on, [False]])[: len(order)]
    gone = np.flatnonzero(~stays & (at < len(tables)))
    found = []
    for name in names:
        codes = _codes(name, everything)[order]
        before = np.where(follows, np.roll(codes, 1), ABSENT).astype(np.int32)
        changed = np.flatnonzero((before != codes) & (at > 0))
        lost = np.full(len(gone), ABSENT, dtype=np.int32)
        when = np.concatenate([at[changed] - 1, at[gone]])
        sequence = np.argsort(when, kind="stable")
        found.append(
            ColumnChanges(
                name=name,
                table=when[sequence],
                row=np.concatenate([order[changed], order[gone]])[sequence],
                before=np.concatenate([before[changed], codes[gone]])[sequence],
                after=np.concatenate([codes[changed], lost])[sequence],
            )
        )
    return found


def _codes(name: str, tables: Sequence[Table]) -> Codes:
    """Return a column of all *tables*; one without rows need not have it."""
    parts = [each[name].astype(np.int32) for each in tables if name in each]
    return np.concatenate([np.empty(0, dtype=np.int32), *parts])

"""Work on some rows of a table while the others stay as they are."""

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Column, Table, concatenate

__all__ = ["Mask", "Rows", "choose", "take", "with_rows"]

Mask = npt.NDArray[np.bool_]
Rows = npt.NDArray[np.intp]


def choose(mask: Mask, yes: Column, no: Column) -> Column:
    """Return row by row *yes* where *mask* is true and *no* elsewhere."""
    return np.where(mask.reshape(-1, *(1,) * (yes.ndim - 1)), yes, no)


def take(table: Table, rows: Rows) -> Table:
    """Return some rows of *table*; the table itself, not a copy, if these are all in order."""
    if len(rows) == len(table) and (rows == np.arange(len(rows))).all():
        return table
    return table.select(rows)


def with_rows(table: Table, rows: Rows, new: Table) -> Table:
    """Return *table* with the rows of *new*, which has the same columns, in place of *rows*."""
    if not len(rows):
        return table
    if len(rows) == len(table) and (rows == np.arange(len(rows))).all():
        return new
    order = np.arange(len(table))
    order[rows] = len(table) + np.arange(len(rows))
    return concatenate([table, new]).select(order)

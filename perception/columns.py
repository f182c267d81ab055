"""Records whose fields are arrays of equal length: choose rows, put one after another."""

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

__all__ = ["Rows", "concatenate", "select"]

R = TypeVar("R")

Rows = npt.NDArray[np.bool_] | npt.NDArray[np.intp]
"""A mask, or positions."""


def select(record: R, rows: Rows) -> R:
    """Return the rows for which a mask is true, or those with the given positions."""
    return type(record)(*(column[rows] for column in _columns(record)))


def concatenate(records: Sequence[R]) -> R:
    """Return the rows of all *records*, of which there is at least one."""
    if len(records) == 1:
        return records[0]
    columns = zip(*(_columns(record) for record in records), strict=True)
    return type(records[0])(*(np.concatenate(parts) for parts in columns))


def _columns(record: object) -> list[npt.NDArray[Any]]:
    if not is_dataclass(record):
        raise TypeError(f"expected a dataclass of columns, found {type(record).__name__}")
    return [getattr(record, field.name) for field in fields(record)]

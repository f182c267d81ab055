"""When two values of samples are the same."""

from typing import Any

import numpy as np

from dyknow.streams.table import Table

__all__ = ["are_equal"]


def are_equal(left: Any, right: Any) -> bool:
    """Return whether two values are the same; arrays, tables and mappings as a whole."""
    if left is right:
        return True
    match left, right:
        case Table(), Table():
            return _are_equal_tables(left, right)
        case np.ndarray(), np.ndarray():
            return left.dtype == right.dtype and _are_equal_arrays(left, right)
        case tuple(), tuple():
            return len(left) == len(right) and all(map(are_equal, left, right))
        case dict(), dict():
            return left.keys() == right.keys() and all(
                are_equal(left[name], right[name]) for name in left
            )
        case _:
            return _are_equal_simple(left, right)


def _are_equal_simple(left: Any, right: Any) -> bool:
    return type(left) is type(right) and bool(left == right)


def _are_equal_tables(left: Table, right: Table) -> bool:
    return (
        left.sort == right.sort
        and np.array_equal(left.ids, right.ids)
        and left.columns.keys() == right.columns.keys()
        and all(_are_equal_arrays(left[name], right[name]) for name in left.columns)
    )


def _are_equal_arrays(left: np.ndarray[Any, Any], right: np.ndarray[Any, Any]) -> bool:
    may_hold_nan = left.dtype.kind in "fc" and right.dtype.kind in "fc"
    return np.array_equal(left, right, equal_nan=may_hold_nan)

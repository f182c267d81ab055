"""The point on the line between two samples.

Numbers, arrays and tuples of them are interpolated part by part. In tables the objects of both
samples are: their columns of floating-point numbers are interpolated, all others (names,
numbers of lanes, flags) keep what they were in the earlier sample. A value that is the same in
both samples stays what it is, whatever it is; anything else has no value in between. That
numbers are angles cannot be seen from them: interpolate sine and cosine instead.
"""

from typing import Any

import numpy as np

from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table, positions_of
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint

__all__ = ["interpolate"]


def interpolate(before: Sample[Any], after: Sample[Any], time: TimePoint) -> Any:
    """Return the value at *time*, from the samples before and after it; maybe `NO_VALUE`."""
    share = (time - before.valid_time) / (after.valid_time - before.valid_time)
    return _between(before.value, after.value, share)


def _between(before: Any, after: Any, share: float) -> Any:
    if _is_number(before) and _is_number(after):
        return before if before == after else before + share * (after - before)
    match before, after:
        case tuple(), tuple():
            return _between_tuples(before, after, share)
        case np.ndarray(), np.ndarray():
            return _between_arrays(before, after, share)
        case Table(), Table():
            return _between_tables(before, after, share)
        case _:
            return before if are_equal(before, after) else NO_VALUE


def _between_tuples(before: tuple[Any, ...], after: tuple[Any, ...], share: float) -> Any:
    if len(before) != len(after):
        return NO_VALUE
    parts = tuple(_between(b, a, share) for b, a in zip(before, after, strict=True))
    return NO_VALUE if any(part is NO_VALUE for part in parts) else parts


def _between_arrays(before: Any, after: Any, share: float) -> Any:
    are_numbers = before.dtype.kind in "iufc" and after.dtype.kind in "iufc"
    if are_numbers and before.shape == after.shape:
        return (1 - share) * before + share * after
    return before if are_equal(before, after) else NO_VALUE


def _between_tables(before: Table, after: Table, share: float) -> Any:
    if before.sort != after.sort:
        return NO_VALUE
    at = positions_of(before.ids, after.ids)
    first, then = before.select(at >= 0), after.select(at[at >= 0])
    floating = {name: column for name, column in first.columns.items() if column.dtype.kind == "f"}
    lines = {
        name: (1 - share) * column + share * then[name]
        for name, column in floating.items()
        if name in then and then[name].shape == column.shape
    }
    return first.with_columns(**lines)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.integer | np.floating) and not isinstance(
        value, bool
    )

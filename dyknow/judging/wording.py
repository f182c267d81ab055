"""How values and their differences are put into words, in short."""

from typing import Any

import numpy as np

from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.streams.values import are_equal
from dyknow.time import text_from_duration

__all__ = ["deviation", "difference", "short", "times"]

_LENGTH = 60


def short(value: Any) -> str:
    """Return a value in at most a line."""
    match value:
        case Table():
            return f"a table of {len(value)} {value.sort}"
        case np.ndarray():
            return f"an array {value.shape} of {value.dtype}"
        case _:
            text = repr(value.item() if isinstance(value, np.generic) else value)
            return text if len(text) <= _LENGTH else f"{text[: _LENGTH - 1]}…"


def times(sample: Sample[Any]) -> str:
    """Return the two times of a sample in words."""
    valid, available = map(text_from_duration, (sample.valid_time, sample.available_time))
    return f"valid at {valid} and available at {available}"


def deviation(expected: Sample[Any], found: Sample[Any]) -> tuple[str, str]:
    """Return in what a sample differs from the one that was expected; two empty texts if none."""
    wanted, instead = [], []
    for name in ("valid_time", "available_time"):
        one, other = getattr(expected, name), getattr(found, name)
        if one != other:
            what = name.replace("_", " ")
            wanted.append(f"{what} {text_from_duration(one)}")
            instead.append(f"{what} {text_from_duration(other)}")
    if not are_equal(expected.value, found.value):
        value, other_value = difference(expected.value, found.value)
        wanted.append(value)
        instead.append(other_value)
    return " and ".join(wanted), " and ".join(instead)


def difference(expected: Any, found: Any) -> tuple[str, str]:
    """Return two unequal values in words that tell where they differ first."""
    match expected, found:
        case Table(), Table():
            return _between_tables(expected, found)
        case tuple(), tuple():
            return _between_tuples(expected, found)
        case np.ndarray(), np.ndarray():
            return _between_arrays(expected, found)
        case _:
            return _named(short(expected), short(found), expected, found)


def _between_tables(expected: Table, found: Table) -> tuple[str, str]:
    if expected.sort != found.sort or list(expected.columns) != list(found.columns):
        return (
            f"a table of {expected.sort} with {', '.join(expected.columns)}",
            f"a table of {found.sort} with {', '.join(found.columns)}",
        )
    if not np.array_equal(expected.ids, found.ids):
        return f"objects {short(expected.ids.tolist())}", short(found.ids.tolist())
    for name, column in expected.columns.items():
        other = found[name]
        if column.dtype != other.dtype:
            return f"column '{name}' of {column.dtype}", str(other.dtype)
        if (unequal := _unequal(column, other)).any():
            row = np.argwhere(unequal)[0][0]
            place = f"{name}[{expected.symbol(expected.ids[row])}]"
            return f"{place} = {short(column[row])}", short(other[row])
    return short(expected), short(found)


def _between_tuples(expected: tuple[Any, ...], found: tuple[Any, ...]) -> tuple[str, str]:
    if len(expected) != len(found):
        return f"{len(expected)} values: {short(expected)}", f"{len(found)}: {short(found)}"
    for at, (one, other) in enumerate(zip(expected, found, strict=True), start=1):
        if not are_equal(one, other):
            what, instead = difference(one, other)
            return f"in place {at}, {what}", instead
    return short(expected), short(found)


def _between_arrays(
    expected: np.ndarray[Any, Any], found: np.ndarray[Any, Any]
) -> tuple[str, str]:
    if expected.shape != found.shape or expected.dtype != found.dtype:
        return short(expected), short(found)
    at = tuple(np.argwhere(_unequal(expected, found))[0].tolist())
    return f"{short(expected[at])} at {list(at)}", short(found[at])


def _unequal(
    expected: np.ndarray[Any, Any], found: np.ndarray[Any, Any]
) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Return where two arrays of one shape and type differ; nothing and nothing do not."""
    unequal = np.asarray(expected != found)
    if expected.dtype.kind in "fc":
        unequal &= ~(np.isnan(expected) & np.isnan(found))
    return unequal


def _named(one: str, other: str, expected: Any, found: Any) -> tuple[str, str]:
    if one != other:
        return one, other
    return f"{one} of {type(expected).__name__}", f"{other} of {type(found).__name__}"

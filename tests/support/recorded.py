"""Values that can be recorded, and whether two of them are the same to the last bit."""

import struct
from typing import Any

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = ["are_identical", "plain_values", "sample", "tables"]

_NUMBERS = st.one_of(
    hnp.floating_dtypes(sizes=(16, 32, 64), endianness="?"),
    hnp.integer_dtypes(endianness="?"),
    hnp.unsigned_integer_dtypes(endianness="?"),
    hnp.boolean_dtypes(),
    hnp.complex_number_dtypes(endianness="?"),
    hnp.datetime64_dtypes(),
    hnp.timedelta64_dtypes(),
)
_TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=4)
_SHAPES = hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=3)
_SCALARS = st.one_of(
    st.none(),
    st.just(NO_VALUE),
    st.booleans(),
    st.integers(),
    st.integers(-(1 << 63) - 2, (1 << 63) + 2),
    st.floats(),
    _TEXT,
    st.binary(max_size=4),
)
_KEYS = st.one_of(st.integers(), _TEXT, st.booleans())


@st.composite
def _bits(draw: st.DrawFn, shape: tuple[int, ...] | None = None) -> np.ndarray[Any, Any]:
    """Return an array of any bits, such as numbers that are none in all their forms."""
    dtype = draw(_NUMBERS)
    extents = draw(_SHAPES) if shape is None else shape
    n = int(np.prod(extents)) * dtype.itemsize
    if dtype.kind == "b":
        flags = draw(st.lists(st.booleans(), min_size=n, max_size=n))
        return np.array(flags, dtype).reshape(extents)
    return np.frombuffer(draw(st.binary(min_size=n, max_size=n)), dtype).reshape(extents)


@st.composite
def _texts(draw: st.DrawFn, shape: tuple[int, ...] | None = None) -> np.ndarray[Any, Any]:
    extents = draw(_SHAPES) if shape is None else shape
    n = int(np.prod(extents))
    kind = draw(st.sampled_from(["U", "S", "O"]))
    items = {"U": _TEXT, "S": st.binary(max_size=4), "O": _SCALARS}[kind]
    found = draw(st.lists(items, min_size=n, max_size=n))
    array = np.empty(n, dtype="O" if kind == "O" else f"{kind}5")
    for at, item in enumerate(found):
        array[at] = item
    return array.reshape(extents)


def _arrays(shape: tuple[int, ...] | None = None) -> st.SearchStrategy[np.ndarray[Any, Any]]:
    return st.one_of(_bits(shape), _texts(shape))


@st.composite
def tables(draw: st.DrawFn, sort: str | None = None) -> Table:
    """Return tables of few rows and columns, of every type of element."""
    ids = draw(st.lists(st.integers(0, 99), max_size=3, unique=True))
    names = draw(
        st.lists(st.sampled_from(["x", "X", "x_1", "x1", "ü", "ids", "a b"]), unique=True)
    )
    columns = {}
    for name in names:
        rest = draw(hnp.array_shapes(min_dims=0, max_dims=2, min_side=0, max_side=2))
        columns[name] = draw(_arrays((len(ids), *rest)))
    return Table(sort or draw(_TEXT), ids, columns)


def _containers(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.one_of(
        st.lists(inner, max_size=3),
        st.lists(inner, max_size=3).map(tuple),
        st.dictionaries(st.sampled_from(["a", "b", "c d"]), inner, max_size=3),
        st.dictionaries(_KEYS, inner, max_size=2),
        st.frozensets(_KEYS, max_size=3),
        st.sets(st.tuples(_KEYS), max_size=3),
    )


def plain_values() -> st.SearchStrategy[Any]:
    """Return values of every kind that can be recorded without a codec."""
    single = st.one_of(_SCALARS, _arrays(), _arrays(()).map(lambda array: array[()]), tables())
    return st.recursive(single, _containers, max_leaves=5)


def sample(value: Any, valid_time: int, available_time: int | None = None) -> Sample[Any]:
    """Return a sample without delay, or with one."""
    when = valid_time if available_time is None else available_time
    return Sample(value, TimePoint(valid_time), TimePoint(when))


def are_identical(one: Any, other: Any) -> bool:
    """Return whether two values are of the same types and have the same bits throughout."""
    return type(one) is type(other) and _have_same_bits(one, other)


def _have_same_bits(one: Any, other: Any) -> bool:
    match one:
        case np.ndarray() | np.generic():
            return _same_arrays(one, other)
        case Table():
            return _same_items(_parts(one), _parts(other))
        case dict():
            return _same_items([*one.items()], [*other.items()])
        case tuple() | list():
            return _same_items(one, other)
        case float():
            return struct.pack("<d", one) == struct.pack("<d", other)
        case _:
            return bool(one == other)


def _parts(table: Table) -> list[Any]:
    return [table.sort, table.ids, table.columns]


def _same_items(one: Any, other: Any) -> bool:
    return len(one) == len(other) and all(map(are_identical, one, other))


def _same_arrays(one: Any, other: Any) -> bool:
    if one.dtype != other.dtype or one.shape != other.shape:
        return False
    if one.dtype.kind == "O":
        return _same_items(one.ravel().tolist(), other.ravel().tolist())
    return bool(one.tobytes() == other.tobytes())

"""Columns as Arrow arrays, from their buffers.

`pyarrow.array` would do the same, but imports pandas first, which costs a short run more than all
that is kept of it.
"""

from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pyarrow as pa

__all__ = ["array_of"]

_BITS: Final = "little"
_DTYPES: Final = {
    pa.bool_(): np.bool_,
    pa.int32(): np.int32,
    pa.int64(): np.int64,
    pa.uint32(): np.uint32,
    pa.float32(): np.float32,
}


def array_of(values: Any, kind: pa.DataType, n: int) -> pa.Array:
    """Return a column of *n* rows.

    Args:
        values: An array, a list that may hold None, one text for all rows, or None for nothing.
        kind: What the column holds: whole numbers, numbers, truth values, texts, texts of which
            there are few, or lists of texts.
        n: How many rows there are.
    """
    if values is None:
        return pa.nulls(n, kind)
    if pa.types.is_dictionary(kind):
        return _few_texts(values, n)
    if pa.types.is_list(kind):
        return _lists(values)
    if pa.types.is_string(kind):
        return _texts(values)
    return _numbers(values, kind)


def _few_texts(values: str | Sequence[str] | npt.NDArray[Any], n: int) -> pa.Array:
    if isinstance(values, str):
        names, codes = [values], np.zeros(n, dtype=np.int32)
    else:
        known, inverse = np.unique(np.asarray(values, dtype=np.str_), return_inverse=True)
        names, codes = known.tolist(), inverse.astype(np.int32)
    indices = pa.Array.from_buffers(pa.int32(), n, [None, pa.py_buffer(codes)])
    return pa.DictionaryArray.from_arrays(indices, _texts(names))


def _texts(values: Iterable[str | None]) -> pa.Array:
    texts = list(values)
    data = [b"" if text is None else text.encode() for text in texts]
    buffers = [_validity(texts), _offsets(data), pa.py_buffer(b"".join(data))]
    return pa.Array.from_buffers(pa.string(), len(texts), buffers)


def _lists(values: Sequence[Sequence[str]]) -> pa.Array:
    texts = _texts(text for row in values for text in row)
    kind = pa.list_(pa.string())
    return pa.Array.from_buffers(kind, len(values), [None, _offsets(values)], children=[texts])


def _numbers(values: Sequence[Any] | npt.NDArray[Any], kind: pa.DataType) -> pa.Array:
    known = None if isinstance(values, np.ndarray) else _validity(values)
    filled = values if known is None else [0 if value is None else value for value in values]
    column: npt.NDArray[Any] = np.asarray(filled).astype(_DTYPES[kind], copy=False)
    if pa.types.is_boolean(kind):
        column = np.packbits(column, bitorder=_BITS)
    return pa.Array.from_buffers(
        kind, len(values), [known, pa.py_buffer(np.ascontiguousarray(column))]
    )


def _offsets(parts: Sequence[Sequence[Any]]) -> pa.Buffer:
    """Return where each part begins among all of them together, and where the last one ends."""
    offsets = np.zeros(len(parts) + 1, dtype=np.int32)
    np.cumsum([len(part) for part in parts], out=offsets[1:])
    return pa.py_buffer(offsets)


def _validity(values: Sequence[Any]) -> pa.Buffer | None:
    """Return which values there are, as bits; None if all are there."""
    known = np.array([value is not None for value in values], dtype=bool)
    return None if known.all() else pa.py_buffer(np.packbits(known, bitorder=_BITS))

"""From values to the bytes of messages, by a layout."""

from collections.abc import Callable, Mapping, Sequence
from struct import error, pack
from typing import Any

import numpy as np

from dyknow.recordings.codecs import Codec, codec_of
from dyknow.recordings.columns import BYTE_STRINGS, bytes_from_array
from dyknow.recordings.layout import (
    KIND_BY_TYPE,
    Field,
    Kind,
    Layout,
    Shape,
    Signature,
    plain_signature_of,
    signature_of_shape,
)
from dyknow.recordings.places import (
    FIRST_COLUMN,
    FIRST_OF_VALUE,
    Place,
    has_numbers,
    is_number,
    is_repeated_as_it_is,
    packing_of_shape,
    places_of,
)
from dyknow.recordings.wire import (
    DOUBLE,
    FIXED_64,
    VARINT,
    WORD,
    delimited,
    delimiter,
    tag,
    varint,
)
from dyknow.streams.table import Table

__all__ = ["MisfitError", "Write", "writer_of"]

Write = Callable[[Any], bytes]
"""Returns the bytes for a value."""

Codecs = Sequence[Codec]

_PACKED = {Kind.TRUTH: (bool, "?"), Kind.INTEGER: (int, "q"), Kind.NUMBER: (float, "d")}


class MisfitError(Exception):
    """The value needs a larger layout."""


def writer_of(layout: Layout, codecs: Codecs = (), first: int = FIRST_OF_VALUE) -> Write:
    """Return what writes a value of *layout* as the fields of a message from *first* on.

    What is returned raises a `MisfitError` for values of another layout, a TypeError for those
    that cannot be recorded, and a UnicodeError for texts that are not Unicode.
    """
    (places,) = places_of([Field("value", layout)], first)
    return _one_of(layout, places, codecs)


def _one_of(layout: Layout, places: Sequence[Place], codecs: Codecs) -> Write:
    """Return what writes a value to that of *places* which has its shape."""
    writers = {
        signature_of_shape(place.shape): _framed(place.number, place.shape, codecs)
        for place in places
    }
    if any(shape.kind is Kind.NONE for shape in layout):
        writers[(Kind.NONE,)] = _write_nothing
    simple = _by_type(writers)

    def write(value: Any) -> bytes:
        writer = simple.get(type(value))
        return writer(value) if writer is not None else _write_any(value, writers, codecs)

    return write


def _by_type(writers: Mapping[Signature, Write]) -> dict[type, Write]:
    """Return the writers for values of which the type says everything."""
    return {
        python_type: writers[(kind,)]
        for python_type, kind in KIND_BY_TYPE.items()
        if (kind,) in writers
    }


def _write_any(value: Any, writers: Mapping[Signature, Write], codecs: Codecs) -> bytes:
    signature = plain_signature_of(value)
    if signature is None:
        codec = codec_of(value, codecs)
        value = codec.encode(value)
        signature = (Kind.RECORD, codec.name, *value)
    writer = writers.get(signature)
    if writer is None and signature[:2] == (Kind.RECORD, ""):
        writer = writers.get((Kind.MAPPING,))
    if writer is None:
        raise MisfitError
    return writer(value)


def _write_nothing(_: Any) -> bytes:
    return b""


def _framed(number: int, shape: Shape, codecs: Codecs) -> Write:
    """Return what writes a value of *shape* as field *number*."""
    match shape.kind:
        case Kind.TRUTH | Kind.NO_VALUE:
            false, true = tag(number, VARINT) + b"\0", tag(number, VARINT) + b"\1"
            return lambda value: false if value is False else true
        case Kind.INTEGER:
            return _prefixed(tag(number, FIXED_64), WORD.pack)
        case Kind.NUMBER:
            return _prefixed(tag(number, FIXED_64), DOUBLE.pack)
        case Kind.SCALAR if is_number(shape):
            packing = packing_of_shape(shape)
            mark = tag(number, packing.wire_type)
            return _prefixed(mark, lambda value: bytes_from_array(value, packing))
        case Kind.SCALAR:
            return _elements(number, shape, codecs)
        case _:
            return _delimited(number, _content(shape, codecs))


def _prefixed(mark: bytes, write: Write) -> Write:
    return lambda value: mark + write(value)


def _delimited(number: int, write: Write) -> Write:
    delimit = delimiter(number)
    return lambda value: delimit(write(value))


def _content(shape: Shape, codecs: Codecs) -> Write:
    """Return what writes the content of a field that has a length."""
    simple: dict[Kind, Write] = {
        Kind.TEXT: str.encode,
        Kind.BYTES: bytes,
        Kind.LARGE_INTEGER: lambda value: hex(value).encode(),
    }
    makers: dict[Kind, Callable[[Shape, Codecs], Write]] = {
        Kind.SET: _set,
        Kind.FROZEN_SET: _set,
        Kind.RECORD: _record,
        Kind.MAPPING: _mapping,
        Kind.TABLE: _table,
        Kind.ARRAY: _array,
    }
    if shape.kind in simple:
        return simple[shape.kind]
    if shape.kind in makers:
        return makers[shape.kind](shape, codecs)
    return _items(1, shape.fields[0].layout, codecs)


def _items(number: int, layout: Layout, codecs: Codecs) -> Write:
    """Return what writes a sequence of items as field *number*, repeated."""
    if not is_repeated_as_it_is(layout):
        write = writer_of(layout, codecs, first=1)
        return lambda items: b"".join([delimited(number, write(item)) for item in items])
    if layout[0].kind in _PACKED:
        return _packed(number, *_PACKED[layout[0].kind])
    write_one = writer_of(layout, codecs, first=number)
    return lambda items: b"".join([write_one(item) for item in items])


def _packed(number: int, python_type: type, code: str) -> Write:
    def write(items: Sequence[Any]) -> bytes:
        if not all(type(item) is python_type for item in items):
            raise MisfitError
        try:
            return delimited(number, pack(f"<{len(items)}{code}", *items)) if items else b""
        except error:
            raise MisfitError from None

    return write


def _set(shape: Shape, codecs: Codecs) -> Write:
    """Return what writes the items of a set in the order of their bytes."""
    layout = shape.fields[0].layout
    write = _items(1, layout, codecs)
    key = writer_of(layout, codecs)
    return lambda items: write(sorted(items, key=key))


def _record(shape: Shape, codecs: Codecs) -> Write:
    writers = [
        _one_of(field.layout, places, codecs)
        for field, places in zip(shape.fields, places_of(shape.fields), strict=True)
    ]

    def write(fields: Mapping[str, Any]) -> bytes:
        return b"".join([w(value) for w, value in zip(writers, fields.values(), strict=True)])

    return write


def _mapping(shape: Shape, codecs: Codecs) -> Write:
    keys, values = (
        _items(number, field.layout, codecs) for number, field in enumerate(shape.fields, start=1)
    )
    return lambda mapping: keys(list(mapping)) + values(list(mapping.values()))


def _table(shape: Shape, codecs: Codecs) -> Write:
    places = places_of(shape.fields, FIRST_COLUMN)
    writers = [_elements(place.number, place.shape, codecs) for (place,) in places]

    def write(table: Table) -> bytes:
        columns = [w(column) for w, column in zip(writers, table.columns.values(), strict=True)]
        return delimited(1, table.ids.astype("<i8", copy=False).tobytes()) + b"".join(columns)

    return write


def _array(shape: Shape, codecs: Codecs) -> Write:
    elements = _elements(2, shape, codecs)

    def write(array: np.ndarray[Any, Any]) -> bytes:
        extents = b"".join([varint(extent) for extent in array.shape])
        return delimited(1, extents) + elements(array)

    return write


def _elements(number: int, shape: Shape, codecs: Codecs) -> Write:
    """Return what writes the elements of an array, or a numpy scalar, as field *number*."""
    if has_numbers(shape):
        packing = packing_of_shape(shape)
        return _delimited(number, lambda array: bytes_from_array(array, packing))
    if shape.fields:
        write = _items(1, shape.fields[0].layout, codecs)
        return _delimited(number, lambda array: write(array.ravel().tolist()))
    return _delimited(number, _write_strings)


def _write_strings(array: np.ndarray[Any, Any]) -> bytes:
    """Return the elements, and how many characters each of them has room for."""
    texts = array.ravel().tolist()
    contents = texts if array.dtype.kind == BYTE_STRINGS else [text.encode() for text in texts]
    items = b"".join([delimited(1, content) for content in contents])
    width = array.dtype.itemsize // array.dtype.alignment
    return items + tag(2, VARINT) + varint(width)

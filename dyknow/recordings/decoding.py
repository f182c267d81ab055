"""From the bytes of messages to values, by a layout."""

from collections.abc import Callable, Mapping
from struct import unpack_from
from typing import Any

import numpy as np

from dyknow.recordings.codecs import Codec
from dyknow.recordings.columns import BYTE_STRINGS, array_from_bytes
from dyknow.recordings.layout import Field, Kind, Layout, Shape
from dyknow.recordings.places import (
    FIRST_COLUMN,
    FIRST_OF_VALUE,
    has_numbers,
    is_repeated_as_it_is,
    packing_of_shape,
    places_of,
)
from dyknow.recordings.wire import DOUBLE, WORD, parts, varints
from dyknow.streams.sample import NO_VALUE
from dyknow.streams.table import Table

__all__ = ["Read", "reader_of"]

Read = Callable[[bytes, int, int], Any]
"""Returns the value whose bytes begin and end at the two positions."""

Codecs = Mapping[str, Codec]
"""Codecs by name."""

_CODES = {Kind.TRUTH: ("?", 1), Kind.INTEGER: ("q", 8), Kind.NUMBER: ("d", 8)}
_CONTAINERS: dict[Kind, Callable[[list[Any]], Any]] = {
    Kind.TUPLE: tuple,
    Kind.LIST: list,
    Kind.SET: set,
    Kind.FROZEN_SET: frozenset,
}


def reader_of(layout: Layout, codecs: Codecs, first: int = FIRST_OF_VALUE) -> Read:
    """Return what reads a value of *layout* from the fields of a message from *first* on.

    Raises:
        KeyError: There is no codec of a name that the layout has.
    """
    (places,) = places_of([Field("value", layout)], first)
    readers = {place.number: _content(place.shape, codecs) for place in places}

    def read(data: bytes, begin: int, end: int) -> Any:
        for number, start, stop in parts(data, begin, end):
            return readers[number](data, start, stop)
        return None

    return read


def _content(shape: Shape, codecs: Codecs) -> Read:
    """Return what reads the content of a field that holds a value of *shape*."""
    if shape.kind in _SIMPLE:
        return _SIMPLE[shape.kind]
    if shape.kind in _CONTAINERS:
        return _container(shape, codecs)
    makers = {
        Kind.RECORD: _record,
        Kind.MAPPING: _mapping,
        Kind.TABLE: _table,
        Kind.ARRAY: _array,
        Kind.SCALAR: _scalar,
    }
    return makers[shape.kind](shape, codecs)


def _read_truth(data: bytes, begin: int, _: int) -> bool:
    return data[begin] != 0


def _read_integer(data: bytes, begin: int, _: int) -> Any:
    return WORD.unpack_from(data, begin)[0]


def _read_number(data: bytes, begin: int, _: int) -> Any:
    return DOUBLE.unpack_from(data, begin)[0]


def _read_text(data: bytes, begin: int, end: int) -> str:
    return data[begin:end].decode()


def _read_large_integer(data: bytes, begin: int, end: int) -> int:
    return int(data[begin:end], 16)


_SIMPLE: dict[Kind, Read] = {
    Kind.NO_VALUE: lambda _data, _begin, _end: NO_VALUE,
    Kind.TRUTH: _read_truth,
    Kind.INTEGER: _read_integer,
    Kind.NUMBER: _read_number,
    Kind.TEXT: _read_text,
    Kind.BYTES: lambda data, begin, end: data[begin:end],
    Kind.LARGE_INTEGER: _read_large_integer,
}

ReadMany = Callable[[bytes, int, int], list[Any]]
"""Returns the items in one occurrence of a repeated field."""


def _items(layout: Layout, codecs: Codecs) -> ReadMany:
    """Return what reads the items in one occurrence of a repeated field."""
    if is_repeated_as_it_is(layout):
        kind = layout[0].kind
        if kind in _CODES:
            return _packed(*_CODES[kind])
        read = _content(layout[0], codecs)
    else:
        read = reader_of(layout, codecs, first=1)
    return lambda data, begin, end: [read(data, begin, end)]


def _packed(code: str, size: int) -> ReadMany:
    def read(data: bytes, begin: int, end: int) -> list[Any]:
        return list(unpack_from(f"<{(end - begin) // size}{code}", data, begin))

    return read


def _collected(
    data: bytes, begin: int, end: int, readers: Mapping[int, ReadMany]
) -> dict[int, list[Any]]:
    """Return the items of each repeated field of a message."""
    items: dict[int, list[Any]] = {number: [] for number in readers}
    for number, start, stop in parts(data, begin, end):
        items[number].extend(readers[number](data, start, stop))
    return items


def _container(shape: Shape, codecs: Codecs) -> Read:
    make, items = _CONTAINERS[shape.kind], {1: _items(shape.fields[0].layout, codecs)}
    return lambda data, begin, end: make(_collected(data, begin, end, items)[1])


def _record(shape: Shape, codecs: Codecs) -> Read:
    names = [field.name for field in shape.fields]
    readers = {
        place.number: (field.name, _content(place.shape, codecs))
        for field, places in zip(shape.fields, places_of(shape.fields), strict=True)
        for place in places
    }
    codec = codecs[str(shape.detail[0])] if shape.detail[0] else None

    def read(data: bytes, begin: int, end: int) -> Any:
        fields: dict[str, Any] = dict.fromkeys(names)
        for number, start, stop in parts(data, begin, end):
            name, read_one = readers[number]
            fields[name] = read_one(data, start, stop)
        return fields if codec is None else codec.decode(fields)

    return read


def _mapping(shape: Shape, codecs: Codecs) -> Read:
    keys, values = (_items(field.layout, codecs) for field in shape.fields)

    def read(data: bytes, begin: int, end: int) -> dict[Any, Any]:
        items = _collected(data, begin, end, {1: keys, 2: values})
        return dict(zip(items[1], items[2], strict=True))

    return read


def _table(shape: Shape, codecs: Codecs) -> Read:
    sort = str(shape.detail[0])
    names = [field.name for field in shape.fields]
    readers = [
        (place.number, _elements(place.shape, codecs), _rows_of(place.shape))
        for (place,) in places_of(shape.fields, FIRST_COLUMN)
    ]

    def read(data: bytes, begin: int, end: int) -> Table:
        extents = {number: (start, stop) for number, start, stop in parts(data, begin, end)}
        start, stop = extents.get(1, (0, 0))
        ids = np.frombuffer(data[start:stop], "<i8").astype(np.int64)
        columns = {
            name: read_column(data, *extents.get(number, (0, 0)), (len(ids), *rows))
            for name, (number, read_column, rows) in zip(names, readers, strict=True)
        }
        return Table(sort, ids, columns)

    return read


def _rows_of(shape: Shape) -> tuple[int, ...]:
    return tuple(int(extent) for extent in shape.detail[1:])


def _array(shape: Shape, codecs: Codecs) -> Read:
    elements = _elements(shape, codecs)

    def read(data: bytes, begin: int, end: int) -> Any:
        extents = {number: (start, stop) for number, start, stop in parts(data, begin, end)}
        lengths = tuple(varints(data, *extents.get(1, (0, 0))))
        return elements(data, *extents.get(2, (0, 0)), lengths)

    return read


def _scalar(shape: Shape, codecs: Codecs) -> Read:
    elements = _elements(shape, codecs)
    return lambda data, begin, end: elements(data, begin, end, ())[()]


ReadElements = Callable[[bytes, int, int, tuple[int, ...]], np.ndarray[Any, Any]]
"""Returns the array of the given shape whose bytes begin and end at the two positions."""


def _elements(shape: Shape, codecs: Codecs) -> ReadElements:
    """Return what reads the elements of an array."""
    element = str(shape.detail[0])
    if has_numbers(shape):
        dtype, packing = np.dtype(element), packing_of_shape(shape)
        return lambda data, begin, end, lengths: array_from_bytes(
            data[begin:end], packing, dtype, lengths
        )
    if shape.fields:
        return _objects(_items(shape.fields[0].layout, codecs))
    return _read_byte_strings if element == BYTE_STRINGS else _read_strings


def _objects(items: ReadMany) -> ReadElements:
    def read(data: bytes, begin: int, end: int, lengths: tuple[int, ...]) -> Any:
        array = np.empty(lengths, dtype=object)
        found = [item for at in parts(data, begin, end) for item in items(data, *at[1:])]
        for at, item in enumerate(found):
            array.flat[at] = item
        return array

    return read


def _read_strings(
    data: bytes, begin: int, end: int, lengths: tuple[int, ...]
) -> np.ndarray[Any, Any]:
    contents, width = _strings(data, begin, end)
    return np.array([each.decode() for each in contents], dtype=f"U{width}").reshape(lengths)


def _read_byte_strings(
    data: bytes, begin: int, end: int, lengths: tuple[int, ...]
) -> np.ndarray[Any, Any]:
    contents, width = _strings(data, begin, end)
    return np.array(contents, dtype=f"S{width}").reshape(lengths)


def _strings(data: bytes, begin: int, end: int) -> tuple[list[bytes], int]:
    contents: list[bytes] = []
    width = 1
    for number, start, stop in parts(data, begin, end):
        if number == 1:
            contents.append(data[start:stop])
        else:
            (width,) = varints(data, start, stop)
    return contents, width

"""What the values of a stream look like: which fields their messages need.

A layout is the set of shapes that have been seen in one place. It begins with the first value of a
stream, and grows when one comes that does not fit: a number where there were texts, a column more.
All that was there stays, so that a layout can write everything that it has grown from.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from dyknow.recordings.codecs import Codec, codec_of
from dyknow.recordings.columns import OBJECTS, element_type
from dyknow.streams.sample import NoValue
from dyknow.streams.table import Table

__all__ = [
    "EMPTY",
    "ITEMS",
    "KIND_BY_TYPE",
    "Field",
    "Kind",
    "Layout",
    "Shape",
    "Signature",
    "grown",
    "layout_from_plain",
    "plain_from_layout",
    "plain_signature_of",
    "signature_of_shape",
]


class Kind(StrEnum):
    """The kinds of value that can be told apart in a file."""

    NONE = "none"
    NO_VALUE = "no_value"
    TRUTH = "truth"
    INTEGER = "integer"
    LARGE_INTEGER = "large_integer"
    NUMBER = "number"
    TEXT = "text"
    BYTES = "bytes"
    SCALAR = "scalar"
    ARRAY = "array"
    TUPLE = "tuple"
    LIST = "list"
    SET = "set"
    FROZEN_SET = "frozen_set"
    RECORD = "record"
    MAPPING = "mapping"
    TABLE = "table"
    COLUMN = "column"


@dataclass(frozen=True, slots=True)
class Field:
    """A place in a message and what has been seen there."""

    name: str
    layout: "Layout"


@dataclass(frozen=True, slots=True)
class Shape:
    """One kind of value with all that has to be known to read it.

    Attributes:
        kind: The kind.
        detail: What else tells it from others of its kind: the type of the elements of an array
            or a column, then a column's shape without the rows; the sort of a table; the codec
            of a record, an empty text for a dictionary.
        fields: The places of what it is made of: columns, items, named fields.
    """

    kind: Kind
    detail: tuple[str | int, ...] = ()
    fields: tuple[Field, ...] = ()


Layout = tuple[Shape, ...]
"""What has been seen in one place, in order of appearance, each signature once."""

EMPTY: Layout = ()
"""The layout of a place where nothing has been seen."""

Signature = tuple[Any, ...]
"""What values have in common that one shape can write."""

ITEMS = frozenset({Kind.TUPLE, Kind.LIST, Kind.SET, Kind.FROZEN_SET})
"""The kinds of value that are made of items."""

KIND_BY_TYPE: dict[type, Kind] = {
    type(None): Kind.NONE,
    NoValue: Kind.NO_VALUE,
    bool: Kind.TRUTH,
    float: Kind.NUMBER,
    str: Kind.TEXT,
    bytes: Kind.BYTES,
    tuple: Kind.TUPLE,
    list: Kind.LIST,
    set: Kind.SET,
    frozenset: Kind.FROZEN_SET,
}
"""The kinds that the type of a value says alone."""


def plain_signature_of(value: object) -> Signature | None:
    """Return the signature of a plain value; None if it takes a codec.

    The signature of a dictionary is as if its keys were names of fields.

    Raises:
        TypeError: It is an array that cannot be recorded.
    """
    kind = KIND_BY_TYPE.get(type(value))
    if kind is not None:
        return (kind,)
    match value:
        case int() if type(value) is int:
            fits = -(1 << 63) <= value < 1 << 63
            return (Kind.INTEGER if fits else Kind.LARGE_INTEGER,)
        case Table():
            return _signature_of_table(value)
        case np.ndarray() | np.generic():
            return _signature_of_array(value)
        case dict() if type(value) is dict:
            return (Kind.RECORD, "", *value)
        case _:
            return None


def signature_of_shape(shape: Shape) -> Signature:
    """Return the signature of the values that *shape* can write."""
    match shape.kind:
        case Kind.TABLE:
            columns = [(field.name, *field.layout[0].detail) for field in shape.fields]
            return (Kind.TABLE, *shape.detail, *columns)
        case Kind.RECORD:
            return (Kind.RECORD, *shape.detail, *(field.name for field in shape.fields))
        case _:
            return (shape.kind, *shape.detail)


def grown(layout: Layout, value: object, codecs: Sequence[Codec] = ()) -> Layout:
    """Return *layout* with what it needs to write *value* as well.

    Raises:
        TypeError: Values of this type, or of a part of it, cannot be recorded.
    """
    signature = plain_signature_of(value)
    if signature is None:
        codec = codec_of(value, codecs)
        signature = (Kind.RECORD, codec.name, *codec.encode(value))
    elif signature[:2] == (Kind.RECORD, "") and not _suits(layout, signature):
        signature = (Kind.MAPPING,)
    for at, shape in enumerate(layout):
        if signature_of_shape(shape) == signature:
            return (*layout[:at], _grown_shape(shape, value, codecs), *layout[at + 1 :])
    return (*layout, _grown_shape(_new_shape(signature), value, codecs))


def plain_from_layout(layout: Layout) -> list[Any]:
    """Return *layout* as lists and texts, for JSON."""
    return [
        [
            shape.kind.value,
            list(shape.detail),
            [[field.name, plain_from_layout(field.layout)] for field in shape.fields],
        ]
        for shape in layout
    ]


def layout_from_plain(plain: list[Any]) -> Layout:
    """Return the layout that `plain_from_layout` has made *plain* of.

    Raises:
        TypeError, ValueError: It is something else.
    """
    return tuple(
        Shape(
            Kind(kind),
            tuple(detail),
            tuple(Field(name, layout_from_plain(layout)) for name, layout in fields),
        )
        for kind, detail, fields in plain
    )


def _signature_of_array(array: np.ndarray[Any, Any] | np.generic) -> Signature | None:
    if isinstance(array, np.generic):
        return (Kind.SCALAR, element_type(array.dtype))
    return (Kind.ARRAY, element_type(array.dtype)) if type(array) is np.ndarray else None


def _signature_of_table(table: Table) -> Signature:
    columns = [
        (name, element_type(column.dtype), *column.shape[1:])
        for name, column in table.columns.items()
    ]
    return (Kind.TABLE, table.sort, *columns)


def _suits(layout: Layout, signature: Signature) -> bool:
    """Return whether a dictionary is written as named fields.

    The first one is, if its keys are texts, and those with the same keys in the same order; all
    others are written as pairs, so that keys that come and go do not let the layout grow.
    """
    for shape in layout:
        if shape.kind is Kind.RECORD and not shape.detail[0]:
            return signature_of_shape(shape) == signature
    is_first = all(shape.kind is not Kind.MAPPING for shape in layout)
    return is_first and all(type(key) is str for key in signature[2:])


def _new_shape(signature: Signature) -> Shape:
    """Return the shape of a signature, in whose places nothing has been seen."""
    kind, *rest = signature
    match kind:
        case Kind.TABLE:
            fields = [
                Field(name, (_elements(Kind.COLUMN, *detail),)) for name, *detail in rest[1:]
            ]
            return Shape(kind, (rest[0],), tuple(fields))
        case Kind.RECORD:
            return Shape(kind, (rest[0],), tuple(Field(name, EMPTY) for name in rest[1:]))
        case Kind.MAPPING:
            return Shape(kind, (), (Field("keys", EMPTY), Field("values", EMPTY)))
        case Kind.ARRAY | Kind.SCALAR:
            return _elements(kind, *rest)
        case _:
            return Shape(kind, (), (Field("items", EMPTY),) if kind in ITEMS else ())


def _elements(kind: Kind, element: str, *rows: int) -> Shape:
    fields = (Field("items", EMPTY),) if element == OBJECTS else ()
    return Shape(kind, (element, *rows), fields)


def _grown_shape(shape: Shape, value: Any, codecs: Sequence[Codec]) -> Shape:
    """Return *shape* with what its places need to write *value*."""
    if not shape.fields:
        return shape
    if shape.kind is Kind.TABLE:
        columns = tuple(
            Field(field.name, (_grown_shape(field.layout[0], value[field.name], codecs),))
            for field in shape.fields
        )
        return Shape(shape.kind, shape.detail, columns)
    fields = tuple(
        Field(field.name, _grown_for_all(field.layout, values, codecs))
        for field, values in zip(shape.fields, _places(shape, value, codecs), strict=True)
    )
    return Shape(shape.kind, shape.detail, fields)


def _grown_for_all(layout: Layout, values: Iterable[object], codecs: Sequence[Codec]) -> Layout:
    for value in values:
        layout = grown(layout, value, codecs)
    return layout


def _places(shape: Shape, value: Any, codecs: Sequence[Codec]) -> list[Iterable[object]]:
    """Return the values that are found in each place of *value*."""
    match shape.kind:
        case Kind.RECORD:
            named = codec_of(value, codecs).encode(value) if shape.detail[0] else value
            return [[each] for each in named.values()]
        case Kind.MAPPING:
            return [value.keys(), value.values()]
        case Kind.COLUMN | Kind.ARRAY | Kind.SCALAR:
            return [value.ravel().tolist()]
        case _:
            return [value]

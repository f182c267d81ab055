"""Schemas of protocol buffers, made at run time, by which viewers read the fields of samples."""

import re
from collections.abc import Sequence
from typing import Any

from google.protobuf.descriptor_pb2 import (
    DescriptorProto,
    EnumDescriptorProto,
    EnumValueDescriptorProto,
    FieldDescriptorProto,
    FileDescriptorProto,
    FileDescriptorSet,
    OneofDescriptorProto,
)
from google.protobuf.message import Message

from dyknow.recordings.columns import BYTE_STRINGS
from dyknow.recordings.layout import Field, Kind, Layout, Shape
from dyknow.recordings.places import (
    FIRST_COLUMN,
    FIRST_OF_VALUE,
    Place,
    has_numbers,
    identifier,
    is_number,
    is_repeated_as_it_is,
    packing_of_shape,
    places_of,
)

__all__ = ["PACKAGE", "schema_of_message", "schema_of_samples", "type_name"]

PACKAGE = "dyknow"

_T = FieldDescriptorProto
_TIMES = ("valid_time", "available_time")
_KINDS = ("SAMPLE", "NO_VALUE", "HEARTBEAT")
_TYPES = {
    Kind.NO_VALUE: _T.TYPE_BOOL,
    Kind.TRUTH: _T.TYPE_BOOL,
    Kind.INTEGER: _T.TYPE_SFIXED64,
    Kind.LARGE_INTEGER: _T.TYPE_STRING,
    Kind.NUMBER: _T.TYPE_DOUBLE,
    Kind.TEXT: _T.TYPE_STRING,
    Kind.BYTES: _T.TYPE_BYTES,
}


def type_name(topic: str) -> str:
    """Return what the messages of a topic are: `dyknow.percepts_vision` for percepts[vision]."""
    name = re.sub(r"\W+", "_", topic, flags=re.ASCII).strip("_")
    return f"{PACKAGE}.{name}" if name[:1].isalpha() else f"{PACKAGE}.s_{name}"


def schema_of_samples(topic: str, layout: Layout | None) -> bytes:
    """Return the file descriptor set for the samples of a topic, with values of *layout*.

    Without a layout the samples refer to those of a provider.
    """
    message = _sample_message(topic)
    if layout is None:
        message.add("origin", FIRST_OF_VALUE, _T.TYPE_SFIXED64)
    else:
        message.add_places([Field("value", layout)], FIRST_OF_VALUE)
    return _serialised(message.proto)


def schema_of_message(message_type: type[Message]) -> bytes:
    """Return the file descriptor set of a message type that exists, with all it needs."""
    files: dict[str, FileDescriptorProto] = {}
    _collect(message_type.DESCRIPTOR.file, files)
    return FileDescriptorSet(file=files.values()).SerializeToString(deterministic=True)


def _collect(file: Any, files: dict[str, FileDescriptorProto]) -> None:
    """Add the file descriptor *file* to *files*, after all that it needs."""
    for needed in file.dependencies:
        _collect(needed, files)
    if file.name not in files:
        proto = FileDescriptorProto()
        file.CopyToProto(proto)
        files[file.name] = proto


def _serialised(message: DescriptorProto) -> bytes:
    file = FileDescriptorProto(
        name=f"{message.name}.proto", package=PACKAGE, syntax="proto3", message_type=[message]
    )
    return FileDescriptorSet(file=[file]).SerializeToString(deterministic=True)


def _sample_message(topic: str) -> "_Message":
    """Return the message of a sample without its value."""
    message = _Message(type_name(topic).removeprefix(f"{PACKAGE}."))
    for number, name in enumerate(_TIMES, start=1):
        message.add(name, number, _T.TYPE_SFIXED64)
    values = [EnumValueDescriptorProto(name=kind, number=at) for at, kind in enumerate(_KINDS)]
    message.proto.enum_type.append(EnumDescriptorProto(name="Kind", value=values))
    message.add("kind", 3, _T.TYPE_ENUM).type_name = "Kind"
    return message


class _Message:
    """A message type that is being made."""

    def __init__(self, name: str) -> None:
        self.proto = DescriptorProto(name=name)
        self._names: set[str] = set()

    def add_places(self, fields: Sequence[Field], first: int) -> None:
        """Add a field for each place of *fields*; those of one place exclude each other."""
        places = places_of(fields, first, [field.name for field in self.proto.field])
        self._names |= {place.name for here in places for place in here}
        for field, here in zip(fields, places, strict=True):
            if here:
                index = len(self.proto.oneof_decl)
                name = self._free(f"{identifier(field.name)}_kind")
                self.proto.oneof_decl.append(OneofDescriptorProto(name=name))
                for place in here:
                    self.add_shape(place).oneof_index = index

    def add_shape(self, place: Place, *, is_repeated: bool = False) -> FieldDescriptorProto:
        """Add a field for values of a shape."""
        shape = place.shape
        if shape.kind in _TYPES:
            return self.add(place.name, place.number, _TYPES[shape.kind], is_repeated=is_repeated)
        if shape.kind is Kind.SCALAR and has_numbers(shape):
            packing = packing_of_shape(shape)
            kind = packing.field_type if is_number(shape) else _T.TYPE_BYTES
            return self.add(place.name, place.number, kind)
        return self.add_message(place.name, place.number, shape, is_repeated=is_repeated)

    def add_message(
        self, name: str, number: int, shape: Shape, *, is_repeated: bool = False
    ) -> FieldDescriptorProto:
        """Add a field for messages with what *shape* is made of."""
        nested = _Message(self._free(name.title().replace("_", "")))
        nested.fill(shape)
        return self._add_nested(name, number, nested, is_repeated=is_repeated)

    def fill(self, shape: Shape) -> None:
        """Add the fields of what *shape* is made of."""
        match shape.kind:
            case Kind.RECORD:
                self.add_places(shape.fields, 1)
            case Kind.TABLE:
                self._fill_table(shape)
            case Kind.ARRAY:
                self.add("shape", 1, _T.TYPE_UINT64, is_repeated=True)
                self.add_elements("elements", 2, shape)
            case Kind.SCALAR:
                self.fill_elements(shape)
            case _:
                for number, field in enumerate(shape.fields, start=1):
                    self.add_items(field.name, number, field.layout)

    def add_items(self, name: str, number: int, layout: Layout) -> None:
        """Add a repeated field for items of *layout*."""
        if is_repeated_as_it_is(layout):
            self.add_shape(Place(number, name, layout[0]), is_repeated=True)
        else:
            nested = _Message(self._free(name.title().replace("_", "")))
            nested.add_places([Field("value", layout)], 1)
            self._add_nested(name, number, nested, is_repeated=True)

    def add_elements(self, name: str, number: int, shape: Shape) -> None:
        """Add a field for the elements of an array."""
        if has_numbers(shape):
            packing = packing_of_shape(shape)
            self.add(name, number, packing.field_type, is_repeated=packing.wire is not None)
        else:
            nested = _Message(self._free(name.title().replace("_", "")))
            nested.fill_elements(shape)
            self._add_nested(name, number, nested, is_repeated=False)

    def fill_elements(self, shape: Shape) -> None:
        """Add the fields of elements that are not numbers."""
        if shape.fields:
            self.add_items("items", 1, shape.fields[0].layout)
        else:
            is_bytes = shape.detail[0] == BYTE_STRINGS
            kind = _T.TYPE_BYTES if is_bytes else _T.TYPE_STRING
            self.add("items", 1, kind, is_repeated=True)
            self.add("width", 2, _T.TYPE_UINT32)

    def add(
        self, name: str, number: int, kind: _T.Type.ValueType, *, is_repeated: bool = False
    ) -> FieldDescriptorProto:
        """Add a field of a type that needs no message."""
        label = _T.LABEL_REPEATED if is_repeated else _T.LABEL_OPTIONAL
        self._names.add(name)
        return self.proto.field.add(name=name, number=number, type=kind, label=label)

    def _fill_table(self, shape: Shape) -> None:
        places = places_of(shape.fields, FIRST_COLUMN, ["ids"])
        self._names |= {place.name for (place,) in places}
        self.add("ids", 1, _T.TYPE_SFIXED64, is_repeated=True)
        for (place,) in places:
            self.add_elements(place.name, place.number, place.shape)

    def _add_nested(
        self, name: str, number: int, nested: "_Message", *, is_repeated: bool
    ) -> FieldDescriptorProto:
        self._names.add(nested.proto.name)
        self.proto.nested_type.append(nested.proto)
        field = self.add(name, number, _T.TYPE_MESSAGE, is_repeated=is_repeated)
        field.type_name = nested.proto.name
        return field

    def _free(self, name: str) -> str:
        """Return a name that nothing in the message has."""
        while name in self._names:
            name += "_"
        return name

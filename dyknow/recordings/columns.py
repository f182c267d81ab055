"""Numpy arrays as packed fields of protocol buffers, bit for bit and back.

Numbers are written with the type of field whose bytes are the array's own. Integers of 8 and 16
bits are widened to 32, since packed fields have nothing smaller that keeps its width; complex
numbers are written as pairs. What no field can show, such as half precision, is written as bytes.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from google.protobuf.descriptor_pb2 import FieldDescriptorProto

from dyknow.recordings.wire import FIXED_32, FIXED_64, LENGTH, VARINT

__all__ = [
    "BYTE_STRINGS",
    "OBJECTS",
    "RAW",
    "STRINGS",
    "Packing",
    "array_from_bytes",
    "bytes_from_array",
    "element_type",
    "packing_of",
]

Array = npt.NDArray[Any]


OBJECTS = "O"
STRINGS = "U"
BYTE_STRINGS = "S"


@dataclass(frozen=True, slots=True)
class Packing:
    """How the elements of an array are written.

    Attributes:
        field_type: The type of the field, of `FieldDescriptorProto`.
        wire: The type of the elements as written; None for the array's own bytes.
        is_view: Whether the bytes are taken as they are, not converted to the type *wire*.
        shows_one: Whether one element is one number in the field.
    """

    field_type: FieldDescriptorProto.Type.ValueType
    wire: np.dtype[Any] | None
    is_view: bool = True
    shows_one: bool = True

    @property
    def wire_type(self) -> int:
        """How one element by itself is written, on the wire."""
        if self.wire is None:
            return LENGTH
        return {8: FIXED_64, 4: FIXED_32, 1: VARINT}[self.wire.itemsize]


RAW = Packing(FieldDescriptorProto.TYPE_BYTES, None, shows_one=False)
"""Bytes that only those can read who know the type."""

_PACKING_BY_TYPE = {
    "f8": Packing(FieldDescriptorProto.TYPE_DOUBLE, np.dtype("<f8")),
    "f4": Packing(FieldDescriptorProto.TYPE_FLOAT, np.dtype("<f4")),
    "c16": Packing(FieldDescriptorProto.TYPE_DOUBLE, np.dtype("<f8"), shows_one=False),
    "c8": Packing(FieldDescriptorProto.TYPE_FLOAT, np.dtype("<f4"), shows_one=False),
    "i8": Packing(FieldDescriptorProto.TYPE_SFIXED64, np.dtype("<i8")),
    "u8": Packing(FieldDescriptorProto.TYPE_FIXED64, np.dtype("<u8")),
    "i4": Packing(FieldDescriptorProto.TYPE_SFIXED32, np.dtype("<i4")),
    "u4": Packing(FieldDescriptorProto.TYPE_FIXED32, np.dtype("<u4")),
    "i2": Packing(FieldDescriptorProto.TYPE_SFIXED32, np.dtype("<i4"), is_view=False),
    "u2": Packing(FieldDescriptorProto.TYPE_FIXED32, np.dtype("<u4"), is_view=False),
    "i1": Packing(FieldDescriptorProto.TYPE_SFIXED32, np.dtype("<i4"), is_view=False),
    "u1": Packing(FieldDescriptorProto.TYPE_FIXED32, np.dtype("<u4"), is_view=False),
    "b1": Packing(FieldDescriptorProto.TYPE_BOOL, np.dtype("|b1")),
    "M8": Packing(FieldDescriptorProto.TYPE_SFIXED64, np.dtype("<i8")),
    "m8": Packing(FieldDescriptorProto.TYPE_SFIXED64, np.dtype("<i8")),
}


@lru_cache(maxsize=256)
def element_type(dtype: np.dtype[Any]) -> str:
    """Return what has to be known of the elements of an array; of texts, not how long they are.

    Raises:
        TypeError: Arrays of this type cannot be recorded.
    """
    if dtype.kind == "V" or (dtype.kind == "U" and not dtype.isnative):
        raise TypeError(f"numpy's type '{dtype}' cannot be recorded")
    return dtype.kind if dtype.kind in "OUS" else dtype.str


def packing_of(dtype: np.dtype[Any]) -> Packing:
    """Return how elements of type *dtype* are written."""
    return _PACKING_BY_TYPE.get(f"{dtype.kind}{dtype.itemsize}", RAW)


def bytes_from_array(array: Array | np.generic, packing: Packing) -> bytes:
    """Return the elements of *array*, row by row, as the content of a packed field."""
    if packing.wire is None:
        return array.tobytes()
    wire = array.dtype.newbyteorder("<") if packing.is_view else packing.wire
    return array.astype(wire, copy=False).tobytes()


def array_from_bytes(
    content: bytes, packing: Packing, dtype: np.dtype[Any], shape: tuple[int, ...]
) -> Array:
    """Return the array that `bytes_from_array` has made *content* of; it owns its elements.

    Raises:
        ValueError: The content is not that of an array of this type and shape.
    """
    if packing.wire is None:
        return np.frombuffer(content, dtype).reshape(shape).copy()
    wire = dtype.newbyteorder("<") if packing.is_view else packing.wire
    return np.frombuffer(content, wire).astype(dtype).reshape(shape)

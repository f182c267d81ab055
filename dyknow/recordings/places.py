"""Where the values of a layout stand in a message: the numbers and names of fields.

The writer, the reader and the schema number fields alike because all three ask here. A place whose
values are of several shapes has a field for each, of which one is set; none of them is set for
None. Items of one shape are a repeated field; items of several shapes are messages of their own.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from dyknow.recordings.columns import BYTE_STRINGS, OBJECTS, RAW, STRINGS, Packing, packing_of
from dyknow.recordings.layout import Field, Kind, Layout, Shape

__all__ = [
    "FIRST_COLUMN",
    "FIRST_OF_VALUE",
    "Place",
    "has_numbers",
    "identifier",
    "is_number",
    "is_repeated_as_it_is",
    "packing_of_shape",
    "places_of",
]

FIRST_OF_VALUE = 4
"""The number of the first field of a sample's value; those before are its times and its kind."""

FIRST_COLUMN = 2
"""The number of the field of a table's first column; that before is its ids."""

_ONLY_IN_FIELDS_OF_THEIR_OWN = {Kind.NONE, Kind.NO_VALUE, Kind.SCALAR}


@dataclass(frozen=True, slots=True)
class Place:
    """A field of a message.

    Attributes:
        number: Its number.
        name: Its name, unique in the message.
        shape: What it holds.
    """

    number: int
    name: str
    shape: Shape


def places_of(
    fields: Sequence[Field], first: int = 1, taken: Iterable[str] = ()
) -> list[list[Place]]:
    """Return the places of each of *fields*, numbered from *first* on.

    *taken* are the names of other fields of the message.
    """
    names = {_canonical(name) for name in taken}
    number = first
    places: list[list[Place]] = []
    for field in fields:
        here: list[Place] = []
        for shape in field.layout:
            if shape.kind is not Kind.NONE:
                wanted = f"{field.name}_{shape.kind.value}" if here else field.name
                here.append(Place(number, _unique(wanted, names), shape))
                number += 1
        places.append(here)
    return places


def is_repeated_as_it_is(layout: Layout) -> bool:
    """Return whether items of this layout are one repeated field."""
    return len(layout) == 1 and layout[0].kind not in _ONLY_IN_FIELDS_OF_THEIR_OWN


def has_numbers(shape: Shape) -> bool:
    """Return whether the elements of an array of this shape are a packed field, or raw bytes."""
    return shape.detail[0] not in {OBJECTS, STRINGS, BYTE_STRINGS}


def is_number(shape: Shape) -> bool:
    """Return whether a numpy scalar of this shape is a number that a field can show."""
    return has_numbers(shape) and packing_of_shape(shape).shows_one


def packing_of_shape(shape: Shape) -> Packing:
    """Return how the numbers of a column, an array or a scalar are written.

    Arrays of single bytes are pictures, and stay bytes.
    """
    dtype = np.dtype(str(shape.detail[0]))
    is_picture = shape.kind is Kind.ARRAY and dtype.kind in "iu" and dtype.itemsize == 1
    return RAW if is_picture else packing_of(dtype)


def identifier(text: str) -> str:
    """Return *text* as far as a schema may have it as a name."""
    name = re.sub(r"\W", "_", text, flags=re.ASCII)
    return name if name[:1].isalpha() else f"f_{name}"


def _unique(wanted: str, names: set[str]) -> str:
    """Return a name for *wanted* that a schema may have, and add it to *names*."""
    name = identifier(wanted)
    candidate, number = name, 2
    while _canonical(candidate) in names:
        candidate, number = f"{name}_{number}", number + 1
    names.add(_canonical(candidate))
    return candidate


def _canonical(name: str) -> str:
    """Return what must be unique: schemas do not tell `x_1` from `x1` and `X1`."""
    return name.replace("_", "").lower()

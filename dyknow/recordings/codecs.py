"""How values of an application come to be plain ones, which can be recorded, and back.

Plain values are None, NO_VALUE, bool, int, float, str, bytes, numpy scalars and arrays, tables,
and tuples, lists, sets and dictionaries of plain values and of values that have a codec.
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any, Protocol

__all__ = ["Codec", "DataclassCodec", "codec_of"]


class Codec(Protocol):
    """Translates the values of one type.

    Attributes:
        name: What the type is called in the file; a viewer shows it as the name of a message.
    """

    @property
    def name(self) -> str:
        """The name of the type in the file."""

    def handles(self, value: object) -> bool:
        """Return whether *value* is of this type."""

    def encode(self, value: Any) -> Mapping[str, object]:
        """Return *value* as named fields, the same names in the same order for all values."""

    def decode(self, fields: dict[str, Any]) -> object:
        """Return the value that `encode` has made *fields* of."""


class DataclassCodec:
    """A codec for a dataclass: what it is made with is written by name, and makes a new one."""

    def __init__(self, kind: type, name: str | None = None) -> None:
        """Translate values that are exactly of the type *kind*."""
        self.name = name or kind.__name__
        self._kind = kind
        self._names = tuple(field.name for field in fields(kind) if field.init)

    def handles(self, value: object) -> bool:
        """Return whether *value* is of the class itself, not of one derived from it."""
        return type(value) is self._kind

    def encode(self, value: Any) -> dict[str, object]:
        """Return the fields of *value* by name."""
        return {name: getattr(value, name) for name in self._names}

    def decode(self, fields: dict[str, Any]) -> object:
        """Return a value with these fields."""
        return self._kind(**fields)


def codec_of(value: object, codecs: Sequence[Codec]) -> Codec:
    """Return the first of *codecs* that handles *value*.

    Raises:
        TypeError: None does.
    """
    for codec in codecs:
        if codec.handles(value):
            return codec
    kind = type(value)
    raise TypeError(f"there is no codec for values of '{kind.__module__}.{kind.__qualname__}'")

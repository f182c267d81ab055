"""The wire format of protocol buffers, as far as recordings use it.

Written by hand because the bytes of numpy columns go into messages as they are, which the library
of protocol buffers cannot do; its own decoder is the oracle in the tests.
"""

from collections.abc import Callable, Iterator
from struct import Struct

__all__ = [
    "DOUBLE",
    "FIXED_32",
    "FIXED_64",
    "LENGTH",
    "VARINT",
    "WORD",
    "delimited",
    "delimiter",
    "parts",
    "tag",
    "varint",
    "varints",
]

VARINT = 0
FIXED_64 = 1
LENGTH = 2
FIXED_32 = 5

WORD = Struct("<q")
DOUBLE = Struct("<d")

_MORE = 128
"""Set in each group of seven bits but the last."""

_SMALL = tuple(bytes([number]) for number in range(_MORE))


def varint(number: int) -> bytes:
    """Return a number that is not negative in groups of seven bits, the lowest first."""
    if number < _MORE:
        return _SMALL[number]
    groups = bytearray()
    while number >= _MORE:
        groups.append(number & 127 | _MORE)
        number >>= 7
    groups.append(number)
    return bytes(groups)


def tag(number: int, wire_type: int) -> bytes:
    """Return what comes before the content of field *number*."""
    return varint(number << 3 | wire_type)


def delimited(number: int, content: bytes) -> bytes:
    """Return field *number* with a text, bytes, packed numbers or a message as its content."""
    return tag(number, LENGTH) + varint(len(content)) + content


def delimiter(number: int) -> Callable[[bytes], bytes]:
    """Return `delimited` for one field."""
    mark = tag(number, LENGTH)

    def delimit(content: bytes) -> bytes:
        return mark + varint(len(content)) + content

    return delimit


def parts(data: bytes, at: int, end: int) -> Iterator[tuple[int, int, int]]:
    """Yield each field of a message as number, begin and end of its content.

    The content of a number in groups of seven bits is the groups.

    Raises:
        ValueError: The bytes are not a message.
    """
    while at < end:
        key, at = _number(data, at)
        begin, at = _extent(data, at, key & 7)
        if at > end:
            raise ValueError("a field ends beyond its message")
        yield key >> 3, begin, at


def varints(data: bytes, at: int, end: int) -> Iterator[int]:
    """Yield the numbers in groups of seven bits that stand one after the other."""
    while at < end:
        number, at = _number(data, at)
        yield number


def _extent(data: bytes, at: int, wire_type: int) -> tuple[int, int]:
    """Return where the content begins and ends that follows a tag of this type."""
    match wire_type:
        case 1:
            return at, at + 8
        case 2:
            length, at = _number(data, at)
            return at, at + length
        case 0:
            return at, _number(data, at)[1]
        case 5:
            return at, at + 4
        case _:
            raise ValueError(f"unknown wire type {wire_type}")


def _number(data: bytes, at: int) -> tuple[int, int]:
    """Return the number that begins at *at*, and where what follows begins."""
    number = shift = 0
    try:
        while (group := data[at]) >= _MORE:
            number |= (group & 127) << shift
            shift += 7
            at += 1
    except IndexError:
        raise ValueError("a number ends beyond its message") from None
    return number | group << shift, at + 1

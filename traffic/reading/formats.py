"""Telling lines of JSON from CSV, by the name of a file or by its first character."""

from enum import Enum, auto

from traffic.reading.lines import LONGEST_LINE, ByteStream, Lines

__all__ = ["Format", "lines_and_format"]

_JSON_ENDINGS = frozenset({".json", ".jsonl", ".ndjson"})
_CSV_ENDINGS = frozenset({".csv"})


class Format(Enum):
    """How the lines of a file are written."""

    JSON = auto()
    CSV = auto()


def lines_and_format(
    stream: ByteStream, name: str, ending: str = ""
) -> tuple[Lines, Format | None]:
    """Return the lines of a stream and their format.

    If the ending of the name does not tell the format, the first character does: lines of JSON
    begin with a brace.

    Args:
        stream: What to read.
        name: How messages refer to it.
        ending: Of the name of the file, with its dot.

    Returns:
        The lines, none of which has been taken, and the format, or None if there is nothing but
        blanks.
    """
    ahead = _Ahead(stream)
    lines = Lines(ahead, name)
    if ending in _CSV_ENDINGS:
        return lines, Format.CSV
    if ending in _JSON_ENDINGS:
        return lines, Format.JSON
    first = ahead.first_sign()
    if not first:
        return lines, None
    return lines, Format.JSON if first in b"{[" else Format.CSV


class _Ahead:
    """A stream whose beginning has been looked at."""

    def __init__(self, stream: ByteStream) -> None:
        self._stream = stream
        self._seen = b""

    def first_sign(self) -> bytes:
        """Return the first byte that is no space, or none if there is none, or only far away."""
        while not (begin := self._seen.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]):
            block = self._stream.read1(1 << 12)
            if not block or len(self._seen) > LONGEST_LINE:
                return b""
            self._seen += block
        return begin

    def read1(self, size: int) -> bytes:
        """Return what has been looked at first, then what comes."""
        seen, self._seen = self._seen, b""
        return seen or self._stream.read1(size)

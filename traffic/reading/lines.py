"""The lines of a file, one by one as they come, in bounded memory."""

from collections.abc import Iterator
from typing import Protocol

from traffic.errors import LineError

__all__ = ["LONGEST_LINE", "ByteStream", "Lines"]

LONGEST_LINE = 1 << 24
"""Bytes; whoever writes more without a line break does not write states."""

_AT_A_TIME = 1 << 18
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


class ByteStream(Protocol):
    """A file that is open for reading bytes."""

    def read1(self, size: int, /) -> bytes:
        """Return what there is, at most *size* bytes; wait if there is nothing yet."""


class Lines:
    """The lines of a stream of bytes, without their ends.

    A line is handed out as soon as its end has come.

    Attributes:
        name: How messages refer to the stream.
        number: Of the line handed out last, from 1.
        line: The line handed out last.
        is_cut_off: Whether that is the last line and has no end.
    """

    def __init__(self, stream: ByteStream, name: str) -> None:
        self._stream = stream
        self.name = name
        self.number = 0
        self.line = b""
        self.is_cut_off = False

    def __iter__(self) -> Iterator[bytes]:
        """Yield the lines.

        Raises:
            LineError: A line is too long.
        """
        rest = b""
        while block := self._stream.read1(_AT_A_TIME):
            *lines, rest = (rest + block).split(b"\n")
            for line in lines:
                yield self._next(line)
            if len(rest) > LONGEST_LINE:
                self.number += 1
                raise LineError(self.place(), f"a line of at most {LONGEST_LINE} bytes", "more")
        if rest:
            self.is_cut_off = True
            yield self._next(rest)

    def place(self, column: int | None = None) -> str:
        """Return the place of the present line, as `name:line` or `name:line:column`."""
        place = f"{self.name}:{max(1, self.number)}"
        return place if column is None else f"{place}:{column}"

    def column(self, at: int) -> int:
        """Return the column, in characters from 1, of byte number *at* of the present line."""
        return len(self.line[:at].decode("utf-8", "replace")) + 1

    def text(self) -> str:
        """Return the present line as text.

        Raises:
            LineError: It is not UTF-8.
        """
        try:
            return self.line.decode()
        except UnicodeDecodeError as error:
            found = f"the byte 0x{self.line[error.start]:02x}"
            raise LineError(self.place(self.column(error.start)), "UTF-8", found) from None

    def _next(self, line: bytes) -> bytes:
        if self.number == 0:
            line = line.removeprefix(_BYTE_ORDER_MARK)
        self.number += 1
        self.line = line
        return line

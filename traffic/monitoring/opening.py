"""Opening a file of states, or standard input, in whichever format it is."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from traffic.errors import StatesError
from traffic.monitoring.csv_states import CsvStates
from traffic.monitoring.json_states import JsonStates
from traffic.monitoring.lines import LONGEST_LINE, ByteStream, Lines
from traffic.monitoring.states import StateReader

__all__ = ["open_states", "read_states"]

_JSON_ENDINGS = frozenset({".json", ".jsonl", ".ndjson"})
_CSV_ENDINGS = frozenset({".csv"})


@contextmanager
def open_states(path: Path, sorts: Mapping[str, str | None]) -> Iterator[StateReader]:
    """Open a file of states, for features with these printed terms, and sorts if known.

    Raises:
        OSError: The file cannot be read.
        StatesError: There is nothing in it.
    """
    with path.open("rb") as stream:
        yield read_states(stream, str(path), sorts, path.suffix)


def read_states(
    stream: ByteStream, name: str, sorts: Mapping[str, str | None], ending: str = ""
) -> StateReader:
    """Return a reader of states.

    If the ending of the name does not tell the format, the first character does: lines of JSON
    begin with a brace.

    Args:
        stream: What to read.
        name: How messages refer to it.
        sorts: The printed term of each feature that is needed, and its sort, if known.
        ending: Of the name of the file, with its dot.
    """
    ahead = _Ahead(stream)
    lines = Lines(ahead, name)
    if ending in _CSV_ENDINGS:
        return CsvStates(lines, sorts)
    if ending in _JSON_ENDINGS:
        return JsonStates(lines, sorts)
    first = ahead.first_sign()
    if not first:
        raise StatesError(name, "at least one state", "none")
    return JsonStates(lines, sorts) if first in b"{[" else CsvStates(lines, sorts)


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

"""Opening a file of states, or standard input, in whichever format it is."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from traffic.errors import LineError
from traffic.monitoring.csv_states import CsvStates
from traffic.monitoring.json_states import JsonStates
from traffic.monitoring.states import StateReader
from traffic.reading.formats import Format, lines_and_format
from traffic.reading.lines import ByteStream

__all__ = ["open_states", "read_states"]


@contextmanager
def open_states(path: Path, sorts: Mapping[str, str | None]) -> Iterator[StateReader]:
    """Open a file of states, for features with these printed terms, and sorts if known.

    Raises:
        OSError: The file cannot be read.
        LineError: There is nothing in it.
    """
    with path.open("rb") as stream:
        yield read_states(stream, str(path), sorts, path.suffix)


def read_states(
    stream: ByteStream, name: str, sorts: Mapping[str, str | None], ending: str = ""
) -> StateReader:
    """Return a reader of states.

    Args:
        stream: What to read.
        name: How messages refer to it.
        sorts: The printed term of each feature that is needed, and its sort, if known.
        ending: Of the name of the file, with its dot.
    """
    lines, form = lines_and_format(stream, name, ending)
    match form:
        case Format.JSON:
            return JsonStates(lines, sorts)
        case Format.CSV:
            return CsvStates(lines, sorts)
        case None:
            raise LineError(name, "at least one state", "none")

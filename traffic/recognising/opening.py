"""Opening a file of events, or standard input, in whichever format it is."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

from chronicles.events import Event
from traffic.reading.formats import Format, lines_and_format
from traffic.reading.lines import ByteStream
from traffic.recognising.csv_events import CsvEvents
from traffic.recognising.json_events import JsonEvents

__all__ = ["EventReader", "open_events", "read_events"]


class EventReader(Protocol):
    """Reads events."""

    def __iter__(self) -> Iterator[Event]:
        """Yield the events as they come, in any order of time.

        Raises:
            LineError: Something is wrong with one.
        """

    def place(self) -> str:
        """Return the place of the present event."""


@contextmanager
def open_events(path: Path) -> Iterator[EventReader]:
    """Open a file of events.

    Raises:
        OSError: The file cannot be read.
    """
    with path.open("rb") as stream:
        yield read_events(stream, str(path), path.suffix)


def read_events(stream: ByteStream, name: str, ending: str = "") -> EventReader:
    """Return a reader of events.

    Args:
        stream: What to read.
        name: How messages refer to it.
        ending: Of the name of the file, with its dot.
    """
    lines, form = lines_and_format(stream, name, ending)
    return CsvEvents(lines) if form is Format.CSV else JsonEvents(lines)

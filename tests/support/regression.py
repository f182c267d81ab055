"""Helpers for tests of regression suites."""

from pathlib import Path

from dyknow.time import SECOND, Duration
from traffic.regression.cutting import Piece, cut
from traffic.regression.regressing import update
from traffic.regression.suite import Entry


def seconds(value: float) -> Duration:
    """Return a duration of so many seconds."""
    return Duration(int(value * SECOND))


def piece(begin: float, end: float) -> Piece:
    """Return a piece from and to so many seconds."""
    return Piece(seconds(begin), seconds(end))


def entry_of(recording: Path, folder: Path, name: str = "rural", end: float = 15) -> Entry:
    """Return the beginning of a recording as an entry of the suite in *folder*."""
    entry = Entry(folder, name)
    cut(recording, piece(0, end), entry.recording)
    list(update([entry]))
    return entry

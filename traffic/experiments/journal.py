"""Finished runs, each durable the moment it is finished: a file of JSON lines.

A line is written whole and synchronised with the disk before the next run counts as done. What a
crash may leave is a last line without its end, which is cut off when the file is opened again.
"""

import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from traffic.errors import ExperimentError

__all__ = ["Journal", "read_lines"]

Line = Mapping[str, Any]

_REMEDY = "without this line, --resume does its run again"


class Journal:
    """Appends lines to a file; use it in a `with` block.

    Args:
        path: The file; made if there is none.

    Raises:
        ExperimentError: The file cannot be written, or a line of it is damaged.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._length = _whole_length(path)
        try:
            self._file = path.open("ab", buffering=0)
            self._file.truncate(self._length)
        except OSError as error:
            raise ExperimentError(f"cannot write '{path}': {error.strerror}") from error

    def append(self, line: Line) -> None:
        """Write a line; it is on the disk when this returns.

        Raises:
            ExperimentError: The disk is full, or the file cannot be written for another reason.
        """
        text = json.dumps(line, sort_keys=True, separators=(",", ":"), allow_nan=False)
        content = memoryview(f"{text}\n".encode())
        try:
            written = 0
            while written < len(content):
                written += self._file.write(content[written:])
            os.fsync(self._file.fileno())
            self._length += len(content)
        except OSError as error:
            self._file.truncate(self._length)
            fault = f"cannot write '{self._path}': {error.strerror}; the runs before are safe"
            raise ExperimentError(f"{fault}, --resume does the others") from error

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> "Journal":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def read_lines(path: Path) -> Iterator[dict[str, Any]]:
    """Yield the whole lines of a journal; a last one without its end is left out.

    Raises:
        ExperimentError: The file cannot be read, or a line is damaged.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ExperimentError(f"cannot read '{path}': {error.strerror}") from error
    lines = content.split(b"\n")[:-1]
    for number, line in enumerate(lines, start=1):
        try:
            value = json.loads(line)
        except ValueError as error:
            fault = f"expected a JSON object: {error}; {_REMEDY}"
            raise ExperimentError(f"{path}:{number}: {fault}") from error
        if not isinstance(value, dict):
            fault = f"expected a JSON object, found {value!r}; {_REMEDY}"
            raise ExperimentError(f"{path}:{number}: {fault}")
        yield value


def _whole_length(path: Path) -> int:
    """Return the length of the lines of a file that have their ends, in bytes."""
    if not path.exists():
        return 0
    for _ in read_lines(path):
        pass
    return path.read_bytes().rfind(b"\n") + 1

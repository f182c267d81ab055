"""Catches what SUMO prints, which it does behind Python's back."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["CapturedOutput"]


class CapturedOutput:
    """Sends what native code prints to a file instead of the terminal.

    Standard output stays clean for the program's own results; what SUMO complained about can be
    read when it fails.

    Args:
        path: The file, appended to.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = path.open("ab", buffering=0)

    @contextmanager
    def capture(self) -> Iterator[None]:
        """Send standard output and standard error of the process to the file for a while."""
        sys.stdout.flush()
        sys.stderr.flush()
        saved = os.dup(1), os.dup(2)
        os.dup2(self._file.fileno(), 1)
        os.dup2(self._file.fileno(), 2)
        try:
            yield
        finally:
            for descriptor, copy in zip((1, 2), saved, strict=True):
                os.dup2(copy, descriptor)
                os.close(copy)

    def lines(self, last: int = 10) -> list[str]:
        """Return the last lines that were caught, without the empty ones."""
        text = self._path.read_text(encoding="utf-8", errors="replace")
        return [line.strip() for line in text.splitlines() if line.strip()][-last:]

    def close(self) -> None:
        """Close the file."""
        self._file.close()

"""Lines of comma-separated values: their cells, and where these are.

A cell with a comma or a quote stands between double quotes, and ends on the line on which it
begins.
"""

import csv
import re
from collections.abc import Iterator, Sequence

from traffic.errors import LineError
from traffic.reading.lines import Lines

__all__ = ["CsvRows"]

_CELL = re.compile(r'"(?:[^"]|"")*"[^,]*|[^,]*')


class CsvRows:
    """The lines of a table, each as its cells; empty lines are passed over."""

    def __init__(self, lines: Lines) -> None:
        self._lines = lines

    def __iter__(self) -> Iterator[list[str]]:
        """Yield the cells of each line that is not empty.

        Raises:
            LineError: A line is not UTF-8, or its quotes are wrong.
        """
        for line in self._lines:
            try:
                text = line.decode()
            except UnicodeDecodeError:
                text = self._lines.text()
            text = text.removesuffix("\r")
            if '"' in text:
                yield self._quoted(text)
            elif text.strip():
                yield text.split(",")

    def place_of(self, at: int) -> str:
        """Return the place of cell number *at* of the present line."""
        text = self._lines.text().removesuffix("\r")
        begin = 0
        for _ in range(at):
            cell = _CELL.match(text, begin)
            begin = min(len(text), cell.end() + 1 if cell else len(text))
        return self._lines.place(begin + 1)

    def forbid_repetition(self, header: Sequence[str]) -> None:
        """Raise a `LineError` if two columns have one name."""
        seen: dict[str, int] = {}
        for at, name in enumerate(map(str.strip, header)):
            if name in seen:
                expected = f"one column '{name}'"
                raise LineError(self.place_of(at), expected, f"another at column {seen[name]}")
            seen[name] = at + 1

    def refuse_length(self, cells: Sequence[str], width: int) -> None:
        """Say that a line has too few cells, or too many."""
        place = self.place_of(min(len(cells), width))
        expected, found = f"{width} cells as in the first line", f"{len(cells)}"
        if self._lines.is_cut_off and len(cells) < width:
            expected, found = f"{width} cells", f"{len(cells)} and the end of the file"
        raise LineError(place, expected, found)

    def _quoted(self, text: str) -> list[str]:
        try:
            return next(csv.reader([text], strict=True))
        except (csv.Error, StopIteration) as error:
            column = text.index('"') + 1
            expected = "quoted cells that end on their line"
            raise LineError(self._lines.place(column), expected, str(error)) from None

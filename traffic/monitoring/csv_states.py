"""States as comma-separated values: a column `t`, in milliseconds, and one for each feature.

There are no sorts in the format, so a cell is read as what the formula needs: a boolean (`true`
and `false` in any case, or 1 and 0), a finite number, or a text. A feature that is only compared
with other features is a number where it looks like one and a text elsewhere. Columns that the
formula does not need are not looked at. A cell with a comma or a quote stands between double
quotes, and ends on the line on which it begins.
"""

import csv
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any

from dyknow.mtl.check import BOOLEAN, NUMBER, TEXT
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import StatesError
from traffic.monitoring.lines import Lines
from traffic.monitoring.states import (
    BEFORE_ALL,
    LATEST,
    check_order,
    match_features,
    missing_feature,
    printed_feature,
    time_from,
)

__all__ = ["CsvStates"]

_TIME = "t"
_CELL = re.compile(r'"(?:[^"]|"")*"[^,]*|[^,]*')
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_NO_NUMBER = frozenset({"nan", "inf", "infinity"})

Read = Callable[[str], Any]


class CsvStates:
    """Reads states from a table in CSV; the first line names the columns."""

    def __init__(self, lines: Lines, sorts: Mapping[str, str | None]) -> None:
        """Read from *lines* the features with these printed terms, and of these sorts if known."""
        self._lines = lines
        self._sorts = sorts
        self._names: Sequence[str] = ()
        self._columns: dict[str, int] = {}

    @property
    def name(self) -> str:
        """How messages refer to what is read."""
        return self._lines.name

    def __iter__(self) -> Iterator[tuple[TimePoint, Mapping[str, Any]]]:
        """Yield time and features of each state.

        Raises:
            StatesError: There is no state, or something is wrong with one.
        """
        rows = self._rows()
        for header in rows:
            self._read_header(header)
            break
        at_time, width = self._columns.pop(_TIME, 0), len(self._names)
        readers = [(term, at, _READ[self._sorts[term]]) for term, at in self._columns.items()]
        last = BEFORE_ALL
        for cells in rows:
            if len(cells) != width:
                self._refuse_length(cells)
            now = self._time(cells[at_time], at_time)
            if now <= last:
                check_order(last, now, self._place_of(at_time))
            try:
                values = {term: read(cells[at]) for term, at, read in readers}
            except ValueError:
                self._refuse_value(cells)
                raise
            last = now
            yield TimePoint(now), values
        if last == BEFORE_ALL:
            raise StatesError(self.name, "at least one state", "none")

    def place(self, term: str | None = None) -> str:
        """Return the place of the present state, or of the cell of a feature in it."""
        at = None if term is None else self._columns.get(term)
        return self._lines.place() if at is None else self._place_of(at)

    def terms(self) -> Collection[str]:
        """Return the features that there are columns of, as they are printed."""
        return list(map(printed_feature, self._names))

    def _rows(self) -> Iterator[list[str]]:
        """Yield the cells of each line that is not empty."""
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

    def _quoted(self, text: str) -> list[str]:
        try:
            return next(csv.reader([text], strict=True))
        except (csv.Error, StopIteration) as error:
            column = text.index('"') + 1
            expected = "quoted cells that end on their line"
            raise StatesError(self._lines.place(column), expected, str(error)) from None

    def _read_header(self, header: Sequence[str]) -> None:
        self._names = header
        found, twice = match_features({*self._sorts, _TIME}, header)
        seen: dict[str, int] = {}
        for at, name in enumerate(map(str.strip, header)):
            if name in seen:
                expected = f"one column '{name}'"
                raise StatesError(self._place_of(at), expected, f"another at column {seen[name]}")
            seen[name] = at + 1
        for term, (_, other) in twice.items():
            place = self._place_of(header.index(other))
            raise StatesError(place, f"'{term}' once", f"'{other}' as well")
        if _TIME not in found:
            missing = missing_feature(_TIME, header)
            raise StatesError(self._lines.place(1), f"a column '{_TIME}' with the time", missing)
        self._columns = {term: header.index(name) for term, name in found.items()}

    def _time(self, cell: str, at: int) -> int:
        if cell.isdigit() and cell.isascii():
            now = int(cell) * MILLISECOND
            if now <= LATEST:
                return now
        return time_from(cell.strip(), lambda: self._place_of(at))

    def _refuse_length(self, cells: Sequence[str]) -> None:
        """Say that a line has too few cells, or too many."""
        place = self._place_of(min(len(cells), len(self._names)))
        expected, found = f"{len(self._names)} cells as in the first line", f"{len(cells)}"
        if self._lines.is_cut_off and len(cells) < len(self._names):
            expected, found = f"{len(self._names)} cells", f"{len(cells)} and the end of the file"
        raise StatesError(place, expected, found)

    def _refuse_value(self, cells: Sequence[str]) -> None:
        """Say which cell cannot be read."""
        for term, at in self._columns.items():
            sort = self._sorts[term]
            try:
                _READ[sort](cells[at])
            except ValueError:
                found = repr(cells[at]) if cells[at].strip() else "an empty cell"
                expected = f"a value of '{term}'" if sort is None else f"a {sort} ('{term}')"
                raise StatesError(self._place_of(at), expected, found) from None

    def _place_of(self, at: int) -> str:
        """Return the place of cell number *at* of the present line."""
        text = self._lines.text().removesuffix("\r")
        begin = 0
        for _ in range(at):
            cell = _CELL.match(text, begin)
            begin = min(len(text), cell.end() + 1 if cell else len(text))
        return self._lines.place(begin + 1)


def _boolean(cell: str) -> bool:
    value = _BOOLEANS.get(cell)
    if value is None:
        value = _BOOLEANS.get(cell.strip().lower())
    if value is None:
        raise ValueError(cell)
    return value


def _number(cell: str) -> float:
    value = float(cell)
    if not -_HUGE <= value <= _HUGE or "_" in cell:
        raise ValueError(cell)
    return value


def _text(cell: str) -> str:
    text = cell.strip()
    if not text:
        raise ValueError(cell)
    return text


def _number_or_text(cell: str) -> float | str:
    text = _text(cell)
    if text.lstrip("+-").lower() in _NO_NUMBER:
        raise ValueError(cell)
    return _number(cell) if _NUMBER.fullmatch(text) else text


_BOOLEANS = {"true": True, "false": False, "True": True, "False": False, "1": True, "0": False}
_HUGE = 1.7976931348623157e308
_READ: dict[str | None, Read] = {
    BOOLEAN: _boolean,
    NUMBER: _number,
    TEXT: _text,
    None: _number_or_text,
}

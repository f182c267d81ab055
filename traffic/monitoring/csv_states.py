"""States as comma-separated values: a column `t`, in milliseconds, and one for each feature.

There are no sorts in the format, so a cell is read as what the formula needs: a boolean (`true`
and `false` in any case, or 1 and 0), a finite number, or a text. A feature that is only compared
with other features is a number where it looks like one and a text elsewhere. Columns that the
formula does not need are not looked at. A cell with a comma or a quote stands between double
quotes, and ends on the line on which it begins.
"""

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any

from dyknow.mtl.check import BOOLEAN, NUMBER, TEXT
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import LineError
from traffic.monitoring.states import (
    check_order,
    match_features,
    missing_feature,
    printed_feature,
)
from traffic.reading.csv_lines import CsvRows
from traffic.reading.lines import Lines
from traffic.reading.times import BEFORE_ALL, LATEST, time_from

__all__ = ["CsvStates"]

_TIME = "t"
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_NO_NUMBER = frozenset({"nan", "inf", "infinity"})

Read = Callable[[str], Any]


class CsvStates:
    """Reads states from a table in CSV; the first line names the columns."""

    def __init__(self, lines: Lines, sorts: Mapping[str, str | None]) -> None:
        """Read from *lines* the features with these printed terms, and of these sorts if known."""
        self._lines = lines
        self._table = CsvRows(lines)
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
            LineError: There is no state, or something is wrong with one.
        """
        rows = iter(self._table)
        for header in rows:
            self._read_header(header)
            break
        at_time, width = self._columns.pop(_TIME, 0), len(self._names)
        readers = [(term, at, _READ[self._sorts[term]]) for term, at in self._columns.items()]
        last = BEFORE_ALL
        for cells in rows:
            if len(cells) != width:
                self._table.refuse_length(cells, width)
            now = self._time(cells[at_time], at_time)
            if now <= last:
                check_order(last, now, self._table.place_of(at_time))
            try:
                values = {term: read(cells[at]) for term, at, read in readers}
            except ValueError:
                self._refuse_value(cells)
                raise
            last = now
            yield TimePoint(now), values
        if last == BEFORE_ALL:
            raise LineError(self.name, "at least one state", "none")

    def place(self, term: str | None = None) -> str:
        """Return the place of the present state, or of the cell of a feature in it."""
        at = None if term is None else self._columns.get(term)
        return self._lines.place() if at is None else self._table.place_of(at)

    def terms(self) -> Collection[str]:
        """Return the features that there are columns of, as they are printed."""
        return list(map(printed_feature, self._names))

    def _read_header(self, header: Sequence[str]) -> None:
        self._names = header
        found, twice = match_features({*self._sorts, _TIME}, header)
        self._table.forbid_repetition(header)
        for term, (_, other) in twice.items():
            place = self._table.place_of(header.index(other))
            raise LineError(place, f"'{term}' once", f"'{other}' as well")
        if _TIME not in found:
            missing = missing_feature(_TIME, header)
            raise LineError(self._lines.place(1), f"a column '{_TIME}' with the time", missing)
        self._columns = {term: header.index(name) for term, name in found.items()}

    def _time(self, cell: str, at: int) -> int:
        if cell.isdigit() and cell.isascii():
            now = int(cell) * MILLISECOND
            if now <= LATEST:
                return now
        return time_from(cell.strip(), lambda: self._table.place_of(at))

    def _refuse_value(self, cells: Sequence[str]) -> None:
        """Say which cell cannot be read."""
        for term, at in self._columns.items():
            sort = self._sorts[term]
            try:
                _READ[sort](cells[at])
            except ValueError:
                found = repr(cells[at]) if cells[at].strip() else "an empty cell"
                expected = f"a value of '{term}'" if sort is None else f"a {sort} ('{term}')"
                raise LineError(self._table.place_of(at), expected, found) from None


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

"""Events as comma-separated values.

The columns are `t`, `attribute` or `message` (or both, one of which is empty on each line),
`arguments`, `from` and `to`; others are not looked at. Arguments are parted by blanks, commas or
semicolons, or are an array of JSON. An empty cell under `from` says that the value was unknown.
"""

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache

from pydantic_core import from_json

from chronicles.events import Event
from dyknow.source_text import nearest_name
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import LineError
from traffic.reading.csv_lines import CsvRows
from traffic.reading.lines import Lines
from traffic.reading.times import LATEST, time_from

__all__ = ["CsvEvents"]

_COLUMNS = ("t", "attribute", "message", "arguments", "from", "to")
_BETWEEN = re.compile(r"[\s,;]+")
_KEPT = 1 << 16


class CsvEvents:
    """Reads events from a table in CSV; the first line names the columns."""

    def __init__(self, lines: Lines) -> None:
        self._lines = lines
        self._table = CsvRows(lines)
        self._at: dict[str, int] = {}

    def __iter__(self) -> Iterator[Event]:
        """Yield the events.

        Raises:
            LineError: Something is wrong with one, or a column is missing.
        """
        rows = iter(self._table)
        width = 0
        for header in rows:
            self._read_header(header)
            width = len(header)
            break
        at = self._at
        for cells in rows:
            if len(cells) != width:
                self._table.refuse_length(cells, width)
            texts = {name: cells[i].strip() for name, i in at.items()}
            yield self._event(texts)

    def place(self) -> str:
        """Return the place of the present event."""
        return self._lines.place()

    def _read_header(self, header: Sequence[str]) -> None:
        self._table.forbid_repetition(header)
        names = list(map(str.strip, header))
        self._at = {name: names.index(name) for name in _COLUMNS if name in names}
        needed = ["t"]
        if "message" not in names:
            needed += ["attribute"]
        if "attribute" in names:
            needed += ["to"]
        for name in needed:
            if name not in names:
                nearest = nearest_name(name, names)
                found = f"none; did you mean '{nearest}'?" if nearest else "none"
                wanted = "'attribute' or 'message'" if name == "attribute" else f"'{name}'"
                raise LineError(self._lines.place(1), f"a column {wanted}", found)

    def _event(self, texts: dict[str, str]) -> Event:
        name, message = texts.get("attribute", ""), texts.get("message", "")
        if bool(name) == bool(message):
            found = "both" if name else "neither"
            raise LineError(self._lines.place(), "either an attribute or a message", found)
        before, after = texts.get("from") or None, texts.get("to") or None
        if message and (before or after):
            place = self._place_of("from" if before else "to")
            raise LineError(place, "no values of a message", repr(before or after))
        if name and before is None and after is None:
            raise LineError(self._place_of("to"), "the value after the change", "an empty cell")
        return Event(
            name or message, self._arguments(texts), before, after, self._time(texts["t"])
        )

    def _time(self, cell: str) -> TimePoint:
        if cell.isdigit() and cell.isascii():
            time = int(cell) * MILLISECOND
            if time <= LATEST:
                return TimePoint(time)
        return TimePoint(time_from(cell, lambda: self._place_of("t")))

    def _arguments(self, texts: dict[str, str]) -> tuple[str, ...]:
        cell = texts.get("arguments", "")
        try:
            return _arguments_from(cell)
        except ValueError:
            expected = "arguments parted by blanks, or an array of texts"
            raise LineError(self._place_of("arguments"), expected, repr(cell)) from None

    def _place_of(self, name: str) -> str:
        return self._table.place_of(self._at[name])


@lru_cache(maxsize=_KEPT)
def _arguments_from(cell: str) -> tuple[str, ...]:
    """Return the arguments in a cell.

    Raises:
        ValueError: It is a faulty array, or has something else than texts.
    """
    if not cell:
        return ()
    if cell.startswith("["):
        found = from_json(cell, allow_inf_nan=False)
        if not all(isinstance(argument, str) for argument in found):
            raise ValueError(cell)
        return tuple(found)
    found = _BETWEEN.split(cell)
    if "" in found:
        raise ValueError(cell)
    return tuple(found)

"""Tables of results in files: `cells.csv` of an experiment, and such that were made elsewhere.

A file has a header and a row for each cell:

    # Who found it out, and how: lines in front of the header describe the table.
    sample_period,position_noise,runs,overtake.detection
    100,0,10,1.0
    100,2,10,60 %

A column is a measure (KIND.WHAT), with `.successes`, `.trials`, `.low` or `.high` behind it a part
of one; `runs` and `failed` are how many runs were done and how many of them failed; any other is a
setting that varies. Of a measure either successes and trials are told, or its share. A share of
which no trials are told is one of all runs that did not fail. Intervals follow from the counts,
and are not read.
"""

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from dyknow.source_text import nearest_name
from traffic.bundled import data_folder
from traffic.errors import ExperimentError
from traffic.experiments.designs import Level
from traffic.experiments.levels import key_of
from traffic.experiments.measures import MEASURES, Share
from traffic.experiments.tables import CellMeasures

__all__ = ["CellFile", "bundled_cell_files", "find_cell_file", "read_cell_file"]

_MEASURE = re.compile(rf"[a-z][a-z0-9_]*\.(?P<what>{'|'.join(MEASURES)})")
_PARTS = ("successes", "trials", "low", "high")
_OF_RUNS = ("detection", "false_alarms", "faultless")
_INTEGER = re.compile(r"[+-]?\d{1,15}")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?")
_MOST_FAULTS = 20
_MOST_RUNS = 10**12


@dataclass(frozen=True, slots=True)
class CellFile:
    """A table of results.

    Attributes:
        path: Of the file.
        description: What stands in front of its header.
        varying: Names of the settings that vary.
        measures: What was measured, in the order of the columns.
        cells: A row each.
    """

    path: Path
    description: str
    varying: tuple[str, ...]
    measures: tuple[str, ...]
    cells: tuple[CellMeasures, ...]


def bundled_cell_files() -> dict[str, Path]:
    """Return the tables that come with the program, by name."""
    return {path.stem: path for path in sorted((data_folder() / "designs").glob("*.csv"))}


def find_cell_file(path: Path) -> Path | None:
    """Return *path* if it is that of a table, or the bundled table of that name, if any."""
    if path.suffix == ".csv":
        return path
    return None if path.exists() else bundled_cell_files().get(str(path))


def read_cell_file(path: Path) -> CellFile:
    """Read a table of results.

    Raises:
        ExperimentError: It cannot be read, or has faults; all of them are named, with line,
            column, what was expected and what was found.
    """
    text = _text_of(path)
    lines = text.splitlines(keepends=True)
    n_remarks = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    description = " ".join(line.strip("# \t\r\n") for line in lines[:n_remarks])
    try:
        rows = list(_rows("".join(lines[n_remarks:]), n_remarks))
    except csv.Error as error:
        raise ExperimentError(f"{path}: expected a table as CSV: {error}") from error
    return _Reader(path).read(description, rows)


@dataclass(frozen=True, slots=True)
class _Row:
    line: int
    values: list[str]


def _text_of(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ExperimentError(f"cannot read '{path}': {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ExperimentError(f"'{path}' is not a text in UTF-8") from error


def _rows(text: str, before: int) -> Iterator[_Row]:
    """Yield the rows that are not empty, each with the line that it begins in."""
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    line = before + 1
    for values in reader:
        if any(value.strip() for value in values):
            yield _Row(line, [value.strip() for value in values])
        line = before + reader.line_num + 1


class _Reader:
    """Makes a table of rows, and collects what is wrong with them."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._faults: list[str] = []

    def read(self, description: str, rows: Sequence[_Row]) -> CellFile:
        header = rows[0] if rows else _Row(1, [])
        varying, measures = self._columns(header)
        self._stop_at_faults()
        cells = [self._cell(header, row, varying, measures) for row in rows[1:]]
        if not cells:
            self._fault(header.line, None, "a row for each cell below the header", "none")
        self._check_once(rows[1:], cells)
        self._stop_at_faults()
        return CellFile(self._path, description, varying, measures, tuple(cells))

    def _fault(self, line: int, column: str | None, expected: str, found: str) -> None:
        where = "" if column is None else f" column '{column}':"
        self._faults.append(f"{self._path}:{line}:{where} expected {expected}, found {found}")

    def _stop_at_faults(self) -> None:
        if not self._faults:
            return
        more = len(self._faults) - _MOST_FAULTS
        rest = [f"and {more} more"] if more > 0 else []
        raise ExperimentError(*self._faults[:_MOST_FAULTS], *rest)

    def _columns(self, header: _Row) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the settings that vary, and the measures."""
        columns = header.values
        measures = tuple(dict.fromkeys(m for c in columns if (m := _measure_of(c)) is not None))
        for number, name in enumerate(columns, start=1):
            if not name:
                self._fault(header.line, None, f"a name for column {number}", "none")
            elif name in columns[: number - 1]:
                self._fault(header.line, name, "each column once", "it again")
        if not measures:
            self._no_measure(header)
        if "runs" not in columns and not all(f"{m}.trials" in columns for m in measures):
            self._fault(header.line, None, "the column 'runs'", ", ".join(columns) or "nothing")
        for measure in measures:
            self._check_trials(header, measure)
        known = {"runs", "failed"}
        varying = tuple(c for c in columns if c not in known and _measure_of(c) is None)
        return varying, measures

    def _no_measure(self, header: _Row) -> None:
        for column in header.values:
            kind, _, what = column.rpartition(".")
            nearest = nearest_name(what, MEASURES) if kind else None
            if nearest is not None:
                hint = f"'{column}'; did you mean '{kind}.{nearest}'?"
                self._fault(header.line, column, "a measure", hint)
                return
        found = ", ".join(header.values) or "nothing"
        self._fault(header.line, None, "a measure such as 'overtake.detection'", found)

    def _check_trials(self, header: _Row, measure: str) -> None:
        columns = header.values
        if measure not in columns and f"{measure}.successes" not in columns:
            expected = f"'{measure}' or '{measure}.successes' as well"
            self._fault(header.line, measure, expected, "a part of it only")
        if f"{measure}.trials" not in columns and measure.rpartition(".")[2] not in _OF_RUNS:
            expected = f"the column '{measure}.trials', because it is not a share of runs"
            self._fault(header.line, measure, expected, "no such column")

    def _cell(
        self, header: _Row, row: _Row, varying: Sequence[str], measures: Sequence[str]
    ) -> CellMeasures:
        none = CellMeasures({}, 0, 0, {})
        if len(row.values) != len(header.values):
            self._fault(row.line, None, f"{len(header.values)} values", str(len(row.values)))
            return none
        values = dict(zip(header.values, row.values, strict=True))
        cell = {name: self._level(row.line, name, values[name]) for name in varying}
        failed = self._count(row.line, values, "failed", _MOST_RUNS) or 0
        runs = self._count(row.line, values, "runs", _MOST_RUNS)
        if runs is not None and failed > runs:
            self._fault(row.line, "failed", f"at most {runs} runs", str(failed))
            return none
        went_well = None if runs is None else runs - failed
        shares = {m: self._share(row.line, values, m, went_well) for m in measures}
        trials = max((share.trials for share in shares.values()), default=0)
        return CellMeasures(cell, trials + failed if runs is None else runs, failed, shares)

    def _level(self, line: int, column: str, text: str) -> Level:
        if not text:
            self._fault(line, column, "a level", "nothing")
        return _level_of(text)

    def _share(
        self, line: int, values: Mapping[str, str], measure: str, runs: int | None
    ) -> Share:
        most = _MOST_RUNS if runs is None or not measure.endswith(_OF_RUNS) else runs
        trials = self._count(line, values, f"{measure}.trials", most)
        text = values.get(measure, "")
        told = self._count(line, values, f"{measure}.successes", trials)
        if trials is None:
            trials = runs if text or told is not None else 0
        if trials is None or (told is not None and told > trials):
            found = "nothing" if trials is None else f"{told} successes"
            self._fault(line, measure, f"at most {trials or 0} successes", found)
            return Share(0, 0)
        counted = self._successes(line, measure, text, trials)
        return Share(told if told is not None else counted or 0, trials)

    def _successes(self, line: int, measure: str, text: str, trials: int) -> int | None:
        """Return how many trials a share is; None if there is none."""
        if not text:
            return None
        number = text.removesuffix("%").rstrip()
        unit = 100 if text.endswith("%") else 1
        share = float(number) / unit if _NUMBER.fullmatch(number) else math.nan
        if not 0 <= share <= 1:
            expected = "a share from 0 to 1, or a percentage such as '60 %'"
            self._fault(line, measure, expected, f"'{text}'")
            return None
        successes = round(share * trials)
        if abs(share * trials - successes) > _rounding(number, unit) * trials + 1e-9:
            nearest = successes / trials if trials else 0.0
            expected = f"a share of {trials} trials, such as {nearest:g}"
            self._fault(line, measure, expected, f"'{text}'")
        return successes

    def _count(
        self, line: int, values: Mapping[str, str], column: str, most: int | None
    ) -> int | None:
        """Return the count in a column; None if the column is not there, or empty."""
        text = values.get(column, "")
        if not text:
            return None
        found = float(text) if _NUMBER.fullmatch(text) else math.nan
        limit = _MOST_RUNS if most is None else most
        if not 0 <= found <= limit or found != int(found):
            upper = f", at most {limit}" if limit < _MOST_RUNS else ""
            self._fault(line, column, f"a count{upper}", f"'{text}'")
            return None
        return int(found)

    def _check_once(self, rows: Sequence[_Row], cells: Sequence[CellMeasures]) -> None:
        """Complain of cells that are there twice and do not say the same."""
        first: dict[tuple[object, ...], tuple[int, CellMeasures]] = {}
        for row, cell in zip(rows, cells, strict=True):
            key = tuple(key_of(level) for level in cell.cell.values())
            line, found = first.setdefault(key, (row.line, cell))
            if (found.runs, found.shares) != (cell.runs, cell.shares):
                self._fault(row.line, None, "each cell once", f"that of line {line} again")


def _measure_of(column: str) -> str | None:
    """Return the measure that a column tells something of, if any."""
    head, _, part = column.rpartition(".")
    measure = head if part in _PARTS else column
    return measure if _MEASURE.fullmatch(measure) else None


def _level_of(text: str) -> Level:
    if text in ("True", "False", "true", "false"):
        return text in ("True", "true")
    if _INTEGER.fullmatch(text):
        return int(text)
    if _NUMBER.fullmatch(text) and math.isfinite(float(text)):
        return float(text)
    return text


def _rounding(number: str, unit: int) -> float:
    """Return how far a share may be from what was meant, given the digits that it is told by."""
    digits, _, exponent = number.lower().partition("e")
    decimals = len(digits.partition(".")[2]) - int(exponent or 0)
    return float(0.5 * 10.0**-decimals / unit)

"""Tables of an experiment: all runs, and the measures of all cells."""

import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from traffic.experiments.cases import Case, Outcome, cases_of
from traffic.experiments.designs import Cell, Design
from traffic.experiments.measures import Counts, Share, kind_of, share

__all__ = ["CellMeasures", "cell_table", "measure_cells", "parquet_from_runs", "run_table"]


@dataclass(frozen=True, slots=True)
class CellMeasures:
    """What was found out about the runs of a cell.

    Attributes:
        cell: Its levels.
        runs: How many runs were finished.
        failed: How many failed; no measure counts them.
        shares: By measure.
    """

    cell: Cell
    runs: int
    failed: int
    shares: Mapping[str, Share]


def run_table(design: Design, outcomes: Mapping[str, Outcome]) -> pd.DataFrame:
    """Return a row for each finished run, cell by cell, in order of seed.

    Columns: the settings that vary, `seed`, `error` (None if the run went well), and for each
    kind of manoeuvre KIND`.truth`, KIND`.recognised` and KIND`.correct`. Nothing in it depends on
    who did the runs, or when.
    """
    done = [(case, outcomes[case.key]) for case in cases_of(design) if case.key in outcomes]
    kinds = sorted({kind for _, outcome in done for kind in outcome.counts})
    rows = [_row(design, case, outcome, kinds) for case, outcome in done]
    columns = [*design.varying, "seed", "error", *_count_columns(kinds)]
    table = pd.DataFrame(rows, columns=columns)
    return table.astype(dict.fromkeys(_count_columns(kinds), "Int64"))


def parquet_from_runs(table: pd.DataFrame) -> bytes:
    """Return a table of runs as a Parquet file: equal bytes for equal tables."""
    columns = {str(name): _column(table[name]) for name in table.columns}
    buffer = io.BytesIO()
    pq.write_table(pa.table(columns), buffer, compression="zstd")
    return buffer.getvalue()


def measure_cells(design: Design, outcomes: Mapping[str, Outcome]) -> list[CellMeasures]:
    """Return what was found out about each cell, in the order of the design."""
    by_cell: dict[int, list[Outcome]] = {}
    for case in cases_of(design):
        found = by_cell.setdefault(case.cell, [])
        if case.key in outcomes:
            found.append(outcomes[case.key])
    cells = list(design.combinations())
    return [_measured(design, cells[number], found) for number, found in by_cell.items()]


def cell_table(measures: Sequence[str], cells: Sequence[CellMeasures]) -> pd.DataFrame:
    """Return a row for each cell.

    Columns: the settings that vary, `runs`, `failed`, and for each measure its value; with
    `.low` and `.high` behind its name, between which the truth lies with a confidence of 95 %;
    with `.successes` and `.trials`, of what it is the share.
    """
    return pd.DataFrame([_cell_row(cell, measures) for cell in cells])


def _measured(design: Design, cell: Cell, outcomes: Iterable[Outcome]) -> CellMeasures:
    runs = list(outcomes)
    well = [run for run in runs if run.error is None]
    none = Counts(0, 0, 0)
    shares = {
        measure: share(measure, [run.counts.get(kind_of(measure), none) for run in well])
        for measure in design.measures
    }
    return CellMeasures(cell, len(runs), len(runs) - len(well), shares)


def _cell_row(cell: CellMeasures, measures: Iterable[str]) -> dict[str, Any]:
    row: dict[str, Any] = {**cell.cell, "runs": cell.runs, "failed": cell.failed}
    for measure in measures:
        found = cell.shares[measure]
        row[measure] = found.value
        row[f"{measure}.low"], row[f"{measure}.high"] = found.interval
        row[f"{measure}.successes"], row[f"{measure}.trials"] = found
    return row


def _row(design: Design, case: Case, outcome: Outcome, kinds: Iterable[str]) -> list[Any]:
    settings = {"scenario": case.scenario, **case.settings}
    levels = [settings[name] for name in design.varying]
    counts = [outcome.counts.get(kind, (None, None, None)) for kind in kinds]
    return [*levels, case.seed, outcome.error, *(n for triple in counts for n in triple)]


def _count_columns(kinds: Iterable[str]) -> list[str]:
    return [f"{kind}.{what}" for kind in kinds for what in Counts._fields]


def _column(values: "pd.Series[Any]") -> Any:
    """Return a column as Arrow has it; one of several types becomes text."""
    try:
        return pa.array(values, from_pandas=True)
    except (pa.ArrowInvalid, pa.ArrowTypeError):
        return pa.array([None if pd.isna(v) else str(v) for v in values], type=pa.string())

"""Experiments as documents and tables for other programs."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from pydantic_core import to_json

from traffic.experiments.beside import Beside, Row, remarks_about
from traffic.experiments.findings import Findings
from traffic.experiments.measures import Share
from traffic.experiments.running import Experiment
from traffic.experiments.tables import CellMeasures

__all__ = ["beside_table", "json_from_beside", "json_from_experiment", "json_from_findings"]


def json_from_experiment(experiment: Experiment) -> str:
    """Return an experiment as one JSON document."""
    design = experiment.design
    document = {
        "design": design.name,
        "description": design.description,
        "fixed": design.fixed,
        "runs_per_cell": design.runs_per_cell,
        "versions": experiment.versions,
        "cells": [_json_from_cell(cell) for cell in experiment.cells],
        "errors": experiment.errors,
    }
    return to_json(document, indent=1).decode()


def json_from_findings(findings: Findings) -> str:
    """Return what is known of an experiment, or of a table that stands for one, as JSON."""
    if findings.experiment is not None:
        return json_from_experiment(findings.experiment)
    cells = [_json_from_cell(cell) for cell in findings.cells]
    document = {"table": findings.name, "description": findings.description, "cells": cells}
    return to_json(document, indent=1).decode()


def json_from_beside(beside: Beside) -> str:
    """Return experiments side by side as one JSON document."""
    document = {
        "experiments": [
            {"name": side.name, "description": side.description, "fixed": side.fixed, "held": held}
            for side, held in zip(beside.sides, beside.held, strict=True)
        ],
        "factors": beside.factors,
        "measures": beside.measures,
        "remarks": remarks_about(beside),
        "cells": [
            {"cell": row.cell, "experiments": _json_from_row(beside, row)} for row in beside.rows
        ],
    }
    return to_json(document, indent=1).decode()


def beside_table(beside: Beside) -> pd.DataFrame:
    """Return a row for each cell, with columns for each experiment, EXPERIMENT`:`MEASURE.

    As in the table of a single one, there are columns with `.low`, `.high`, `.successes` and
    `.trials` behind; all of an experiment are empty where it has no such cell.
    """
    table = pd.DataFrame([_row_of_table(beside, row) for row in beside.rows])
    counts = [name for name in table.columns if name.endswith((".successes", ".trials"))]
    return table.astype(dict.fromkeys(counts, "Int64"))


def _row_of_table(beside: Beside, row: Row) -> dict[str, Any]:
    columns: dict[str, Any] = dict(row.cell)
    for side, found in zip(beside.sides, row.found, strict=True):
        for measure in beside.measures:
            name = f"{side.name}:{measure}"
            share = None if found is None else found.shares[measure]
            columns[name] = None if share is None else share.value
            for part in ("low", "high"):
                columns[f"{name}.{part}"] = share and getattr(share.interval, part)
            for part in ("successes", "trials"):
                columns[f"{name}.{part}"] = share and getattr(share, part)
    return columns


def _json_from_row(beside: Beside, row: Row) -> dict[str, Any]:
    return {
        side.name: None
        if found is None
        else {measure: _json_from_share(found.shares[measure]) for measure in beside.measures}
        for side, found in zip(beside.sides, row.found, strict=True)
    }


def _json_from_cell(cell: CellMeasures) -> Mapping[str, Any]:
    return {
        "cell": dict(cell.cell),
        "runs": cell.runs,
        "failed": cell.failed,
        "measures": {name: _json_from_share(each) for name, each in cell.shares.items()},
    }


def _json_from_share(share: Share) -> dict[str, float | int | None]:
    low, high = share.interval
    counts = share._asdict()
    return {**counts, "value": share.value, "low": low, "high": high}

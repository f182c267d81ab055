"""The page of experiments: their measures as heat maps, curves and tables, by any factors.

Of several experiments the same cells are shown next to each other, in one scale of colours, and a
curve of each in one diagram.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from traffic.experiments.beside import Beside, put_beside, remarks_about
from traffic.experiments.designs import Level
from traffic.experiments.findings import Findings
from traffic.experiments.levels import amount_of, in_order, key_of, unit_of
from traffic.experiments.measures import MEANINGS, is_less_better
from traffic.experiments.repeating import CellRuns, runs_of_cells
from traffic.experiments.tables import CellMeasures
from traffic.reporting.pages import embedded, render

__all__ = ["page_of_experiments"]

_MOST_SEEDS = 12
"""So many runs of a cell are named for each measure."""

_Fact = tuple[str, str]


def page_of_experiments(sides: Sequence[Findings]) -> str:
    """Return the page of one experiment, or of several side by side: one HTML document."""
    beside = put_beside(sides)
    one = sides[0] if len(sides) == 1 else None
    return render(
        "experiment.html",
        {
            "title": one.name if one else " · ".join(side.name for side in sides),
            "description": one.description if one else "",
            "facts": list(_facts(one)) if one else [],
            "sides": [] if one else [(side, list(_facts(side))) for side in sides],
            "remarks": remarks_about(beside),
            "errors": [(side.name, e) for side in sides if (e := _errors(side))],
            "made": [(side.name, m) for side in sides if (m := _made(side))],
            "data": embedded(_data(beside)),
        },
    )


def _facts(side: Findings) -> Iterator[_Fact]:
    runs = {cell.runs for cell in side.cells}
    yield "runs", f"{sum(cell.runs for cell in side.cells):,}"
    yield "cells", f"{len(side.cells):,}"
    yield "runs in each", f"{min(runs):,}" + (f"–{max(runs):,}" if len(runs) > 1 else "")
    if side.experiment is not None:
        yield "failed", f"{sum(cell.failed for cell in side.cells):,}"


def _errors(side: Findings) -> list[str]:
    return [] if side.experiment is None else side.experiment.errors


def _made(side: Findings) -> dict[str, Mapping[str, object]]:
    """Return settings and versions that the runs of an experiment have in common."""
    if side.experiment is None:
        return {}
    return {"settings of every run": side.fixed, "versions": side.experiment.versions}


def _data(beside: Beside) -> dict[str, Any]:
    factors = {
        name: in_order(level for side in beside.sides for level in side.levels(name))
        for name in beside.factors
    }
    return {
        "factors": [_factor(name, levels) for name, levels in factors.items()],
        "measures": [
            {
                "name": name,
                "about": MEANINGS[name.rpartition(".")[2]],
                "less": is_less_better(name),
            }
            for name in beside.measures
        ],
        "experiments": [
            _experiment(side, held, factors, beside.measures)
            for side, held in zip(beside.sides, beside.held, strict=True)
        ],
    }


def _factor(name: str, levels: Sequence[Level]) -> dict[str, Any]:
    """Return a setting as the page has it; levels with a unit are told as numbers."""
    amounts = [amount for level in levels if (amount := amount_of(level)) is not None]
    is_number = len(amounts) == len(levels)
    unit = unit_of(name) if is_number else ""
    return {
        "name": name,
        "unit": unit,
        "levels": [f"{amount:.10g}" for amount in amounts] if unit else levels,
        "amounts": amounts if is_number else None,
    }


def _experiment(
    side: Findings,
    held: Mapping[str, Level],
    factors: Mapping[str, Sequence[Level]],
    measures: Sequence[str],
) -> dict[str, Any]:
    """Return an experiment as the page has it; levels are numbers of levels."""
    own = {name: side.levels(name) for name in held}
    ranks = {name: _ranks(levels) for name, levels in {**factors, **own}.items()}
    runs = [] if side.experiment is None else runs_of_cells(side.experiment)
    cells: dict[tuple[int, ...], dict[str, Any]] = {}
    for number, cell in enumerate(side.cells):
        at = [ranks[name][key_of(side.level(cell.cell, name))] for name in ranks]
        key = (*at,)
        told = _cell(cell, measures, runs[number] if runs else None)
        cells.setdefault(key, {"levels": at[: len(factors)], "own": at[len(factors) :], **told})
    return {
        "name": side.name,
        "own": [
            {**_factor(name, own[name]), "held": ranks[name][key_of(level)]}
            for name, level in held.items()
        ],
        "first_seed": None if side.experiment is None else side.experiment.design.first_seed,
        "cells": list(cells.values()),
    }


def _ranks(levels: Sequence[Level]) -> dict[float | str, int]:
    return {key_of(level): number for number, level in enumerate(levels)}


def _cell(cell: CellMeasures, measures: Sequence[str], runs: CellRuns | None) -> dict[str, Any]:
    told: dict[str, Any] = {
        "runs": cell.runs,
        "failed": cell.failed,
        "shares": [list(cell.shares[measure]) for measure in measures],
    }
    if runs is None:
        return told
    missed = [runs.missed[measure] for measure in measures]
    return {
        **told,
        "command": runs.command,
        "missed": [[len(seeds), *seeds[:_MOST_SEEDS]] for seeds in missed],
        "broken": runs.failed[:_MOST_SEEDS],
    }

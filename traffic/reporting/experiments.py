"""The page of an experiment: its measures as heat map, curves and table, by any two factors."""

from collections.abc import Iterable, Sequence
from typing import Any

from traffic.experiments.designs import Level
from traffic.experiments.running import Experiment
from traffic.reporting.pages import embedded, render

__all__ = ["page_of_experiment"]


def page_of_experiment(experiment: Experiment) -> str:
    """Return the page of an experiment as one self-contained HTML document."""
    design = experiment.design
    return render(
        "experiment.html",
        {
            "title": design.name,
            "description": design.description,
            "facts": list(_facts(experiment)),
            "fixed": design.fixed,
            "errors": experiment.errors,
            "versions": experiment.versions,
            "data": embedded(_data(experiment)),
        },
    )


def _facts(experiment: Experiment) -> Iterable[tuple[str, str]]:
    runs = sum(cell.runs for cell in experiment.cells)
    failed = sum(cell.failed for cell in experiment.cells)
    yield "runs", f"{runs:,}"
    yield "cells", f"{len(experiment.cells):,}"
    yield "runs in each", f"{experiment.design.runs_per_cell:,}"
    yield "failed", f"{failed:,}"


def _data(experiment: Experiment) -> dict[str, Any]:
    names = experiment.design.varying
    levels = [_ordered([cell.cell[name] for cell in experiment.cells]) for name in names]
    index = [{repr(level): i for i, level in enumerate(each)} for each in levels]
    cells = [
        {
            "levels": [index[i][repr(cell.cell[name])] for i, name in enumerate(names)],
            "runs": cell.runs,
            "failed": cell.failed,
            "shares": [list(cell.shares[measure]) for measure in experiment.design.measures],
        }
        for cell in experiment.cells
    ]
    factors = [{"name": name, "levels": each} for name, each in zip(names, levels, strict=True)]
    return {"factors": factors, "measures": experiment.design.measures, "cells": cells}


def _ordered(levels: Sequence[Level]) -> list[Level]:
    """Return each level once: numbers by size, others as the design has them."""
    found = list({repr(level): level for level in levels}.values())
    numbers = [each for each in found if isinstance(each, int | float)]
    return sorted(numbers) if len(numbers) == len(found) else found

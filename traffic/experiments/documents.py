"""An experiment as a document for other programs."""

from pydantic_core import to_json

from traffic.experiments.measures import Share
from traffic.experiments.running import Experiment

__all__ = ["json_from_experiment"]


def json_from_experiment(experiment: Experiment) -> str:
    """Return an experiment as one JSON document."""
    cells = [
        {
            "cell": dict(cell.cell),
            "runs": cell.runs,
            "failed": cell.failed,
            "measures": {name: _json_from_share(each) for name, each in cell.shares.items()},
        }
        for cell in experiment.cells
    ]
    design = experiment.design
    document = {
        "design": design.name,
        "description": design.description,
        "fixed": design.fixed,
        "runs_per_cell": design.runs_per_cell,
        "versions": experiment.versions,
        "cells": cells,
        "errors": experiment.errors,
    }
    return to_json(document, indent=1).decode()


def _json_from_share(share: Share) -> dict[str, float | int | None]:
    low, high = share.interval
    counts = share._asdict()
    return {**counts, "value": share.value, "low": low, "high": high}

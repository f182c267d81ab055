"""What was found out: by an experiment, by one run, or by others who made a table of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from dyknow.time import MILLISECOND
from traffic.experiments.cell_files import find_cell_file, read_cell_file
from traffic.experiments.designs import Cell, Level
from traffic.experiments.folders import ExperimentFolder
from traffic.experiments.levels import in_order
from traffic.experiments.measures import Share
from traffic.experiments.running import Experiment, read_experiment
from traffic.experiments.tables import CellMeasures
from traffic.request import DEFAULT_PERIOD
from traffic.results import read_result

__all__ = [
    "Findings",
    "findings_of",
    "holds_experiment",
    "named_apart",
    "read_experiment_or_table",
    "read_findings",
]

_BY_DEFAULT: Mapping[str, Level] = {
    "sample_period": DEFAULT_PERIOD // MILLISECOND,
    "position_noise": 0,
}
"""Levels of settings that a design may leave out and that are often a factor of others."""


@dataclass(frozen=True, slots=True)
class Findings:
    """Cells and what was found out about each.

    Attributes:
        name: What they are called.
        description: A sentence, or nothing.
        varying: Names of the settings that vary.
        fixed: Levels of settings that do not vary, as far as they are known.
        measures: What was asked, in order.
        cells: What was found out; one cell without levels if nothing varies.
        experiment: Where they are from; None if not from an experiment.
    """

    name: str
    description: str
    varying: tuple[str, ...]
    fixed: Mapping[str, Level]
    measures: tuple[str, ...]
    cells: tuple[CellMeasures, ...]
    experiment: Experiment | None = field(default=None, compare=False)

    def knows(self, name: str) -> bool:
        """Whether the level of a setting is known in all cells."""
        return name in self.varying or name in self.fixed

    def level(self, cell: Cell, name: str) -> Level:
        """Return the level of a setting that is known, in a cell."""
        return cell[name] if name in cell else self.fixed[name]

    def levels(self, name: str) -> list[Level]:
        """Return the levels of a setting that is known: numbers by size."""
        return in_order(self.level(cell.cell, name) for cell in self.cells)


def holds_experiment(path: Path) -> bool:
    """Return whether *path* is that of an experiment, or of a table that stands for one."""
    return ExperimentFolder(path).is_there or find_cell_file(path) is not None


def findings_of(experiment: Experiment) -> Findings:
    """Return what an experiment found out."""
    design = experiment.design
    scenario = {} if design.scenario is None else {"scenario": design.scenario}
    given = {**_BY_DEFAULT, **scenario, **design.fixed}
    return Findings(
        name=design.name,
        description=design.description,
        varying=design.varying,
        fixed={name: level for name, level in given.items() if name not in design.varying},
        measures=design.measures,
        cells=tuple(experiment.cells),
        experiment=experiment,
    )


def named_apart(sides: Sequence[Findings]) -> list[Findings]:
    """Return the same with names that tell them apart: by their folders, where names are equal."""
    names = [side.name for side in sides]
    return [
        replace(side, name=str(side.experiment.path))
        if names.count(side.name) > 1 and side.experiment is not None
        else side
        for side in sides
    ]


def read_experiment_or_table(path: Path) -> Findings:
    """Read a finished experiment, or a table that stands for one.

    Raises:
        ExperimentError: The experiment is not finished, or files are damaged or have faults.
    """
    file = find_cell_file(path)
    if file is None:
        return findings_of(read_experiment(path))
    table = read_cell_file(file)
    name, told = file.stem, table.description
    return Findings(name, told, table.varying, {}, table.measures, table.cells)


def read_findings(path: Path) -> Findings:
    """Read a finished experiment, a table that stands for one, or a finished run.

    Raises:
        ExperimentError: The experiment is not finished, or files are damaged or have faults.
        ResultError: There is none of them.
    """
    if holds_experiment(path):
        return read_experiment_or_table(path)
    score = read_result(path).score
    shares = {
        f"{kind}.{what}": Share(each.correct, total)
        for kind, each in score.items()
        for what, total in (("recall", each.truth), ("precision", each.recognised))
    }
    cell = CellMeasures({}, 1, 0, shares)
    return Findings(str(path), "", (), {}, tuple(shares), (cell,))

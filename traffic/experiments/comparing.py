"""Two experiments, or two runs, side by side: what differs, and whether that may be chance."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from traffic.errors import ExperimentError
from traffic.experiments.designs import Level
from traffic.experiments.folders import ExperimentFolder
from traffic.experiments.intervals import Interval, difference
from traffic.experiments.measures import Share
from traffic.experiments.running import read_experiment
from traffic.results import read_result

__all__ = ["Comparison", "Difference", "Side", "compare", "read_side"]

CellKey = tuple[tuple[str, Level], ...]
"""The levels of a cell, by the names of the factors."""


@dataclass(frozen=True, slots=True)
class Side:
    """One of two things to compare.

    Attributes:
        name: What it is called.
        measures: What was asked of it, in order.
        shares: What was found out, by cell and by measure; a run is one cell without levels.
    """

    name: str
    measures: tuple[str, ...]
    shares: Mapping[CellKey, Mapping[str, Share]]


@dataclass(frozen=True, slots=True)
class Difference:
    """What a measure of a cell says on both sides.

    Attributes:
        cell: The levels of the cell.
        measure: Which measure.
        one: Of the first side.
        other: Of the second side.
        interval: Where the second probability minus the first one lies, with a confidence of 95 %.
    """

    cell: CellKey
    measure: str
    one: Share
    other: Share
    interval: Interval

    @property
    def is_clear(self) -> bool:
        """Whether the difference is more than chance makes in one of twenty comparisons."""
        return not self.interval.low <= 0 <= self.interval.high


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two sides and all their differences.

    Attributes:
        one: Name of the first side.
        other: Name of the second side.
        differences: Of each measure of each cell that both have.
        only: Cells that only one of them has, with its name.
    """

    one: str
    other: str
    differences: tuple[Difference, ...]
    only: tuple[tuple[str, CellKey], ...]


def read_side(path: Path) -> Side:
    """Read a finished experiment or a finished run.

    Raises:
        ExperimentError: The experiment is not finished or its files are damaged.
        ResultError: There is neither.
    """
    if ExperimentFolder(path).is_there:
        experiment = read_experiment(path)
        shares = {tuple(sorted(cell.cell.items())): cell.shares for cell in experiment.cells}
        return Side(str(path), experiment.design.measures, shares)
    score = read_result(path).score
    found = {
        f"{kind}.{what}": Share(each.correct, total)
        for kind, each in score.items()
        for what, total in (("recall", each.truth), ("precision", each.recognised))
    }
    return Side(str(path), tuple(found), {(): found})


def compare(one: Side, other: Side) -> Comparison:
    """Compare what two experiments, or two runs, found out.

    Raises:
        ExperimentError: They measure different things, or have no cell in common.
    """
    if set(one.measures) != set(other.measures):
        found = " and ".join(f"{', '.join(s.measures)} ({s.name})" for s in (one, other))
        raise ExperimentError(f"expected the same measures on both sides, found {found}")
    common = [cell for cell in one.shares if cell in other.shares]
    if not common:
        raise ExperimentError(f"'{one.name}' and '{other.name}' have no cell in common")
    differences = tuple(
        Difference(cell, measure, first, second, difference(first, second))
        for cell in common
        for measure in one.measures
        for first, second in [(one.shares[cell][measure], other.shares[cell][measure])]
    )
    only = [
        (side.name, cell) for side in (one, other) for cell in side.shares if cell not in common
    ]
    return Comparison(one.name, other.name, differences, tuple(only))

"""Two experiments, or two runs, side by side: what differs, and whether that may be chance."""

from dataclasses import dataclass

from traffic.errors import ExperimentError
from traffic.experiments.beside import Beside, put_beside, remarks_about
from traffic.experiments.designs import Cell
from traffic.experiments.findings import Findings
from traffic.experiments.intervals import Interval, difference
from traffic.experiments.measures import Share

__all__ = ["Comparison", "Difference", "compare"]


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

    cell: Cell
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
        differences: Of each measure that both have, of each cell that both have.
        only: Cells that only one of them has, with its name.
        remarks: What else they do not have in common, as sentences.
    """

    one: str
    other: str
    differences: tuple[Difference, ...]
    only: tuple[tuple[str, Cell], ...]
    remarks: tuple[str, ...]


def compare(one: Findings, other: Findings) -> Comparison:
    """Compare what two experiments, or two runs, found out.

    Raises:
        ExperimentError: They measure different things, or have no cell in common.
    """
    beside = put_beside((one, other))
    if not beside.measures:
        found = " and ".join(f"{', '.join(s.measures)} ({s.name})" for s in (one, other))
        raise ExperimentError(f"expected the same measures on both sides, found {found}")
    if not beside.common or _is_vague(beside):
        raise ExperimentError(f"'{one.name}' and '{other.name}' have no cell in common")
    differences = tuple(
        Difference(row.cell, measure, first, second, difference(first, second))
        for row in beside.common
        for measure in beside.measures
        for first, second in [(each.shares[measure] for each in row.found if each is not None)]
    )
    only = tuple(
        (side.name, row.cell)
        for number, side in enumerate((one, other))
        for row in beside.rows
        if row.found[number] is not None and not row.is_common
    )
    return Comparison(one.name, other.name, differences, only, tuple(remarks_about(beside)))


def _is_vague(beside: Beside) -> bool:
    """Return whether something varies, but nothing by which cells could belong together."""
    return not beside.factors and any(len(side.cells) > 1 for side in beside.sides)

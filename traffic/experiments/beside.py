"""Several experiments side by side: the cells in which they can be compared.

Cells belong together if the factors of all experiments have the same levels there. A factor is one
that varies in some experiment and is known in all: because it varies there too, or because it is
fixed. A setting that varies in one experiment and of which another one tells nothing is held at
one level: that at which others hold it, or else the first one of the design.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from traffic.experiments.designs import Cell, Level
from traffic.experiments.findings import Findings
from traffic.experiments.levels import LevelKey, in_order, key_of
from traffic.experiments.tables import CellMeasures

__all__ = ["Beside", "Row", "put_beside", "remarks_about"]

_Key = tuple[LevelKey, ...]
_MOST_LEVELS = 8
_DEFAULT = "as by default"


@dataclass(frozen=True, slots=True)
class Row:
    """A cell, as each experiment has it.

    Attributes:
        cell: Its levels.
        found: What each experiment found out about it; None where it has no such cell.
    """

    cell: Cell
    found: tuple[CellMeasures | None, ...]

    @property
    def is_common(self) -> bool:
        """Whether all experiments have the cell."""
        return None not in self.found


@dataclass(frozen=True, slots=True)
class Beside:
    """Experiments side by side.

    Attributes:
        sides: The experiments.
        factors: By whose levels cells belong together.
        measures: Those that all experiments have.
        held: Of each experiment, settings that vary in it but are no factors, and the levels at
            which it is looked at.
        rows: All cells of all experiments at these levels, in order of their levels.
    """

    sides: tuple[Findings, ...]
    factors: tuple[str, ...]
    measures: tuple[str, ...]
    held: tuple[Cell, ...]
    rows: tuple[Row, ...]

    @property
    def common(self) -> tuple[Row, ...]:
        """The cells that all experiments have."""
        return tuple(row for row in self.rows if row.is_common)


def put_beside(sides: Sequence[Findings]) -> Beside:
    """Put experiments side by side; they need not have anything in common."""
    varying = dict.fromkeys(name for side in sides for name in side.varying)
    factors = tuple(name for name in varying if all(side.knows(name) for side in sides))
    measures = tuple(m for m in sides[0].measures if all(m in side.measures for side in sides))
    held = tuple(_held(side, factors, sides) for side in sides)
    found = [_by_key(side, factors, at) for side, at in zip(sides, held, strict=True)]
    rows = tuple(
        Row(cell, tuple(cells.get(key) for cells in found))
        for key, cell in _in_order(sides, factors, found)
    )
    return Beside(tuple(sides), factors, measures, held, rows)


def remarks_about(beside: Beside) -> list[str]:
    """Return sentences about what the experiments do not have in common."""
    return [
        *_held_settings(beside),
        *_settings_that_differ(beside),
        *_measures_of_some(beside),
        *_cells_of_some(beside),
    ]


def _held(side: Findings, factors: Sequence[str], sides: Sequence[Findings]) -> Cell:
    """Return the levels at which the settings that vary, but are no factors, are looked at."""
    return {name: _level_held(side, name, sides) for name in side.varying if name not in factors}


def _level_held(side: Findings, name: str, sides: Sequence[Findings]) -> Level:
    own = {key_of(cell.cell[name]): cell.cell[name] for cell in side.cells}
    fixed = [key_of(other.fixed[name]) for other in sides if name in other.fixed]
    return next((own[key] for key in fixed if key in own), side.cells[0].cell[name])


def _by_key(side: Findings, factors: Sequence[str], held: Cell) -> dict[_Key, CellMeasures]:
    """Return the cells at the levels that are held; a cell that a design has twice, once."""
    found: dict[_Key, CellMeasures] = {}
    for cell in side.cells:
        if all(key_of(cell.cell[name]) == key_of(level) for name, level in held.items()):
            key = tuple(key_of(side.level(cell.cell, name)) for name in factors)
            found.setdefault(key, cell)
    return found


def _in_order(
    sides: Sequence[Findings], factors: Sequence[str], found: Sequence[Mapping[_Key, CellMeasures]]
) -> Iterator[tuple[_Key, Cell]]:
    """Yield all cells with their levels, in the order of these."""
    levels = [in_order(each for s in sides for each in s.levels(name)) for name in factors]
    ranks = [{key_of(level): i for i, level in enumerate(each)} for each in levels]
    keys = dict.fromkeys(key for cells in found for key in cells)
    for key in sorted(
        keys, key=lambda k: [rank[part] for rank, part in zip(ranks, k, strict=True)]
    ):
        at = [each[rank[part]] for each, rank, part in zip(levels, ranks, key, strict=True)]
        yield key, dict(zip(factors, at, strict=True))


def _held_settings(beside: Beside) -> Iterator[str]:
    for side, held in zip(beside.sides, beside.held, strict=True):
        for name, level in held.items():
            others = _listed([each for each in side.levels(name) if each != level])
            yield f"{side.name} also varies {name}: shown at {level}, not at {others}"


def _settings_that_differ(beside: Beside) -> Iterator[str]:
    """Yield the settings that are fixed at different levels; of tables they are not known."""
    sides = [side for side in beside.sides if side.fixed]
    for name in dict.fromkeys(name for side in sides for name in side.fixed):
        fixed = [side.fixed.get(name, _DEFAULT) for side in sides if name not in side.varying]
        if name not in beside.factors and len({key_of(level) for level in fixed}) > 1:
            at = {side.name: side.fixed.get(name, _DEFAULT) for side in sides}
            yield f"{name} is " + ", ".join(f"{level} in {side}" for side, level in at.items())


def _measures_of_some(beside: Beside) -> Iterator[str]:
    for side in beside.sides:
        others = [each.measures for each in beside.sides if each is not side]
        own = [m for m in side.measures if m not in beside.measures]
        alone = [m for m in own if not any(m in each for each in others)]
        if alone and others:
            yield f"only {side.name} measures {', '.join(alone)}"


def _cells_of_some(beside: Beside) -> Iterator[str]:
    """Yield who has cells that not all have, with the levels that it alone has."""
    for number, side in enumerate(beside.sides):
        own = [row for row in beside.rows if row.found[number] and not row.is_common]
        if not own:
            continue
        cells = "1 cell" if len(own) == 1 else f"{len(own)} cells"
        rest = "" if beside.common else "; none is common to all"
        yield f"{side.name} has {cells} that not all have{_levels_of_own(beside, own)}{rest}"


def _levels_of_own(beside: Beside, own: Sequence[Row]) -> str:
    told = []
    for name in beside.factors:
        shared = {key_of(row.cell[name]) for row in beside.common}
        levels = in_order(r.cell[name] for r in own if key_of(r.cell[name]) not in shared)
        if levels:
            told.append(f"{name} {_listed(levels)}")
    return f" ({'; '.join(told)})" if told else ""


def _listed(levels: Sequence[Level]) -> str:
    texts = [str(level) for level in levels[:_MOST_LEVELS]]
    more = len(levels) - _MOST_LEVELS
    return ", ".join(texts) + (f" and {more} more" if more > 0 else "")

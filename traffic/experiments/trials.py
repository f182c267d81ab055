"""Which cells of a design are tried before anything runs: each level is in one of them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dyknow.time import duration_from_text
from traffic.experiments.designs import Cell, Design, Level, LevelRange
from traffic.scenarios.places import KeyPath

__all__ = ["MOST_NUMBERS", "Trial", "trials_of"]

MOST_NUMBERS = 100
"""With so many numbers or times of one factor at the most the network of processes is tried."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A cell that is tried.

    Attributes:
        cell: The cell.
        place: Where its newest level is written.
        is_whole: Whether its network of processes is tried as well.
    """

    cell: Cell
    place: KeyPath
    is_whole: bool = True


def trials_of(design: Design) -> Iterator[Trial]:
    """Yield cells in which every level occurs: all that are listed, or one for each level."""
    if design.cells:
        for number, cell in enumerate(design.cells):
            yield Trial(cell, ("cells", number))
        return
    levels = {name: _ends(given) for name, given in design.factors.items()}
    first = {name: given[0] for name, given in levels.items()}
    yield Trial(first, ("fixed",))
    for name, given in levels.items():
        spared = _spared(given)
        for number, level in enumerate(given[1:], start=1):
            yield Trial({**first, name: level}, ("factors", name), number not in spared)


def _ends(levels: tuple[Level, ...] | LevelRange) -> tuple[Level, ...]:
    return levels.bounds if isinstance(levels, LevelRange) else levels


def _spared(levels: Sequence[Level]) -> set[int]:
    """Return where the numbers and times are whose neighbours are tried in their place.

    Of many of one type these are all but the smallest, the largest, and some between.
    """
    sizes = [_size(level) for level in levels]
    spared: set[int] = set()
    for kind in (int, float, str):
        sized = [(size, at) for at, size in enumerate(sizes) if type(levels[at]) is kind]
        places = [at for _, at in sorted((size, at) for size, at in sized if size is not None)]
        if len(places) > MOST_NUMBERS:
            tried = np.linspace(0, len(places) - 1, MOST_NUMBERS).round().astype(int)
            spared |= {*places} - {places[at] for at in tried}
    return spared


def _size(level: Level) -> float | None:
    """Return a number, or a time as one; None for anything else."""
    if not isinstance(level, str):
        return level
    try:
        return duration_from_text(level)
    except ValueError:
        return None

"""Designs: which runs an experiment consists of.

As TOML:

    description = "..."
    scenario = "two_cars"           # a bundled name, or a path beside the design
    runs_per_cell = 100             # of each combination, with the seeds 1, 2, ...
    measures = ["overtake.detection", "overtake.false_alarms"]

    [fixed]                         # settings of every run
    view = "truth"
    duration = "40 s"

    [factors]                       # settings that vary, and their levels: all combinations
    position_noise = [0, 2, 3, 4]
    sample_period = [100, 200]

In place of all combinations there may be a list of them (`[[cells]]`), or some that are drawn at
random (`[sampling]` with `cells` and `seed`; a factor is then a list to choose from, or a range
`{ from = 0, to = 10 }`). What can be set is what `traffic run` can set (`traffic.settings`);
`scenario` can be a factor as well. The path of a `specification` is beside the design, too.
"""

import itertools
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Self

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    model_validator,
)

from traffic.experiments.measures import Measure

__all__ = ["Cell", "Design", "Level", "LevelRange", "Sampling"]


def _checked(value: object) -> object:
    is_level = isinstance(value, bool | int | str) or (
        isinstance(value, float) and math.isfinite(value)
    )
    if not is_level:
        expected = "a number, a text, or true or false"
        raise ValueError(f"expected {expected}, found {value}")
    return value


Level = Annotated[bool | int | float | str, BeforeValidator(_checked)]
"""A value of a setting."""

Cell = Mapping[str, Level]
"""One combination of levels, by factor, in the order of the design."""


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class LevelRange(_Table):
    """Levels between two numbers, drawn evenly.

    Attributes:
        begin: The smallest; `from` in the file.
        end: The largest; `to` in the file.
        step: Distance between levels, from `begin` on; None for any number between.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    begin: Annotated[float, Field(alias="from")]
    end: Annotated[float, Field(alias="to")]
    step: Annotated[float, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        if self.begin >= self.end:
            raise ValueError(f"expected 'from' below 'to', found {self.begin:g} and {self.end:g}")
        return self

    @property
    def bounds(self) -> tuple[float, float]:
        """The smallest and the largest level."""
        if self.step is None:
            return self.begin, self.end
        return self.begin, self.begin + self.step * self._n_steps

    def draw(self, generator: np.random.Generator) -> float:
        """Return a level, each as likely as any other."""
        if self.step is None:
            return float(generator.uniform(self.begin, self.end))
        return self.begin + self.step * int(generator.integers(self._n_steps + 1))

    @property
    def _n_steps(self) -> int:
        step = self.step or 1.0
        return math.floor((self.end - self.begin) / step + 1e-9)


class Sampling(_Table):
    """Cells are drawn at random.

    Attributes:
        cells: How many.
        seed: Of the choice.
    """

    cells: Annotated[int, Field(ge=1, le=10_000_000)]
    seed: Annotated[int, Field(ge=0)] = 1


def _not_empty(levels: tuple[Level, ...]) -> tuple[Level, ...]:
    """Return levels if there are any; those that are at fault count as well."""
    if not levels:
        raise ValueError("expected at least one level, found none")
    return levels


def _shape(value: object) -> str:
    return "range" if isinstance(value, dict | LevelRange) else "list"


Levels = Annotated[
    Annotated[tuple[Level, ...], AfterValidator(_not_empty), Tag("list")]
    | Annotated[LevelRange, Tag("range")],
    Discriminator(_shape),
]


class Design(_Table):
    """Which runs an experiment consists of, and what is asked of them.

    Attributes:
        name: Of the file, without its ending.
        folder: Of the file; paths in it are beside it.
        description: One sentence.
        scenario: Name or path; None if it is a factor.
        runs_per_cell: How many runs each combination has.
        first_seed: The seed of the first of these; the others have the next ones.
        measures: What is asked of the runs of a cell, such as `overtake.recall`.
        fixed: Settings of every run.
        factors: Levels of the settings that vary.
        cells: The combinations, if not all.
        sampling: Set if combinations are drawn at random.
    """

    name: str
    folder: Path
    description: str = ""
    scenario: str | None = None
    runs_per_cell: Annotated[int, Field(ge=1, le=10_000_000)] = 1
    first_seed: Annotated[int, Field(ge=0)] = 1
    measures: Annotated[tuple[Measure, ...], Field(min_length=1)]
    fixed: dict[str, Level] = {}
    factors: dict[str, Levels] = {}
    cells: tuple[dict[str, Level], ...] = ()
    sampling: Sampling | None = None

    @property
    def n_cells(self) -> int:
        """How many combinations there are."""
        if self.cells:
            return len(self.cells)
        if self.sampling is not None:
            return self.sampling.cells
        return math.prod(len(levels) for levels in self._lists().values())

    @property
    def n_runs(self) -> int:
        """How many runs there are."""
        return self.n_cells * self.runs_per_cell

    @property
    def seeds(self) -> range:
        """The seeds of the runs of each cell."""
        return range(self.first_seed, self.first_seed + self.runs_per_cell)

    @property
    def varying(self) -> tuple[str, ...]:
        """Names of the settings that vary."""
        if self.cells:
            return tuple(self.cells[0])
        return tuple(self.factors)

    def combinations(self) -> Iterator[Cell]:
        """Yield the cells; the last factor changes fastest."""
        if self.cells:
            yield from self.cells
        elif self.sampling is not None:
            yield from self._sample(self.sampling)
        else:
            lists = self._lists()
            for levels in itertools.product(*lists.values()):
                yield dict(zip(lists, levels, strict=True))

    def _lists(self) -> dict[str, tuple[Level, ...]]:
        return {k: v for k, v in self.factors.items() if isinstance(v, tuple)}

    def _sample(self, sampling: Sampling) -> Iterator[Cell]:
        generator = np.random.default_rng(sampling.seed)  # noqa: TID251, the design's
        for _ in range(sampling.cells):
            yield {name: _drawn(levels, generator) for name, levels in self.factors.items()}


def _drawn(levels: tuple[Level, ...] | LevelRange, generator: np.random.Generator) -> Level:
    if isinstance(levels, LevelRange):
        return levels.draw(generator)
    return levels[int(generator.integers(len(levels)))]

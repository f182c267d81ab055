"""Runs of an experiment that someone wants to look at: which, and how each is done again."""

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from traffic.experiments.cases import Case, Outcome, cases_of
from traffic.experiments.designs import Level
from traffic.experiments.measures import Counts, is_less_better, kind_of, share
from traffic.experiments.running import Experiment
from traffic.request import OPTIONS

__all__ = ["CellRuns", "command_of", "runs_of_cells"]

_SPECIFICATION = "specification"


@dataclass(frozen=True, slots=True)
class CellRuns:
    """The runs of a cell that someone may want to look at.

    Attributes:
        command: What does a run of it again, but for its seed: a command line.
        missed: By measure, the seeds of the runs that are not as they should be.
        failed: Seeds of the runs that failed.
    """

    command: str
    missed: Mapping[str, tuple[int, ...]]
    failed: tuple[int, ...]


def runs_of_cells(experiment: Experiment) -> list[CellRuns]:
    """Return for each cell, in the order of the design, what to look at and how."""
    by_cell: dict[int, list[Case]] = {}
    for case in cases_of(experiment.design):
        by_cell.setdefault(case.cell, []).append(case)
    return [_runs_of(experiment, cases) for cases in by_cell.values()]


def command_of(case: Case, files: Sequence[str] = ()) -> str:
    """Return the command line that does a run again, without its seed.

    Args:
        case: The run.
        files: Paths of what the runs of its experiment have read; the folder of an experiment
            has a copy of the design only, so that what was beside the design is found there.
    """
    settings = dict(case.settings)
    if _SPECIFICATION in settings:
        settings[_SPECIFICATION] = _path(case, str(settings[_SPECIFICATION]), files)
    is_file = case.scenario.endswith(".toml")
    scenario = _path(case, case.scenario, files) if is_file else case.scenario
    return shlex.join(["traffic", "run", scenario, *_words_of(settings)])


def _runs_of(experiment: Experiment, cases: Sequence[Case]) -> CellRuns:
    done = {case.seed: experiment.outcomes.get(case.key) for case in cases}
    found = {seed: outcome for seed, outcome in done.items() if outcome is not None}
    well = {seed: outcome for seed, outcome in found.items() if outcome.error is None}
    return CellRuns(
        command=command_of(cases[0], experiment.files),
        missed={m: tuple(_missed(m, well)) for m in experiment.design.measures},
        failed=tuple(seed for seed in found if seed not in well),
    )


def _missed(measure: str, outcomes: Mapping[int, Outcome]) -> Iterator[int]:
    """Yield the seeds of the runs in which not all was as it should be."""
    for seed, outcome in outcomes.items():
        counts = outcome.counts.get(kind_of(measure), Counts(0, 0, 0))
        successes, trials = share(measure, [counts])
        best = 0 if is_less_better(measure) else trials
        if successes != best:
            yield seed


def _path(case: Case, name: str, files: Sequence[str]) -> str:
    """Return the path of a file that a design names."""
    beside = case.folder / name
    same = [file for file in files if Path(file).name == beside.name]
    return str(beside) if beside.exists() or not same else same[0]


def _words_of(settings: Mapping[str, Level]) -> Iterator[str]:
    """Yield the options that say what settings say."""
    for name, level in settings.items():
        text = str(level).lower() if isinstance(level, bool) else str(level)
        if name not in OPTIONS:
            yield from ("--set", f"{name}={text}")
        else:
            yield from (f"--{name.replace('_', '-')}", text)

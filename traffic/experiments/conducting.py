"""An experiment, from its beginning or from where it was cut off, to its end."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from traffic.errors import ExperimentError
from traffic.experiments.cases import Outcome, cases_of
from traffic.experiments.designs import Design
from traffic.experiments.engine import Engine
from traffic.experiments.folders import ExperimentFolder, write_whole
from traffic.experiments.journal import Journal
from traffic.experiments.tables import (
    cell_table,
    measure_cells,
    parquet_from_runs,
    run_table,
)

__all__ = ["OnProgress", "Progress", "conduct", "finish"]


@dataclass(frozen=True, slots=True)
class Progress:
    """How far an experiment has come.

    Attributes:
        done: Runs that are finished, also those of an earlier time.
        failed: How many of these failed.
        running: Workers that are at work.
        total: Runs in all.
        rate: Runs in a second, since the first one was finished after it was begun or resumed;
            None until then, because workers that begin are slow.
    """

    done: int
    failed: int
    running: int
    total: int
    rate: float | None

    @property
    def seconds_left(self) -> float | None:
        """How long it will still take, if it goes on like this."""
        return (self.total - self.done) / self.rate if self.rate else None


OnProgress = Callable[[Progress], None]


def conduct(
    design: Design, folder: ExperimentFolder, engine: Engine, on_progress: OnProgress
) -> Mapping[str, Outcome]:
    """Do the runs that are missing, and make the tables of all; return the outcomes by key.

    Each finished run is on the disk before the next counts as finished.

    Raises:
        ExperimentError: The folder cannot be written or read. What is finished stays.
    """
    outcomes = folder.outcomes()
    failed = sum(outcome.error is not None for outcome in outcomes.values())
    missing = (case for case in cases_of(design) if case.key not in outcomes)
    first: float | None = None
    since = 0
    with Journal(folder.journal) as journal:
        for outcome in engine.outcomes(missing):
            journal.append(outcome.as_line())
            outcomes[outcome.key] = outcome
            failed += outcome.error is not None
            done, now = len(outcomes), time.perf_counter()
            rate = None if first is None else (done - since) / (now - first)
            if first is None:
                first, since = now, done
            running = min(engine.n_workers, design.n_runs - done)
            on_progress(Progress(done, failed, running, design.n_runs, rate))
    finish(design, folder, outcomes)
    return outcomes


def finish(design: Design, folder: ExperimentFolder, outcomes: Mapping[str, Outcome]) -> None:
    """Make the tables of an experiment whose runs are all finished.

    Raises:
        ExperimentError: They cannot be written.
    """
    runs = parquet_from_runs(run_table(design, outcomes))
    cells = cell_table(design.measures, measure_cells(design, outcomes)).to_csv(index=False)
    _write(folder.runs, runs)
    _write(folder.cells, cells.encode())


def _write(path: Path, content: bytes) -> None:
    try:
        write_whole(path, content)
    except OSError as error:
        raise ExperimentError(f"cannot write '{path}': {error.strerror}") from error

"""An experiment as a user asks for it: checked, begun or resumed, conducted, measured."""

from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path

from traffic.errors import ExperimentError, RequestError
from traffic.experiments.cases import Outcome
from traffic.experiments.conducting import OnProgress, conduct
from traffic.experiments.designs import Design
from traffic.experiments.engine import Engine, cluster_at, local_workers
from traffic.experiments.estimating import MANY_RUNS, Estimate, estimate
from traffic.experiments.folders import Basis, ExperimentFolder, basis_of
from traffic.experiments.reading import check_design, read_design
from traffic.experiments.request import ExperimentRequest
from traffic.experiments.tables import CellMeasures, measure_cells

__all__ = ["Experiment", "estimate_experiment", "read_experiment", "run_experiment"]


@dataclass(frozen=True, slots=True)
class Experiment:
    """An experiment and what it found out.

    Attributes:
        path: Its folder.
        design: Its design.
        cells: The measures of its cells.
        errors: Why runs failed: a text for each failed run, with its settings.
        versions: Of the program and of what results may depend on.
        outcomes: What became of each run, by key.
        files: Paths of the files that its runs have read.
    """

    path: Path
    design: Design
    cells: list[CellMeasures]
    errors: list[str]
    versions: dict[str, str]
    outcomes: Mapping[str, Outcome] = field(default_factory=dict, repr=False)
    files: tuple[str, ...] = ()

    @property
    def has_failed(self) -> bool:
        """Whether all of its runs failed, so that nothing was measured."""
        return len(self.errors) == self.design.n_runs


def run_experiment(request: ExperimentRequest, on_progress: OnProgress) -> Experiment:
    """Do what is asked; what is finished stays, whatever happens.

    Raises:
        ExperimentError: The design has faults, the folder cannot be written, read or resumed, or
            the cluster cannot be used.
        RequestError: The design has so many runs that someone should say that it is meant.
    """
    design = read_design(request.design)
    if design.n_runs > MANY_RUNS and not request.yes:
        expected = f"at most {MANY_RUNS:,} runs, or --yes to say that it is meant"
        raise RequestError("DESIGN", expected, f"{design.n_runs:,} runs")
    checked = check_design(request.design, design)
    basis = basis_of(request.design, checked.files)
    folder = ExperimentFolder(request.folder)
    if request.resume:
        folder.resume(basis)
    else:
        folder.forbid_another()
    with _engine(request, basis) as engine:
        if not request.resume:
            folder.begin(request.design, basis)
        with folder.locked():
            conduct(design, folder, engine, on_progress)
    return read_experiment(request.folder, design)


def estimate_experiment(request: ExperimentRequest) -> Estimate:
    """Check a design and tell what it will take; nothing is written.

    Raises:
        ExperimentError: The design has faults.
    """
    design = read_design(request.design)
    return estimate(check_design(request.design, design), request.workers)


def read_experiment(path: Path, design: Design | None = None) -> Experiment:
    """Read a finished experiment.

    Args:
        path: Its folder.
        design: Its design, if that is known already.

    Raises:
        ExperimentError: There is none, runs of it are missing, or its files are damaged.
    """
    folder = ExperimentFolder(path)
    basis = folder.basis()
    design = design or read_design(folder.design).model_copy(update={"name": basis.design})
    outcomes = folder.outcomes()
    cells = measure_cells(design, outcomes)
    missing = design.n_runs - sum(cell.runs for cell in cells)
    if missing:
        fault = f"'{path}' is not finished: {missing} of {design.n_runs} runs are missing"
        raise ExperimentError(f"{fault}; 'traffic experiment --resume' does them")
    errors = [
        f"cell {outcome.cell}, seed {outcome.seed}: {outcome.error}"
        for outcome in outcomes.values()
        if outcome.error is not None
    ]
    return Experiment(
        path, design, cells, errors, basis.versions, outcomes, tuple(basis.files_sha256)
    )


def _engine(request: ExperimentRequest, basis: Basis) -> AbstractContextManager[Engine]:
    if request.cluster is not None:
        return cluster_at(request.cluster, basis)
    return local_workers(request.workers)

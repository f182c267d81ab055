"""What a user asks to be told about: runs, or an experiment; as document, as table, as page."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic_core import to_json

from traffic.errors import RequestError, ResultError
from traffic.experiments.documents import json_from_experiment
from traffic.experiments.folders import ExperimentFolder
from traffic.experiments.running import Experiment, read_experiment
from traffic.experiments.tables import cell_table
from traffic.reporting.experiments import page_of_experiment
from traffic.reporting.films import film_beside
from traffic.reporting.pages import write_page
from traffic.reporting.runs import page_of_run, page_of_runs
from traffic.results import RunResult, Score, read_result
from traffic.totals import total_score
from traffic.watching import OnProgress

__all__ = ["ExperimentReport", "Report", "RunsReport", "read_report"]

_COUNTS = ("truth", "recognised", "correct", "precision", "recall", "left_out")


@dataclass(frozen=True, slots=True)
class RunsReport:
    """One finished run, or several together.

    Attributes:
        results: By folder.
    """

    results: dict[Path, RunResult]

    @property
    def total(self) -> dict[str, Score]:
        """The scores of all runs together."""
        return total_score(list(self.results.values()))

    def as_json(self) -> str:
        """Return the only result, or all of them with their sum."""
        results = list(self.results.values())
        document = results[0] if len(results) == 1 else {"runs": results, "score": self.total}
        return to_json(document, indent=1).decode()

    def write_csv(self, path: Path) -> None:
        """Write a row for each kind of manoeuvre of each run.

        Raises:
            ResultError: The file cannot be written.
        """
        buffer = io.StringIO()
        table = csv.writer(buffer, lineterminator="\n")
        table.writerow(["run", "kind", *_COUNTS])
        for run, result in self.results.items():
            for kind, score in result.score.items():
                table.writerow([run, kind, *(getattr(score, name) for name in _COUNTS)])
        write_page(buffer.getvalue(), path)

    def write_page(self, path: Path, film: Path | None, on_progress: OnProgress) -> None:
        """Write a web page of one file; of one run with its film, if there is one.

        Args:
            path: The file.
            film: The overlay film; None for the one beside the folder of the run, if any.
            on_progress: Told how many recognitions have been explained, and of how many.

        Raises:
            ResultError: The file cannot be written.
            RequestError: A film is given for several runs, or that of another run.
            FilmReadError: The film cannot be read.
        """
        if len(self.results) > 1:
            if film is not None:
                raise RequestError("--film", "one run only, whose film it is", film)
            write_page(page_of_runs(self.results, self.total), path)
            return
        ((folder, result),) = self.results.items()
        shown = film_beside(folder) if film is None else film
        write_page(page_of_run(folder, result, shown, on_progress), path)


@dataclass(frozen=True, slots=True)
class ExperimentReport:
    """A finished experiment.

    Attributes:
        experiment: The experiment.
    """

    experiment: Experiment

    def as_json(self) -> str:
        """Return the measures of all cells."""
        return json_from_experiment(self.experiment)

    def write_csv(self, path: Path) -> None:
        """Write a row for each cell.

        Raises:
            ResultError: The file cannot be written.
        """
        table = cell_table(self.experiment.design, self.experiment.cells)
        write_page(table.to_csv(index=False), path)

    def write_page(self, path: Path, film: Path | None, on_progress: OnProgress) -> None:
        """Write a web page of one file; it is quick and has no film.

        Raises:
            ResultError: The file cannot be written.
            RequestError: A film is given.
        """
        if film is not None:
            raise RequestError("--film", "a run, not an experiment, with it", film)
        on_progress(1, 1)
        write_page(page_of_experiment(self.experiment), path)


Report = RunsReport | ExperimentReport


def read_report(folders: Sequence[Path]) -> Report:
    """Read finished runs, or a finished experiment.

    Raises:
        ResultError: A folder holds neither, or both kinds are asked for, or several experiments.
        ExperimentError: The experiment is not finished, or its files are damaged.
    """
    experiments = [folder for folder in folders if ExperimentFolder(folder).is_there]
    if not experiments:
        return RunsReport({folder: read_result(folder) for folder in folders})
    if len(folders) > 1:
        fault = f"'{experiments[0]}' is an experiment, which is told about by itself"
        raise ResultError(f"{fault}; 'traffic compare' puts two beside each other")
    return ExperimentReport(read_experiment(experiments[0]))

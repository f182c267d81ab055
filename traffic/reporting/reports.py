"""What a user asks to be told about: runs, or experiments; as document, as table, as page."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic_core import to_json

from traffic.errors import RequestError, ResultError
from traffic.experiments.beside import Beside, put_beside
from traffic.experiments.documents import beside_table, json_from_beside, json_from_findings
from traffic.experiments.findings import (
    Findings,
    holds_experiment,
    named_apart,
    read_experiment_or_table,
)
from traffic.experiments.tables import cell_table
from traffic.reporting.experiments import page_of_experiments
from traffic.reporting.films import film_beside
from traffic.reporting.pages import write_page
from traffic.reporting.runs import page_of_run, page_of_runs
from traffic.results import RunResult, Score, read_result
from traffic.totals import total_score
from traffic.watching import OnProgress

__all__ = ["ExperimentsReport", "Report", "RunsReport", "read_report"]

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
class ExperimentsReport:
    """One finished experiment, or several side by side.

    Attributes:
        sides: The experiments, or tables that stand for them.
    """

    sides: tuple[Findings, ...]

    @property
    def beside(self) -> Beside:
        """The experiments side by side."""
        return put_beside(self.sides)

    def as_json(self) -> str:
        """Return the measures of all cells, of several experiments side by side."""
        if len(self.sides) == 1:
            return json_from_findings(self.sides[0])
        return json_from_beside(self.beside)

    def write_csv(self, path: Path) -> None:
        """Write a row for each cell.

        Raises:
            ResultError: The file cannot be written.
        """
        if len(self.sides) == 1:
            table = cell_table(self.sides[0].measures, self.sides[0].cells)
        else:
            table = beside_table(self.beside)
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
        write_page(page_of_experiments(self.sides), path)


Report = RunsReport | ExperimentsReport


def read_report(paths: Sequence[Path]) -> Report:
    """Read finished runs, or finished experiments and tables that stand for such.

    Raises:
        ResultError: A folder holds neither, or both kinds are asked for, or experiments that do
            not measure the same, or one of them twice.
        ExperimentError: An experiment is not finished, or files are damaged or have faults.
    """
    experiments = [path for path in paths if holds_experiment(path)]
    if not experiments:
        return RunsReport({path: read_result(path) for path in paths})
    others = [path for path in paths if path not in experiments]
    if others:
        told = f"'{experiments[0]}' is an experiment, '{others[0]}' is none"
        raise ResultError(f"expected either runs or experiments: {told}")
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ResultError(f"expected each experiment once, found '{twice}' again")
    sides = named_apart([read_experiment_or_table(path) for path in paths])
    if not put_beside(sides).measures:
        found = "; ".join(f"{', '.join(side.measures)} ({side.name})" for side in sides)
        raise ResultError(f"expected experiments that share a measure, found {found}")
    return ExperimentsReport(tuple(sides))

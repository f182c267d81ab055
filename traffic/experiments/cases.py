"""One run of an experiment: from settings to what was counted."""

import errno
import hashlib
import json
import os
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from traffic.errors import ExperimentError
from traffic.experiments.designs import Cell, Design, Level
from traffic.experiments.measures import Counts
from traffic.request import RunRequest
from traffic.running import run_scenario
from traffic.scenarios import scenario_path

__all__ = ["Case", "Outcome", "cases_of", "request_of", "run_case", "scenario_file", "settings_of"]

_KEY_LENGTH = 32
_SPECIFICATION = "specification"
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


@dataclass(frozen=True, slots=True)
class Case:
    """A run that is to be done.

    Attributes:
        cell: Number of its cell, from 0.
        seed: Of everything random.
        scenario: Name of a bundled scenario, or a path beside *folder*.
        settings: Values by name; `specification` is a path beside *folder*.
        folder: That of the design.
    """

    cell: int
    seed: int
    scenario: str
    settings: Mapping[str, Level]
    folder: Path

    @property
    def key(self) -> str:
        """A hash of all that the run depends on and that the design says."""
        told = [self.scenario, self.seed, sorted(self.settings.items())]
        text = json.dumps(told, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:_KEY_LENGTH]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a case.

    Attributes:
        key: Of the case.
        cell: Of the case.
        seed: Of the case.
        counts: What was counted, by kind of manoeuvre; empty if the run failed.
        error: Why the run failed; None if it did not.
        seconds: How long it took.
    """

    key: str
    cell: int
    seed: int
    counts: Mapping[str, Counts]
    error: str | None = None
    seconds: float = 0.0

    def as_line(self) -> dict[str, Any]:
        """Return the outcome as a line of a journal."""
        return {
            "key": self.key,
            "cell": self.cell,
            "seed": self.seed,
            "counts": {kind: list(counts) for kind, counts in self.counts.items()},
            "error": self.error,
            "seconds": round(self.seconds, 3),
        }

    @classmethod
    def from_line(cls, line: Mapping[str, Any]) -> "Outcome":
        """Return the outcome that a line of a journal holds.

        Raises:
            ValueError: It holds none.
        """
        try:
            counts = {str(kind): Counts(*map(int, c)) for kind, c in line["counts"].items()}
            return cls(
                key=str(line["key"]),
                cell=int(line["cell"]),
                seed=int(line["seed"]),
                counts=counts,
                error=None if line["error"] is None else str(line["error"]),
                seconds=float(line["seconds"]),
            )
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"expected the outcome of a run, found {dict(line)!r}") from error


def cases_of(design: Design) -> Iterator[Case]:
    """Yield all runs of a design, cell by cell."""
    for number, cell in enumerate(design.combinations()):
        settings = settings_of(design, cell)
        scenario = str(settings.pop("scenario", design.scenario or ""))
        for seed in design.seeds:
            yield Case(number, seed, scenario, settings, design.folder)


def settings_of(design: Design, cell: Cell) -> dict[str, Level]:
    """Return all settings of the runs of a cell, also those that do not vary."""
    return {**design.fixed, **cell}


def scenario_file(case: Case) -> Path:
    """Return the file of the scenario of a case.

    Raises:
        ScenarioError: There is none.
    """
    return scenario_path(_scenario(case))


def request_of(case: Case, out: Path) -> RunRequest:
    """Return the request of a case that writes its run to *out*.

    Paths of scenarios and specifications are beside the design.

    Raises:
        TrafficError: A setting is impossible.
    """
    settings = dict(case.settings)
    if _SPECIFICATION in settings:
        settings[_SPECIFICATION] = str(case.folder / str(settings[_SPECIFICATION]))
    return RunRequest.from_settings(_scenario(case), settings, seed=case.seed, out=out)


def run_case(case: Case) -> Outcome:
    """Do a run and return what was counted; an error that ends it becomes part of the answer.

    Raises:
        ExperimentError: There is no room left to write the run, which may be done again later.
    """
    began = time.perf_counter()
    folder = ""
    try:
        with tempfile.TemporaryDirectory(prefix="traffic-") as folder:
            result, _ = run_scenario(request_of(case, Path(folder) / "run"), _ignore)
    except Exception as error:  # whatever it is, it is told, and the others go on
        if _is_for_want_of_room(error):
            place = tempfile.gettempdir()
            fault = f"cannot write a run to '{place}': {os.strerror(errno.ENOSPC)}"
            raise ExperimentError(
                f"{fault}; the runs before are safe, --resume does the others"
            ) from error
        text = f"{type(error).__name__}: {error}"
        if folder:  # its name is another one each time
            text = text.replace(folder, "TEMPORARY")
        return Outcome(case.key, case.cell, case.seed, {}, text, time.perf_counter() - began)
    counts = {
        kind: Counts(score.truth, score.recognised, score.correct)
        for kind, score in result.score.items()
    }
    seconds = time.perf_counter() - began
    return Outcome(case.key, case.cell, case.seed, counts, seconds=seconds)


def _scenario(case: Case) -> str:
    is_file = case.scenario.endswith(".toml")
    return str(case.folder / case.scenario) if is_file else case.scenario


def _is_for_want_of_room(error: BaseException | None) -> bool:
    """Return whether an error came about because a disk is full."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in _FULL:
            return True
        error = error.__cause__ or error.__context__
    return False


def _ignore(_done: float, _total: float) -> None:
    """Tell nobody how far a single run has come."""

"""How long an experiment will take, by how long one of its runs takes here."""

from dataclasses import dataclass

from traffic.experiments.cases import cases_of, run_case
from traffic.experiments.reading import CheckedDesign

__all__ = ["MANY_RUNS", "Estimate", "estimate"]

MANY_RUNS = 100_000
"""An experiment of more runs is not begun before someone has said that it is meant."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """What an experiment will take.

    Attributes:
        runs: How many.
        simulated_seconds: In all runs together.
        seconds: On the clock, if each run takes as long as the one that was tried; None if that
            one failed.
        error: Why it failed.
    """

    runs: int
    simulated_seconds: float
    seconds: float | None
    error: str | None


def estimate(checked: CheckedDesign, workers: int) -> Estimate:
    """Do the first run of a design and tell what all will take on so many *workers*.

    The run is done twice, because the first one of a process also reads all files.
    """
    first = next(cases_of(checked.design))
    outcome = [run_case(first) for _ in range(2)][-1]
    total = checked.design.n_runs
    seconds = outcome.seconds * total / workers if outcome.error is None else None
    return Estimate(total, checked.simulated_seconds, seconds, outcome.error)

"""Experiments as a user asks for them."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import nullcontext
from pathlib import Path

import pytest

from traffic.commands.experiment import experiment
from traffic.experiments.cases import Case, Outcome
from traffic.experiments.measures import Counts

DESIGN = """
scenario = "rural"
runs_per_cell = 3
measures = ["overtake.recall"]
[fixed]
view = "truth"
"""


class Workers:
    """Workers that fail where they are told to."""

    n_workers = 1

    def __init__(self, fails: Callable[[Case], bool]) -> None:
        self._fails = fails

    def outcomes(self, cases: Iterable[Case]) -> Iterator[Outcome]:
        """Yield what becomes of the cases."""
        for case in cases:
            error = "SimulatorError: gave up" if self._fails(case) else None
            counts = {} if error else {"overtake": Counts(1, 1, 1)}
            yield Outcome(case.key, case.cell, case.seed, counts, error)


def work(folder: Path, monkeypatch: pytest.MonkeyPatch, fails: Callable[[Case], bool]) -> None:
    """Do the experiment with workers that fail where they are told to."""
    engine = nullcontext(Workers(fails))
    monkeypatch.setattr("traffic.experiments.running.local_workers", lambda _: engine)
    path = folder / "d.toml"
    path.write_text(DESIGN, encoding="utf-8")
    experiment(str(path), out=folder / "out")


def test_an_experiment_of_which_nothing_worked_has_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit status and the last line say so; the tables are there all the same."""
    with pytest.raises(SystemExit) as stopped:
        work(tmp_path, monkeypatch, lambda _: True)

    assert stopped.value.code == 1
    assert capsys.readouterr().err.endswith("all runs failed, so nothing was measured\n")
    assert (tmp_path / "out" / "cells.csv").is_file()


def test_runs_that_fail_do_not_make_the_others_fail(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """They are told beside what was measured."""
    work(tmp_path, monkeypatch, lambda case: case.seed < 3)

    told = capsys.readouterr()
    assert "seed 2: SimulatorError: gave up" in told.out
    assert "all runs failed" not in told.err

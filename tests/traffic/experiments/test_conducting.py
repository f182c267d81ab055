"""Conducting an experiment: whoever does the runs, and however often it is cut off."""

import random
from collections.abc import Iterable, Iterator
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from traffic.errors import ExperimentError
from traffic.experiments.cases import Case, Outcome
from traffic.experiments.conducting import Progress, conduct
from traffic.experiments.folders import Basis, ExperimentFolder
from traffic.experiments.measures import Counts
from traffic.experiments.reading import read_design

DESIGN = """
scenario = "rural"
runs_per_cell = 3
measures = ["overtake.recall", "overtake.false_alarms"]
[fixed]
view = "truth"
[factors]
position_noise = [0, 4]
stability = [300, "500 ms"]
"""
BASIS = Basis(
    design="d", design_sha256="d", versions={"dyknow-traffic": "1"}, files_sha256={"f": "0"}
)


class Interrupted(Exception):  # noqa: N818, it stands for a signal
    """The coordinator was stopped."""


class Workers:
    """Workers that finish cases in any order and may be stopped."""

    n_workers = 2

    def __init__(self, seed: int, stop_after: int | None = None) -> None:
        self.done: list[str] = []
        self._random = random.Random(seed)
        self._stop_after = stop_after

    def outcomes(self, cases: Iterable[Case]) -> Iterator[Outcome]:
        """Yield what becomes of the cases, in any order."""
        waiting = list(cases)
        self._random.shuffle(waiting)
        for case in waiting:
            if len(self.done) == self._stop_after:
                raise Interrupted
            self.done.append(case.key)
            yield done(case)


def done(case: Case) -> Outcome:
    """Return what a run counts: it follows from the case alone."""
    error = "SimulatorError: gave up" if case.cell == 1 and case.seed == 2 else None
    counts = {"overtake": Counts(3, 2 + case.cell % 2, 2)} if error is None else {}
    return Outcome(case.key, case.cell, case.seed, counts, error, seconds=random.random())


def begun(folder: Path) -> ExperimentFolder:
    """Return the folder of a new experiment."""
    written = folder / "design.toml"
    folder.mkdir()
    written.write_text(DESIGN)
    found = ExperimentFolder(folder / "out")
    found.begin(written, BASIS)
    return found


def ignore(_: Progress) -> None:
    """Tell nobody."""


@settings(
    derandomize=True,
    deadline=None,
    max_examples=20,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.lists(st.integers(0, 5), max_size=4), st.randoms(use_true_random=False))
def test_the_table_is_the_same_however_often_it_is_cut_off(
    tmp_path_factory: pytest.TempPathFactory, stops: list[int], chance: random.Random
) -> None:
    """Stopped anywhere and resumed, with lines cut in two: the same bytes, and no run twice."""
    base = tmp_path_factory.mktemp("e")
    whole, broken = begun(base / "whole"), begun(base / "broken")
    design = read_design(whole.design)
    conduct(design, whole, Workers(1), ignore)
    finished: list[str] = []
    for stop in [*stops, None]:
        workers = Workers(chance.randrange(100), stop)
        try:
            conduct(design, broken, workers, ignore)
        except Interrupted:
            finished += workers.done
            with broken.journal.open("ab") as file:
                file.write(b'{"cell":0,"cou')
        else:
            finished += workers.done
            break

    assert len(finished) == len(set(finished)) == design.n_runs
    assert broken.runs.read_bytes() == whole.runs.read_bytes()
    assert broken.cells.read_bytes() == whole.cells.read_bytes()


def test_a_failed_run_is_in_the_table_and_in_no_measure(tmp_path: Path) -> None:
    """A run that fails does not end the others; its row has its error and no counts."""
    folder = begun(tmp_path / "e")
    progress: list[Progress] = []
    conduct(read_design(folder.design), folder, Workers(1), progress.append)

    runs = pd.read_parquet(folder.runs)
    cells = pd.read_csv(folder.cells)

    assert runs["error"].notna().sum() == 1
    assert runs.loc[runs["error"].notna(), "overtake.truth"].isna().all()
    assert cells["failed"].tolist() == [0, 1, 0, 0]
    assert cells["overtake.recall.trials"].tolist() == [9, 6, 9, 9]
    assert cells["overtake.false_alarms"].tolist() == [0.0, 1.0, 0.0, 1.0]
    assert (progress[-1].done, progress[-1].failed, progress[-1].total) == (12, 1, 12)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"design_sha256": "e"}, "the design is not what it was"),
        ({"versions": {"dyknow-traffic": "2"}}, r"version of dyknow-traffic \(1, here 2\)"),
        ({"files_sha256": {"f": "1"}}, "the file 'f'"),
        ({"files_sha256": {"f": "0", "g": "0"}}, "the file 'g'"),
        ({"format": 2}, "the format of the folder"),
    ],
)
def test_runs_of_two_kinds_are_not_mixed(
    tmp_path: Path, changed: dict[str, object], said: str
) -> None:
    """An experiment is only resumed with what its runs were made with."""
    folder = begun(tmp_path / "e")

    folder.resume(BASIS)
    with pytest.raises(ExperimentError, match=said):
        folder.resume(BASIS.model_copy(update=changed))


def test_a_folder_that_exists_is_not_begun_again(tmp_path: Path) -> None:
    """There is an experiment already: the message says how to go on with it."""
    folder = begun(tmp_path / "e")

    with pytest.raises(ExperimentError, match="--resume"):
        folder.begin(folder.design, BASIS)

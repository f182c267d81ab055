"""One run of an experiment: what becomes of one that cannot be done."""

import errno
import os
from pathlib import Path

import pytest

from traffic.errors import ExperimentError, ResultError
from traffic.experiments import cases
from traffic.experiments.cases import Case, run_case, scenario_file
from traffic.request import RunRequest

CASE = Case(0, 1, "rural", {"view": "truth"}, Path())


def failing(error: BaseException, cause: BaseException | None = None):
    """Return what fails in place of a run, and names its folder."""

    def run(request: RunRequest, _: object) -> None:
        if cause is None:
            raise type(error)(f"{error} in {request.out}")
        raise error from cause

    return run


def test_the_error_of_a_run_is_the_same_each_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder in which it was tried has another name each time; the table must not tell it."""
    monkeypatch.setattr(cases, "run_scenario", failing(ResultError("cannot write")))

    one, other = run_case(CASE), run_case(CASE)

    assert one.error == other.error == "ResultError: cannot write in TEMPORARY/run"
    assert one.counts == {}


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_a_full_disk_is_no_failure_of_the_run(
    monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    """It would be in the table for good, though it may well be done when there is room."""
    full = OSError(number, os.strerror(number))
    monkeypatch.setattr(cases, "run_scenario", failing(ResultError("cannot write"), full))

    with pytest.raises(ExperimentError, match=r"No space left.*--resume does the others"):
        run_case(CASE)


def test_the_file_of_a_scenario_is_found(tmp_path: Path) -> None:
    """A bundled one by name, one of one's own beside the design."""
    mine = Case(0, 1, "mine.toml", {}, tmp_path)

    assert scenario_file(CASE).name == "rural.toml"
    assert scenario_file(mine) == tmp_path / "mine.toml"

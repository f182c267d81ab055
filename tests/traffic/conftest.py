"""A run that has been recorded once, for all tests of recordings and explanations."""

from pathlib import Path
from typing import NamedTuple

import pytest

from tests.support.judging import assert_judged_correct
from traffic.request import RunRequest
from traffic.results import RunResult
from traffic.running import run_scenario


class RecordedRun(NamedTuple):
    """A run, its folder and its recording; not to be changed."""

    path: Path
    result: RunResult
    folder: Path


@pytest.fixture(scope="session")
def recorded_run(tmp_path_factory: pytest.TempPathFactory) -> RecordedRun:
    """Return a run of seven seconds from the simulator's positions, with some noise."""
    place = tmp_path_factory.mktemp("recorded")
    request = RunRequest.from_texts(
        scenario="crossing",
        view="truth",
        duration="7 s",
        position_noise=0.5,
        record=place / "run.mcap",
        out=place / "run",
    )
    result, folder = run_scenario(request, lambda *_: None)
    assert_judged_correct(place / "run.mcap")
    return RecordedRun(place / "run.mcap", result, folder)

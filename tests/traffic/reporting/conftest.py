"""A run that pages are made of, once for all tests."""

from pathlib import Path
from typing import NamedTuple

import pytest

from traffic.request import RunRequest
from traffic.results import RunResult
from traffic.running import run_scenario


class FinishedRun(NamedTuple):
    """A run and its folder; not to be changed."""

    result: RunResult
    folder: Path


@pytest.fixture(scope="session")
def finished_run(tmp_path_factory: pytest.TempPathFactory) -> FinishedRun:
    """Return a run of seven seconds from the simulator's positions, with some noise."""
    place = tmp_path_factory.mktemp("finished")
    request = RunRequest.from_texts(
        scenario="crossing", view="truth", duration="7 s", position_noise=0.5, out=place / "run"
    )
    return FinishedRun(*run_scenario(request, lambda *_: None))

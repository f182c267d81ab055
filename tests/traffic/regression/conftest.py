"""A recorded run that the tests of the regression suite share."""

from pathlib import Path

import pytest

from dyknow.time import SECOND, Duration
from traffic.request import RecordingRequest, RunRequest
from traffic.running import run_scenario


@pytest.fixture(scope="session")
def recorded_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a recorded run: 20 s of the rural road, positions up to 1 m wrong."""
    folder = tmp_path_factory.mktemp("recorded")
    request = RunRequest.from_texts(
        scenario="rural",
        view="truth",
        position_noise=1.0,
        duration="20 s",
        recognise="turns,overtakes",
        out=folder / "run",
        record=folder / "elsewhere.mcap",
    )
    assert request.recording == RecordingRequest(folder / "elsewhere.mcap")
    run_scenario(request, lambda *_: None)
    return folder / "run"


@pytest.fixture(scope="session")
def recording(recorded_run: Path) -> Path:
    """Return the recording of that run."""
    return recorded_run.with_name("elsewhere.mcap")


def seconds(value: float) -> Duration:
    """Return a duration of so many seconds."""
    return Duration(int(value * SECOND))

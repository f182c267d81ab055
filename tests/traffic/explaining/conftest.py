"""Runs that are explained, made once for all tests of explanations."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from dyknow.recordings.recording import Recording
from traffic.explaining.kept import open_kept_run
from traffic.explaining.walking import Walker
from traffic.recording.rebuilding import open_run
from traffic.request import RunRequest
from traffic.results import RunResult
from traffic.running import run_scenario


class ExplainedRun(NamedTuple):
    """A run that was recorded as well, opened; not to be changed."""

    walker: Walker
    recording: Recording


class KeptRun(NamedTuple):
    """A run, its folder and its recording; not to be changed."""

    path: Path
    result: RunResult
    folder: Path


class FilmedRun(NamedTuple):
    """A short run through the cameras, and the recording of its images."""

    walker: Walker
    recording: Path


@pytest.fixture(scope="session")
def kept_run(tmp_path_factory: pytest.TempPathFactory) -> KeptRun:
    """Return seven seconds of the crossing, from the simulator's positions."""
    place = tmp_path_factory.mktemp("kept")
    request = RunRequest.from_texts(
        scenario="crossing",
        view="truth",
        duration="7 s",
        position_noise=0.5,
        record=place / "run.mcap",
        out=place / "run",
    )
    result, folder = run_scenario(request, lambda *_: None)
    return KeptRun(place / "run.mcap", result, folder)


@pytest.fixture(scope="session")
def explained_run(kept_run) -> Iterator[ExplainedRun]:
    """Return the same run, opened."""
    with open_run(kept_run.path) as recording:
        yield ExplainedRun(Walker(open_kept_run(kept_run.folder)), recording)


@pytest.fixture(scope="session")
def filmed_run(tmp_path_factory: pytest.TempPathFactory) -> FilmedRun:
    """Return a second and a half of the crossing, through the cameras."""
    place = tmp_path_factory.mktemp("filmed")
    request = RunRequest.from_texts(
        scenario="crossing",
        duration="1.5 s",
        record=place / "run.mcap",
        record_images=True,
        out=place / "run",
    )
    _, folder = run_scenario(request, lambda *_: None)
    return FilmedRun(Walker(open_kept_run(folder)), place / "run.mcap")

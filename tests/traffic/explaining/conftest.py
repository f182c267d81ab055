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
from traffic.running import run_scenario


class ExplainedRun(NamedTuple):
    """A run that was recorded as well, opened; not to be changed."""

    walker: Walker
    recording: Recording


class FilmedRun(NamedTuple):
    """A short run through the cameras, and the recording of its images."""

    walker: Walker
    recording: Path


@pytest.fixture(scope="session")
def explained_run(recorded_run) -> Iterator[ExplainedRun]:
    """Return the run that all tests of recordings share, opened."""
    with open_run(recorded_run.path) as recording:
        yield ExplainedRun(Walker(open_kept_run(recorded_run.folder)), recording)


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

"""What a user asks of a regression suite."""

import shutil
from pathlib import Path
from typing import Any

import pytest

from dyknow.recordings.errors import RecordingError
from tests.support.regression import piece
from traffic.errors import RequestError
from traffic.regression.making import Addition
from traffic.regression.manifest import Making, read_manifest
from traffic.regression.request import RegressionRequest, Task
from traffic.regression.suite import Entry, bundled_suite

_ONE = {"name": "one", "shows": "x", "scenario": "rural", "seed": 1, "from": "0", "to": "1 s"}


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    """Return a suite of two recordings, of which it says one, and one that is not there."""
    folder = tmp_path / "suite"
    folder.mkdir()
    for name in ("one", "two"):
        (folder / f"{name}.mcap").touch()
    for name in ("one", "three"):
        read_manifest(folder).add(Making.model_validate({**_ONE, "name": name}))
    return folder


def test_all_recordings_are_meant_unless_some_are_named(suite: Path) -> None:
    """Also those that are not there, but should be."""
    texts = RegressionRequest.from_texts

    every = texts(suite=suite)

    assert every.task is Task.REPLAY
    assert [entry.name for entry in every.entries] == ["one", "three", "two"]
    assert [making.name for making in every.makings] == ["one", "three"]
    assert [each.name if each else None for each in every.described] == ["one", "three", None]
    assert every.hints["three"] == "'traffic regress --remake three' makes it anew"
    assert every.hints["two"] == "record its run again, remove it, and add it anew"
    assert texts(suite=suite, names=["two"]).entries == (Entry(suite, "two"),)
    assert texts(suite=suite, tasks=[Task.REMAKE], names=["three"]).makings == every.makings[1:]
    assert texts().manifest.folder == bundled_suite()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"names": ["on"]}, "did you mean 'one'"),
        ({"suite": "nowhere"}, "a folder with recordings"),
        ({"addition": {"--name": "x"}}, "--name: .* only has a meaning with --add"),
        ({"addition": {"--to": "3s"}}, "--to: .* only has a meaning with --add"),
        ({"tasks": [Task.LIST, Task.UPDATE]}, "--update: expected nothing beside --list"),
        ({"tasks": [Task.UPDATE], "changes": {"a": 1}}, "--set: expected nothing beside --update"),
        ({"changes": {"scenario.camera.altitude": 1}}, "runs are over"),
        ({"tasks": [Task.REMAKE], "names": ["two"]}, "says the scenario: one, three, found 'two'"),
        ({"tasks": [Task.ADD], "names": ["one"]}, "no names of recordings beside it"),
        ({"tasks": [Task.ADD], "addition": {"--add": "x"}}, "a name of small letters"),
        ({"tasks": [Task.ADD], "addition": {"--add": "x", "--name": "a/b"}}, "small letters"),
    ],
)
def test_requests_are_checked(suite: Path, options: dict[str, Any], said: str) -> None:
    """Options that have no meaning without others, names that are none, folders that are not."""
    asked = {"suite": suite, **options}
    asked["suite"] = Path(asked["suite"])

    with pytest.raises(RequestError, match=said):
        RegressionRequest.from_texts(**asked)


@pytest.mark.sumo
@pytest.mark.slow
def test_a_recording_is_added_by_its_name_or_that_of_its_run(
    recorded_run: Path, recording: Path, suite: Path, tmp_path: Path
) -> None:
    """The run says where its recording is; it may also lie beside or in the folder."""
    moved = tmp_path / "moved"
    shutil.copytree(recorded_run, moved)
    (moved / "recording.txt").unlink()
    shutil.copy(recording, tmp_path / "moved.mcap")
    within = tmp_path / "within"
    shutil.copytree(moved, within)
    shutil.copy(recording, within / "any.mcap")

    for asked, found in (
        (recording, recording),
        (recorded_run, recording),
        (moved, tmp_path / "moved.mcap"),
        (within, within / "any.mcap"),
    ):
        assert _added(suite, asked, {"--from": "2 s"}) == Addition(
            found, piece(2, 20), Entry(suite, "new")
        )


@pytest.mark.sumo
@pytest.mark.slow
def test_a_run_that_was_not_recorded_cannot_be_added(
    recorded_run: Path, recording: Path, suite: Path, tmp_path: Path
) -> None:
    """The message says how to record one; a recording of another run is none of this one."""
    run = tmp_path / "run"
    shutil.copytree(recorded_run, run)
    (run / "recording.txt").unlink()

    with pytest.raises(RequestError, match=r"--record FILE\.mcap' records a run, found .*of none"):
        _added(suite, run)
    (run / "recording.txt").write_text(f"{tmp_path}/gone.mcap\n")
    with pytest.raises(RequestError, match=r"whose recording '.*gone\.mcap' is gone"):
        _added(suite, run)
    shutil.copy(recording, tmp_path / "run.mcap")
    text = (run / "origin.json").read_text()
    (run / "origin.json").write_text(text.replace('"seed": 1', '"seed": 2'))
    with pytest.raises(RequestError, match="the folder of a recorded one"):
        _added(suite, run)
    with pytest.raises(RequestError, match="the folder of a run"):
        _added(suite, tmp_path)
    with pytest.raises(RecordingError, match="expected a recording"):
        _added(suite, suite / "suite.toml")
    with pytest.raises(RequestError, match="--from: expected a time such as"):
        _added(suite, recording, {"--from": "soon"})


def _added(suite: Path, path: Path, options: dict[str, str] | None = None) -> Addition | None:
    addition = {"--add": path, "--name": "new", **(options or {})}
    return RegressionRequest.from_texts(suite=suite, tasks=[Task.ADD], addition=addition).addition

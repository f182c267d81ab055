"""Replaying recordings, and telling what differs."""

import shutil
from pathlib import Path

import pytest

from dyknow.recordings.recorder import Recorder
from tests.support.regression import entry_of
from traffic.errors import ReplayError, RequestError
from traffic.recording.rebuilding import open_run
from traffic.regression.regressing import System, regress, replayed, update
from traffic.regression.suite import Entry

pytestmark = [pytest.mark.sumo, pytest.mark.slow]


def test_what_is_recognised_otherwise_is_told_as_a_diff(recording: Path, tmp_path: Path) -> None:
    """A line too many and a line that is missing; nothing when all is as expected."""
    entry = entry_of(recording, tmp_path)
    text = entry.read_expected()
    lines = text.splitlines(keepends=True)

    (same,) = regress([entry])
    entry.expected.write_text("".join([*lines[:-1], "  1.0  2.0  flight[car1]\n"]))
    (different,) = regress([entry])
    (changed,) = update([entry])

    assert (same.difference, same.fault) == ((), "")
    assert "overtake[" in text
    assert "-  1.0  2.0  flight[car1]" in different.difference
    assert f"+{lines[-1].rstrip()}" in different.difference
    assert changed.difference == different.difference
    assert entry.read_expected() == text
    (unchanged,) = update([entry])
    assert unchanged.difference == ()
    entry.expected.write_bytes(b"\xff")
    list(update([entry]))
    assert entry.read_expected() == text


def test_recordings_are_replayed_with_other_settings(recording: Path, tmp_path: Path) -> None:
    """Those of parameters and of processes, and other chronicles: what is lost shows."""
    entry = entry_of(recording, tmp_path)
    chronicles = tmp_path / "mine.chronicle"
    chronicles.write_text("attribute a[?x]\nchronicle none[?x] { event(a[?x]:(?, 1), t) }\n")

    for changes in (
        {"position_noise": 40},
        {"overtakes.file": str(chronicles)},
        {"cars.remove_after": 1},
    ):
        (found,) = regress([entry], System.changed(changes))
        assert found.fault == ""
        lost = [line for line in found.difference if line.startswith("-") and "overtake" in line]
        assert bool(lost) is ("cars.remove_after" not in changes)
    with pytest.raises(RequestError, match="a parameter"):
        System.changed({"no_such": 1})


def test_those_that_cannot_be_replayed_do_not_stop_the_others(
    recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each is told with what is wrong and what to do; nothing is missed in silence."""
    whole = entry_of(recording, tmp_path, "whole", 3)
    broken = {
        name: Entry(tmp_path, name)
        for name in ("cut-off", "no-recording", "other-format", "not-there", "unexpected")
    }
    for entry in broken.values():
        entry.expected.write_text(whole.read_expected())
    data = whole.recording.read_bytes()
    broken["cut-off"].recording.write_bytes(data[: len(data) // 2])
    broken["no-recording"].recording.write_text("nothing of the kind")
    with monkeypatch.context() as patch:
        patch.setattr("dyknow.recordings.recorder.FORMAT", "0")
        with Recorder(broken["other-format"].recording, metadata={}):
            pass
    shutil.copy(whole.recording, broken["unexpected"].recording)
    broken["unexpected"].expected.unlink()

    found = list(regress([*broken.values(), whole], hints={"cut-off": "do this"}))

    said = {each.entry.name: each.fault for each in found}
    assert "not all of its run is there: the recording is cut off" in said["cut-off"]
    assert said["cut-off"].endswith("; do this")
    assert "expected a recording in MCAP" in said["no-recording"]
    assert "expected a recording of format 1, found format 0" in said["other-format"]
    assert "there is no" in said["not-there"]
    assert "'traffic regress --update unexpected' writes it" in said["unexpected"]
    assert said["whole"] == ""


def test_a_recording_of_another_version_names_it(recording: Path, tmp_path: Path) -> None:
    """When what it says of its run cannot be understood any more."""
    old = tmp_path / "old.mcap"
    with open_run(recording) as opened:
        metadata = dict(opened.metadata)
    metadata["origin"] = '{"versions": {"dyknow-traffic": "0.0.7"}, "scene": 3}'
    with Recorder(old, metadata=metadata):
        pass

    with pytest.raises(ReplayError, match=r"version 0\.0\.7 of this program wrote it, this is"):
        replayed(old)

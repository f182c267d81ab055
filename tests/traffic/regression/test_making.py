"""Adding recordings to a suite, and making them anew."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from dyknow.recordings.recorder import Recorder
from tests.support.regression import piece
from traffic.errors import RequestError
from traffic.recording.codecs import CODECS
from traffic.recording.rebuilding import describe, open_run, recorded_sources
from traffic.regression import making
from traffic.regression.making import Addition, add, remake
from traffic.regression.manifest import Making, read_manifest
from traffic.regression.suite import Entry

pytestmark = [pytest.mark.sumo, pytest.mark.slow]


@pytest.fixture
def addition(recording: Path, tmp_path: Path) -> Addition:
    """Return a wish to add ten seconds of the run to a suite that is not there yet."""
    entry = Entry(tmp_path / "suite", "overtaking-in-bends")
    return Addition(recording, piece(2, 12), entry, "Trucks in bends.", ("overtakes",))


def test_what_is_added_can_be_made_anew(addition: Addition) -> None:
    """From what the suite says of it: the same samples, and the same is expected."""
    folder = addition.entry.folder

    made = add(addition, read_manifest(folder))

    assert made == Making.model_validate(
        {
            "name": "overtaking-in-bends",
            "shows": "Trucks in bends.",
            "scenario": "rural",
            "seed": 1,
            "settings": {
                "view": "truth",
                "position_noise": 1.0,
                "recognise": "overtakes",
                "duration": "20 s",
            },
            "from": "2 s",
            "to": "12 s",
        }
    )
    assert read_manifest(folder).makings == {made.name: made}
    before = _vehicles(addition.entry)
    assert "overtake[" in addition.entry.read_expected()
    assert "turn" not in addition.entry.read_expected()
    addition.entry.recording.unlink()
    assert list(remake([made], folder)) == [(addition.entry, False)]
    assert _vehicles(addition.entry) == before
    assert [path.name for path in sorted(folder.iterdir())] == [
        "overtaking-in-bends.expected.txt",
        "overtaking-in-bends.mcap",
        "suite.toml",
    ]


def test_a_run_that_no_manifest_can_describe_is_added_without_its_scenario(
    addition: Addition, tmp_path: Path
) -> None:
    """Here one whose scenario has been changed since."""
    folder = tmp_path / "changed"
    folder.mkdir()
    path = folder / "changed.mcap"
    _rewrite_scenario(addition.recording, path)

    made = add(replace(addition, recording=path), read_manifest(addition.entry.folder))

    assert (made.scenario, made.settings, made.shows) == (None, {}, "Trucks in bends.")
    assert read_manifest(addition.entry.folder).makings == {made.name: made}


def test_a_name_is_given_once(addition: Addition) -> None:
    """Whether there is a recording of that name, or the suite only speaks of one."""
    add(addition, read_manifest(addition.entry.folder))
    manifest = read_manifest(addition.entry.folder)

    with pytest.raises(RequestError, match=r"a name that .* does not have"):
        add(addition, manifest)
    addition.entry.recording.unlink()
    with pytest.raises(RequestError, match=r"a name that .* does not have"):
        add(addition, manifest)


def test_what_was_not_recognised_cannot_be_asked_for(addition: Addition) -> None:
    """The run was about turns and overtakes; and there are no such things as others."""
    for name, said in (
        ("weaving", "what .* has: .*recognised_turns"),
        ("weeving", "did you mean"),
    ):
        with pytest.raises(RequestError, match=said):
            add(replace(addition, recognise=(name,)), read_manifest(addition.entry.folder))
    assert not list(addition.entry.folder.iterdir())


def test_a_full_disk_leaves_nothing(addition: Addition, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither a recording nor an expectation nor a line about them, nor a piece of one."""

    def full(*_: object) -> str:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(making, "text_from_result", full)

    with pytest.raises(OSError, match="No space left"):
        add(addition, read_manifest(addition.entry.folder))

    assert not list(addition.entry.folder.iterdir())


def _vehicles(entry: Entry) -> list[object]:
    with open_run(entry.recording) as recording:
        return [
            (sample.valid_time, sample.value.ids.tolist(), sample.value["position"].tolist())
            for sample in recording.samples("vehicles")
        ]


def _rewrite_scenario(recording: Path, path: Path) -> None:
    """Copy a recording; its scenario has another camera."""
    with open_run(recording) as opened:
        metadata = dict(opened.metadata)
        origin = json.loads(metadata["origin"])
        origin["scenario"]["camera"]["altitude"] += 1
        metadata["origin"] = json.dumps(origin)
        with Recorder(path, metadata=metadata, codecs=CODECS) as recorder:
            sources = recorded_sources(opened, describe(opened).specification)
            for label, source in sources.items():
                write = recorder.generator(label)
                for sample in source().samples():
                    write(sample)

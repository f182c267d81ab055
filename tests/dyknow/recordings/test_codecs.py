"""Values of an application are written by codecs."""

from dataclasses import dataclass
from pathlib import Path

import pytest

from dyknow.recordings.codecs import DataclassCodec
from dyknow.recordings.errors import MissingCodecError, UnrecordableValueError
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from tests.support.recorded import sample


@dataclass(frozen=True)
class Place:
    """Where something is."""

    name: str
    beside: "Place | None"


CODEC = DataclassCodec(Place)
HOME = Place("home", Place("field", None))


def record(path: Path, *values: object) -> None:
    """Record a stream with some values."""
    with Recorder(path, metadata={}, codecs=[CODEC]) as recorder:
        tap = recorder.generator("places")
        for at, value in enumerate(values):
            tap(sample(value, at))


def test_values_with_a_codec_come_back(tmp_path: Path) -> None:
    """A codec makes fields of a value, and a value of fields, inside of other values as well."""
    values = [HOME, (HOME, 1), {"a": HOME}, HOME]
    record(tmp_path / "run.mcap", *values)

    with open_recording(tmp_path / "run.mcap", [CODEC]) as recording:
        assert [each.value for each in recording.samples("places")] == values


def test_missing_codec_is_named(tmp_path: Path) -> None:
    """Who reads values without their codec is told which one."""
    record(tmp_path / "run.mcap", HOME)

    with open_recording(tmp_path / "run.mcap") as recording:
        assert recording.streams["places"].count == 1
        with pytest.raises(MissingCodecError, match=r"'places' has values that need .* 'Place'"):
            recording.source("places")


def test_values_without_a_codec_are_refused(tmp_path: Path) -> None:
    """Who records a value that nothing can write is told the stream and the type."""
    with (
        pytest.raises(UnrecordableValueError, match=r"'things' .* values of '.*complex'"),
        Recorder(tmp_path / "run.mcap", metadata={}) as recorder,
    ):
        recorder.generator("things")(sample((1, [1j]), 0))


def test_codecs_take_no_derived_classes() -> None:
    """A value of a derived class is not what would be read again, and is not taken."""

    class Derived(Place):
        pass

    assert CODEC.handles(HOME)
    assert not CODEC.handles(Derived("a", None))

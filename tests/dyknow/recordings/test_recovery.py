"""Recordings that are cut off or damaged anywhere."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from dyknow.recordings.errors import (
    DamagedRecordingError,
    MissingOriginError,
    NotARecordingError,
    RecordingError,
    RecordingExistsError,
    RecordingVersionError,
)
from dyknow.recordings.formats import FORMAT_RECORD, sealed_texts
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import Recording, open_recording
from dyknow.recordings.recovery import recover
from dyknow.recordings.writing import FileWriter
from dyknow.streams.process import Element
from dyknow.streams.table import Table
from tests.support.recorded import sample

Said = dict[str, list[Element]]


def write(path: Path, n: int, chunk_size: int = 600) -> bytes:
    """Record *n* samples of some streams; return the file."""
    with Recorder(path, metadata={"kpl": "source x"}, chunk_size=chunk_size) as recorder:
        x, y, cars = (recorder.generator(label) for label in ("x", "y", "cars"))
        stream = recorder.stream("z/1", "cars")
        for time in range(n):
            x(sample(time / 7, time))
            table = sample(Table("car", [time], {"x": np.full(1, time / 3)}), time)
            cars(table)
            stream(table)
        y(sample("end", n))
        recorder.annotate({"more": "at the end"})
    return path.read_bytes()


def said_in(path: Path) -> Said:
    """Return all that a recording holds."""
    with open_recording(path) as recording:
        return said_of(recording)


def said_of(recording: Recording) -> Said:
    """Return all that a recording holds."""
    said: Said = {topic: [] for topic in sorted(recording.topics)}
    for topic, element in recording.merged(*said):
        said[topic].append(element)
    return said


def is_prefix(part: Said, whole: Said) -> bool:
    """Return whether each stream of *part* is the beginning of that of *whole*."""
    return all(repr(part[topic]) == repr(whole[topic][: len(part[topic])]) for topic in part)


def n_of(said: Said) -> int:
    """Return how many samples there are."""
    return sum(map(len, said.values()))


def test_files_cut_off_anywhere_are_read_and_recovered(tmp_path: Path) -> None:
    """Wherever a file ends, what was said in its whole chunks is read, and recovered."""
    with Recorder(tmp_path / "whole.mcap", metadata={"a": "b"}, chunk_size=60) as recorder:
        x = recorder.generator("x")
        for time in range(9):
            x(sample(float(time), time))
    data = (tmp_path / "whole.mcap").read_bytes()
    whole = said_in(tmp_path / "whole.mcap")
    found = [n_read(tmp_path, data[:size], whole) for size in range(len(data))]

    at_first = next(at for at, n in enumerate(found) if n is not None)
    counts = [n for n in found[at_first:] if n is not None]
    assert len(counts) == len(found) - at_first
    assert counts == sorted(counts)
    assert (counts[0], counts[-1]) == (0, n_of(whole))
    assert len(set(counts)) > 4


def n_read(folder: Path, data: bytes, whole: Said) -> int | None:
    """Return how many samples are read of a file that is cut off; None if that is refused."""
    cut, out = folder / "cut.mcap", folder / "out.mcap"
    cut.write_bytes(data)
    try:
        with open_recording(cut) as recording:
            said = said_of(recording)
    except (NotARecordingError, DamagedRecordingError):
        return None
    assert is_prefix(said, whole)
    if len(data) % 32 == 0:
        report = recover(cut, out)
        assert repr(said_in(out)) == repr(said)
        assert report.n_messages == n_of(said)
        assert not report.is_whole
        out.unlink()
    return n_of(said)


def test_larger_files_cut_off_lose_no_more_than_the_open_chunk(tmp_path: Path) -> None:
    """A chunk is read as soon as it is whole."""
    data = write(tmp_path / "whole.mcap", 800, chunk_size=4096)
    whole = said_in(tmp_path / "whole.mcap")
    cut = tmp_path / "cut.mcap"
    for size in np.random.default_rng(1).integers(1000, len(data), 20).tolist():
        cut.write_bytes(data[:size])

        said = said_in(cut)

        assert is_prefix(said, whole)
        assert n_of(said) > n_of(whole) * (size - 4096) / len(data) - 120


def test_cut_off_file_says_what_is_missing(tmp_path: Path) -> None:
    """A recording that ends too early has a message about it; a whole one has none."""
    data = write(tmp_path / "whole.mcap", 40)
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])

    with open_recording(tmp_path / "cut.mcap") as recording:
        assert "cut.mcap: the recording is cut off" in str(recording.damage)
        assert "whole chunks, up to " in str(recording.damage)
        assert recording.metadata == {"kpl": "source x"}
        assert recording.value("x", sample(0, 3).available_time) == 3 / 7
    with open_recording(tmp_path / "whole.mcap") as recording:
        assert recording.damage is None
        assert recording.metadata == {"kpl": "source x", "more": "at the end"}


def test_no_flipped_byte_goes_unnoticed(tmp_path: Path) -> None:
    """Whatever byte is damaged, what is read is what was written, or an error says otherwise."""
    data = write(tmp_path / "whole.mcap", 2)
    whole = said_in(tmp_path / "whole.mcap")
    damaged = tmp_path / "damaged.mcap"
    errors = 0
    for at in range(0, len(data), 3):
        damaged.write_bytes(data[:at] + bytes([data[at] ^ 1 << at % 8]) + data[at + 1 :])
        try:
            with open_recording(damaged) as recording:
                said = said_of(recording)
                assert recording.metadata == {"kpl": "source x", "more": "at the end"}
        except RecordingError as error:
            errors += str(error).startswith(f"{damaged}: ")
        else:
            assert repr(said) == repr(whole)

    assert errors > len(data) / 12


def test_damaged_chunk_is_named_and_left_out(tmp_path: Path) -> None:
    """An error names the chunk that is damaged; recovery leaves it out and counts what it had."""
    data = bytearray(write(tmp_path / "whole.mcap", 40))
    with (tmp_path / "whole.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunk = summary.chunk_indexes[2]
    data[chunk.chunk_start_offset + chunk.chunk_length - 9] ^= 0xFF
    damaged, out = tmp_path / "damaged.mcap", tmp_path / "out.mcap"
    damaged.write_bytes(data)

    with pytest.raises(DamagedRecordingError, match=r"chunk 3 \(.* is damaged: .*recovered"):
        said_in(damaged)
    report = recover(damaged, out)

    whole, said = said_in(tmp_path / "whole.mcap"), said_in(out)
    assert report.n_messages == n_of(said)
    assert report.n_missing + report.n_messages + report.n_dangling == n_of(whole)
    assert report.n_missing > 0
    assert not report.is_whole
    assert "is left out" in str(report)
    assert f"{report.n_missing} messages missing in between" in str(report)
    with open_recording(out) as recovered:
        assert str(recovered.damage).startswith(f"{out}: recovered from a damaged recording: ")
        assert recovered.gap is not None
        for topic in said:
            before = [each for each in whole[topic] if each.available_time < recovered.gap]
            assert repr(said[topic][: len(before)]) == repr(before)
    for topic, elements in said.items():
        assert set(map(repr, elements)) < set(map(repr, whole[topic])) | {""} or topic == "y"


@pytest.mark.parametrize("at_fault", [0, 1, 4])
def test_recovery_finds_every_chunk_but_the_damaged_one(tmp_path: Path, at_fault: int) -> None:
    """Damage to the record of one chunk, wherever, costs nothing but that chunk."""
    data = write(tmp_path / "whole.mcap", 40)
    with (tmp_path / "whole.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    start = summary.chunk_indexes[at_fault].chunk_start_offset
    for at in range(start, start + 60):
        (tmp_path / "damaged.mcap").write_bytes(data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])

        report = recover(tmp_path / "damaged.mcap", tmp_path / "out.mcap")

        assert report.n_chunks >= len(summary.chunk_indexes) - 1
        said_in(tmp_path / "out.mcap")
        (tmp_path / "out.mcap").unlink()


def test_samples_without_their_values_are_left_out(tmp_path: Path) -> None:
    """A stream cannot be read whose provider's samples are gone; recovery leaves those out."""
    path = tmp_path / "run.mcap"
    with Recorder(path, metadata={}, chunk_size=100) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        value = (1, 2, 3, 4, 5, 6, 7)
        provider(sample(value, 0))
        provider(sample(value + value, 1))
        stream(sample(value, 2))
        provider(sample(1, 3))
    data = bytearray(path.read_bytes())
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    first = summary.chunk_indexes[0]
    data[first.chunk_start_offset + 9 + 24] ^= 1
    path.write_bytes(data)

    report = recover(path, tmp_path / "out.mcap")

    assert report.n_dangling == 1
    assert list(said_in(tmp_path / "out.mcap")["y/1"]) == []


def test_missing_origin_is_an_error(tmp_path: Path) -> None:
    """A reference to a sample that is not in the file names both streams."""
    path, out = tmp_path / "run.mcap", tmp_path / "out.mcap"
    with Recorder(path, metadata={}) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        provider(sample("a", 7))
        stream(sample("a", 7))
    with open_recording(path) as recording, Recorder(out, metadata={}) as copy:
        copy.generator("x")(sample("a", 8))
        (message,) = recording.messages(["y/1"])
    writer = FileWriter(tmp_path / "third.mcap")
    writer.add_metadata(FORMAT_RECORD, sealed_texts({"format": "1"}))
    about = {"dyknow.role": "stream", "dyknow.provider": "x"}
    writer.add_message(writer.add_channel("y/1", ("a", b""), about), 7, message.data, 7, 1)
    about = {"dyknow.role": "generator", "dyknow.layout": "[]"}
    writer.add_channel("x", ("b", b""), about)
    writer.publish()

    with (
        open_recording(tmp_path / "third.mcap") as recording,
        pytest.raises(MissingOriginError, match=r"'y/1' refers to the sample of 'x' .* 7 ns"),
    ):
        list(recording.samples("y/1"))


def test_whole_files_are_copied_as_they_are(tmp_path: Path) -> None:
    """Recovering a whole recording changes nothing, and says so; progress is told."""
    write(tmp_path / "whole.mcap", 40)
    progress: list[float] = []

    report = recover(tmp_path / "whole.mcap", tmp_path / "out.mcap", progress.append)

    assert report.is_whole
    assert repr(said_in(tmp_path / "out.mcap")) == repr(said_in(tmp_path / "whole.mcap"))
    assert progress == sorted(progress)
    assert 0 < progress[0] <= progress[-1] <= 1


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"", "an empty file"),
        (b"\x89PNG\r\n\x1a\n" + bytes(40), "something else"),
        (b"\x89MCAP", "something else"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, content: bytes, found: str) -> None:
    """What is no recording is not read, and nothing is made of it."""
    path = tmp_path / "file"
    path.write_bytes(content)

    with pytest.raises(NotARecordingError, match=f"expected a recording in MCAP, found {found}"):
        open_recording(path)
    with pytest.raises(NotARecordingError, match="expected a recording in MCAP"):
        recover(path, tmp_path / "out.mcap")
    assert list(tmp_path.iterdir()) == [path]


def test_other_formats_are_refused(tmp_path: Path) -> None:
    """A recording of a later format is neither read nor recovered."""
    writer = FileWriter(tmp_path / "run.mcap")
    writer.add_metadata(FORMAT_RECORD, sealed_texts({"format": "2"}))
    writer.publish()

    with pytest.raises(RecordingVersionError, match="format 1, found format 2"):
        open_recording(tmp_path / "run.mcap")
    with pytest.raises(RecordingVersionError, match="format 1, found format 2"):
        recover(tmp_path / "run.mcap", tmp_path / "out.mcap")


def test_recovery_overwrites_nothing(tmp_path: Path) -> None:
    """The file that recovery writes must be new."""
    write(tmp_path / "whole.mcap", 3)

    with pytest.raises(RecordingExistsError):
        recover(tmp_path / "whole.mcap", tmp_path / "whole.mcap")


_KILLED = """
import sys
from pathlib import Path
from dyknow.recordings.recorder import Recorder
from dyknow.streams.sample import Sample
with Recorder(Path(sys.argv[1]), metadata={}, chunk_size=10_000) as recorder:
    tap = recorder.generator("x")
    for time in range(20_000):
        tap(Sample(time / 7, time, time))
    print("there", flush=True)
    sys.stdin.read()
"""


def test_killed_writer_loses_only_the_open_chunk(tmp_path: Path) -> None:
    """After `kill -9` every whole chunk can be recovered."""
    path = tmp_path / "run.mcap"
    with subprocess.Popen(
        [sys.executable, "-c", _KILLED, str(path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])},
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"there\n"
        process.send_signal(signal.SIGKILL)

    assert not path.exists()
    report = recover(tmp_path / "run.mcap.partial", path)

    assert 20_000 - 10_000 // 40 < report.n_messages <= 20_000
    assert [each.value for each in said_in(path)["x"]] == [  # type: ignore[union-attr]
        time / 7 for time in range(report.n_messages)
    ]


def test_a_recovered_recording_says_that_something_is_missing(tmp_path: Path) -> None:
    """Also after it has been recovered again; of a whole recording, nothing is missing."""
    data = write(tmp_path / "whole.mcap", 40)
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) * 2 // 3])

    recover(tmp_path / "cut.mcap", tmp_path / "once.mcap")
    again = recover(tmp_path / "once.mcap", tmp_path / "twice.mcap")
    copied = recover(tmp_path / "whole.mcap", tmp_path / "copy.mcap")

    assert again.is_whole
    assert copied.is_whole
    for name, damaged in (("once", True), ("twice", True), ("copy", False)):
        with open_recording(tmp_path / f"{name}.mcap") as recording:
            assert (recording.damage is not None) == damaged
            assert recording.gap is None

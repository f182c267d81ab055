"""What is written to a recording, and under which name."""

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from foxglove_schemas_protobuf.Log_pb2 import Log
from mcap.reader import make_reader
from mcap.records import Schema

from dyknow.recordings.channels import ChannelRole
from dyknow.recordings.errors import MissingStreamError, RecordingExistsError
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from tests.support.recorded import sample


def cars(n: int) -> Table:
    """Return a table with *n* cars."""
    return Table("car", range(n), {"x": np.arange(n, dtype=float), "moving": np.ones(n, bool)})


def test_file_has_its_name_when_it_is_closed_well(tmp_path: Path) -> None:
    """While a recording is written it is called `.partial`."""
    path = tmp_path / "run.mcap"

    with Recorder(path, metadata={}):
        assert [each.name for each in tmp_path.iterdir()] == ["run.mcap.partial"]

    assert [each.name for each in tmp_path.iterdir()] == ["run.mcap"]


def test_after_an_error_the_file_stays_partial(tmp_path: Path) -> None:
    """What was recorded before an error is kept, under a name that says so, and can be read."""
    path = tmp_path / "run.mcap"

    with suppress(ZeroDivisionError), Recorder(path, metadata={}) as recorder:
        recorder.generator("x")(sample(1.0, 0))
        raise ZeroDivisionError

    assert not path.exists()
    with open_recording(tmp_path / "run.mcap.partial") as recording:
        assert list(recording.samples("x")) == [sample(1.0, 0)]


@pytest.mark.parametrize("name", ["run.mcap", "run.mcap.partial"])
def test_nothing_is_overwritten(tmp_path: Path, name: str) -> None:
    """A recording of the same name, whole or left behind, is not touched."""
    (tmp_path / name).write_text("kept")

    with pytest.raises(RecordingExistsError, match=f"{name}: there is a file"):
        Recorder(tmp_path / "run.mcap", metadata={})

    assert (tmp_path / name).read_text() == "kept"
    assert len(list(tmp_path.iterdir())) == 1


def test_later_texts_replace_earlier_ones(tmp_path: Path) -> None:
    """Texts about the recording can be added as long as it is open."""
    with Recorder(tmp_path / "run.mcap", metadata={"a": "1", "b": "2"}) as recorder:
        recorder.generator("x")(sample(1.0, 0))
        recorder.annotate({"b": "3", "c": "ü\n"})

    with open_recording(tmp_path / "run.mcap") as recording:
        assert recording.metadata == {"a": "1", "b": "3", "c": "ü\n"}


def test_topics_are_unique(tmp_path: Path) -> None:
    """Two streams cannot have one topic."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        recorder.generator("x")
        with pytest.raises(ValueError, match="topic called 'x' already"):
            recorder.stream("x", "x")


def test_streams_without_samples_are_known(tmp_path: Path) -> None:
    """A stream in which nothing has happened is in the recording all the same."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        recorder.generator("x", {"sort": "number"})
        recorder.stream("y/1", "x")

    with open_recording(tmp_path / "run.mcap") as recording:
        x, y = recording.streams.values()
        assert (x.topic, x.about, x.count, x.first) == ("x", {"sort": "number"}, 0, None)
        assert (y.role, y.provider) == (ChannelRole.STREAM, "x")
        assert list(recording.samples("x")) == list(recording.samples("y/1")) == []


def test_further_layouts_have_channels_of_their_own(tmp_path: Path) -> None:
    """Values that do not fit the first schema open a further channel of the topic, once."""
    values = [1.0, "far", 2.0, NO_VALUE, None, "near", 3.0]
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        tap = recorder.generator("x")
        for at, value in enumerate(values):
            tap(sample(value, at))

    with (tmp_path / "run.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    assert [channel.topic for channel in summary.channels.values()] == ["x", "x", "x"]
    with open_recording(tmp_path / "run.mcap") as recording:
        assert [each.value for each in recording.samples("x")] == values
        assert recording.streams["x"].count == len(values)


def test_example_spares_a_further_channel(tmp_path: Path) -> None:
    """With an example the first schema has what the first value lacks."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        tap = recorder.generator("events", example=({"a": 1, "b": "x"},))
        tap(sample((), 0))
        tap(sample(({"a": 2, "b": "y"},), 1))

    with (tmp_path / "run.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    assert len(summary.channels) == 1


def test_values_are_written_once(tmp_path: Path) -> None:
    """A stream refers to the samples of its provider; what it reads is the very same value."""
    table = cars(1000)
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        provider, stream = recorder.generator("cars"), recorder.stream("near/1", "cars")
        provider(sample(table, 0))
        size = recorder.path.with_name("run.mcap.partial").stat().st_size
        for time in range(1, 100):
            stream(sample(table, time))

    assert recorder.path.stat().st_size < size + 16_000
    with open_recording(tmp_path / "run.mcap") as recording:
        found = [value for _, value in recording.merged("near/1")]
        assert len({id(each.value) for each in found if isinstance(each, Sample)}) == 1
        assert len(found) == 99


@pytest.mark.parametrize("stream_first", [True, False])
def test_origin_is_found_whoever_is_called_first(tmp_path: Path, stream_first: bool) -> None:
    """At one instant the stream's tap may be called before the generator's."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        for time in range(3):
            said = sample(1.5, time)
            for tap in (stream, provider) if stream_first else (provider, stream):
                tap(said)

    with open_recording(tmp_path / "run.mcap") as recording:
        origins = [message.data[-8:] for message in recording.messages(["y/1"])]
        assert origins == [time.to_bytes(8, "little") for time in range(3)]
        assert list(recording.samples("y/1")) == list(recording.samples("x"))


def test_made_up_samples_refer_to_the_most_recent_one(tmp_path: Path) -> None:
    """Of several samples with the same value the origin is the last valid one before."""
    value = (1, 2)
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        for time in (10, 20, 40):
            provider(sample(value, time, time + 100))
        stream(sample(value, 30, 200))

    with open_recording(tmp_path / "run.mcap") as recording:
        (message,) = recording.messages(["y/1"])
        assert message.data[-8:] == (120).to_bytes(8, "little")


def test_values_of_nobody_are_written_in_the_stream(tmp_path: Path) -> None:
    """What no sample of the provider has, such as interpolations, stands in the stream itself."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        other = recorder.stream("z/1", "unknown")
        provider(sample(1.0, 0))
        stream(sample(0.5, 1))
        stream(Heartbeat(TimePoint(1), TimePoint(2)))
        provider(sample(2.0, 3))
        stream(sample(NO_VALUE, 4))
        other(sample("a", 5))

    with open_recording(tmp_path / "run.mcap") as recording:
        said = [sample(0.5, 1), Heartbeat(TimePoint(1), TimePoint(2)), sample(NO_VALUE, 4)]
        assert list(recording.contents("y/1")) == said
        assert list(recording.samples("z/1")) == [sample("a", 5)]


def test_old_origins_are_found_wherever_they_are(tmp_path: Path) -> None:
    """A value is referred to for as long as it is remembered, and written again after that."""
    first, others = cars(3), [float(time) for time in range(1, 200)]
    with Recorder(tmp_path / "run.mcap", metadata={}, chunk_size=500) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        provider(sample(first, 0))
        for value in others:
            provider(sample(value, int(value)))
            stream(sample(first, 0, int(value)))

    with open_recording(tmp_path / "run.mcap") as recording:
        found = [each.value for each in recording.samples("y/1")]
        assert all(np.array_equal(value["x"], first["x"]) for value in found)
        assert len(found) == len(others)


def test_duplicated_samples_are_recorded_as_they_are(tmp_path: Path) -> None:
    """A recording is evidence: streams that break the rules are not mended."""
    broken = [sample(1.0, 0, 5), sample(2.0, 0, 5), sample(3.0, 0, 4)]
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        provider, stream = recorder.generator("x"), recorder.stream("y/1", "x")
        for said in broken:
            provider(said)
            stream(said)

    with open_recording(tmp_path / "run.mcap") as recording:
        assert list(recording.samples("x")) == [broken[2], *broken[:2]]
        assert list(recording.samples("y/1")) == [broken[2], *broken[:2]]


def test_views_are_for_viewers_alone(tmp_path: Path) -> None:
    """A view has the schema of its message type, and is no stream."""
    path = tmp_path / "run.mcap"
    with Recorder(path, metadata={}) as recorder:
        view = recorder.view(
            "view/log", Log, lambda each: Log(message=each.value) if each.value else None
        )
        view(sample("seen", 1, 2))
        view(sample("", 3))

    with path.open("rb") as file:
        ((schema, channel, message),) = make_reader(file).iter_messages()
    assert isinstance(schema, Schema)
    assert (channel.topic, schema.name) == ("view/log", "foxglove.Log")
    assert Log.FromString(message.data).message == "seen"
    assert (message.log_time, message.publish_time) == (2, 1)
    with open_recording(path) as recording:
        assert recording.streams["view/log"].role is ChannelRole.VIEW
        assert not recording.topics
        with pytest.raises(MissingStreamError, match="no stream 'view/log'"):
            recording.samples("view/log")

"""Recordings give back what was recorded, and other tools for MCAP can read them."""

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.records import Chunk
from mcap.stream_reader import StreamReader

from dyknow.errors import ValueNotAvailableError
from dyknow.recordings.errors import MissingStreamError
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.process import Element
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from tests.support.recorded import are_identical, sample

TOPICS = ("x", "y[car1]", "z")


@st.composite
def streams(draw: st.DrawFn) -> list[tuple[str, Element]]:
    """Return what several streams have said, in any order between the streams."""
    said: list[tuple[str, Element]] = []
    for topic in TOPICS:
        times = sorted(draw(st.sets(st.integers(-5, 60), max_size=8)))
        for available_time in map(TimePoint, times):
            valid_time = TimePoint(draw(st.integers(-9, available_time)))
            value = draw(st.one_of(st.floats(), st.integers(), st.none(), st.just(NO_VALUE)))
            element: Element = Sample(value, valid_time, available_time)
            if draw(st.booleans()) and draw(st.booleans()):
                element = Heartbeat(valid_time, available_time)
            said.append((topic, element))
    return draw(st.permutations(said))


@settings(derandomize=True, deadline=None, max_examples=40)
@given(streams(), st.sampled_from([30, 200, 100_000]))
def test_streams_come_back_in_order_of_available_time(
    tmp_path_factory: pytest.TempPathFactory, said: list[tuple[str, Element]], chunk_size: int
) -> None:
    """However samples were written, they are read in order; one by one and merged alike."""
    path = tmp_path_factory.mktemp("order") / "run.mcap"
    with Recorder(path, metadata={}, chunk_size=chunk_size) as recorder:
        taps = {topic: recorder.generator(topic) for topic in TOPICS}
        for topic, element in said:
            taps[topic](element)

    with open_recording(path) as recording:
        in_order = sorted((e for _, e in said), key=lambda element: max(0, element.available_time))
        merged = list(recording.merged(*TOPICS))
        assert [max(0, e.available_time) for _, e in merged] == [
            max(0, e.available_time) for e in in_order
        ]
        for topic in TOPICS:
            expected = [e for t, e in said if t == topic]
            expected.sort(key=lambda element: max(0, element.available_time))
            assert _same(list(recording.contents(topic)), expected)
            assert _same([e for t, e in merged if t == topic], expected)
            stream = recording.streams[topic]
            assert stream.count == len(expected)
            times = [max(0, element.available_time) for element in expected]
            extent = (times[0], times[-1]) if times else (None, None)
            assert (stream.first, stream.last) == extent


def _same(found: list[Element], expected: list[Element]) -> bool:
    return len(found) == len(expected) and all(
        type(one) is type(other)
        and one.available_time == other.available_time
        and are_identical(getattr(one, "value", None), getattr(other, "value", None))
        for one, other in zip(found, expected, strict=True)
    )


def test_what_is_not_there_is_named(tmp_path: Path) -> None:
    """Topics and times that were not recorded are told from those that were."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        recorder.generator("speed[car1]")(sample(1.5, 3))

    with open_recording(tmp_path / "run.mcap") as recording:
        assert recording.value("speed[car1]", TimePoint(3)) == 1.5
        with pytest.raises(
            MissingStreamError, match=r"'speed\[car2\]'.*did you mean 'speed\[car1"
        ):
            recording.source("speed[car2]")
        with pytest.raises(ValueNotAvailableError, match="available at 4 ns"):
            recording.value("speed[car1]", TimePoint(4))


def test_replayed_sources_give_the_same_again(tmp_path: Path) -> None:
    """A network that runs on a recorded source receives what was recorded, when it was."""
    said: list[Sample[Any]] = [sample(time / 3, time, 2 * time) for time in range(50)]
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        tap = recorder.generator("x")
        for each in said:
            tap(each)
        tap(Heartbeat(TimePoint(90), TimePoint(100)))
    received: list[Any] = []
    beats: list[Heartbeat] = []

    with open_recording(tmp_path / "run.mcap") as recording:
        kernel = Kernel()
        kernel.add_source(Label("x"), recording.source("x"))
        kernel.subscribe(Label("x"), received.append, beat=beats.append)
        kernel.run()

    assert received == said
    assert beats == [Heartbeat(TimePoint(90), TimePoint(100))]


def write_much(path: Path) -> None:
    """Record some chunks of two streams."""
    noise = np.random.default_rng(1).bytes(120)
    with Recorder(path, metadata={"kpl": "source x"}) as recorder:
        x, cars = recorder.generator("x"), recorder.generator("cars")
        for time in range(4000):
            x(sample((time, noise), time, time + 5))
            if time % 10 == 0:
                cars(sample(Table("car", [time], {"x": np.zeros(1)}), time))


def test_standard_tools_list_a_recording(tmp_path: Path) -> None:
    """The library for MCAP reads summary, statistics, schemas, channels, index and metadata."""
    write_much(tmp_path / "run.mcap")

    with (tmp_path / "run.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert reader.get_header().profile == "dyknow"
        names = {channel.id: channel.topic for channel in summary.channels.values()}
        counts = summary.statistics.channel_message_counts
        assert {names[number]: n for number, n in counts.items()} == {"x": 4000, "cars": 400}
        assert [schema.encoding for schema in summary.schemas.values()] == ["protobuf"] * 2
        assert {schema.name for schema in summary.schemas.values()} == {"dyknow.x", "dyknow.cars"}
        assert len(summary.metadata_indexes) == summary.statistics.metadata_count == 2
        texts = {record.name: record.metadata for record in reader.iter_metadata()}
        assert texts["recording"]["kpl"] == "source x"
        assert texts["dyknow"]["format"] == "1"
        assert summary.attachment_indexes == []
        times = [(m.log_time, m.publish_time) for _, _, m in reader.iter_messages("x")]
        assert times == [(time + 5, time) for time in range(4000)]


def test_chunks_are_compressed_and_of_moderate_size(tmp_path: Path) -> None:
    """Chunks are compressed with zstd, hold 64 to 256 kB, and keep their checksums."""
    write_much(tmp_path / "run.mcap")

    with (tmp_path / "run.mcap").open("rb") as file:
        records = list(StreamReader(file, emit_chunks=True, validate_crcs=True).records)
    chunks = [record for record in records if isinstance(record, Chunk)]
    assert {chunk.compression for chunk in chunks} == {"zstd"}
    assert len(chunks) > 4
    assert all(64_000 < chunk.uncompressed_size < 256_000 for chunk in chunks[:-1])


def test_times_stand_first_in_each_message(tmp_path: Path) -> None:
    """Other programs find both times at fixed places, also those before the beginning."""
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        recorder.generator("x")(sample(1.5, -7, -3))

    with open_recording(tmp_path / "run.mcap") as recording:
        (message,) = recording.messages(["x"])
        assert struct.unpack_from("<BqBqBd", message.data) == (9, -7, 17, -3, 33, 1.5)
        assert list(recording.samples("x")) == [sample(1.5, -7, -3)]

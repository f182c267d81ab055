"""A recorder takes what flows in a network."""

import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from dyknow.errors import NoSuchLabelError
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, build_network
from dyknow.recordings.attaching import Attachment
from dyknow.recordings.comparing import compare
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import Recording, open_recording
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Policy,
    SampleEvery,
)
from dyknow.streams.process import Element, Reactive
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint
from tests.support.recorded import sample

X, Y, Z = Label("x"), Label("y"), Label("z")
EVERY_20 = Policy(change=SampleEvery(Duration(20)))
MOST_RECENT = Policy(
    Approximation.MOST_RECENT, SampleEvery(Duration(15)), Duration(4), TimePoint(0)
)


class Given:
    """A source of given samples."""

    def __init__(self, elements: Sequence[Element]) -> None:
        self._elements = elements

    def samples(self) -> Iterator[Element]:
        """Yield them."""
        yield from self._elements


class Twice(Reactive):
    """A unit that doubles."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Yield twice what the first input has."""
        yield Sample(2.0 * inputs[0].value, inputs[0].valid_time, now)


def numbers(n: int) -> list[Element]:
    """Return samples every 10 nanoseconds, one of them missing and one late, and a heartbeat."""
    said: list[Element] = [sample(time / 7, 10 * time) for time in range(n) if time != 4]
    return [*said, sample(99.5, 5, 10 * n), Heartbeat(TimePoint(500), TimePoint(10 * n + 5))]


def network(source: Any) -> Kernel:
    """Return a network of a source and two units."""
    kernel = Kernel()
    kernel.add_source(X, source)
    kernel.add_unit(Y, Twice(), [(X, EVERY_20)])
    kernel.add_unit(Z, Twice(), [(X, MOST_RECENT), (Y, Policy(max_delay=Duration(0)))])
    return kernel


def record(path: Path, kernel: Kernel, **wanted: Any) -> dict[str, list[Any]]:
    """Run a network while it is recorded; return what subscribers got of its generators."""
    got: dict[str, list[Any]] = {label: [] for label in kernel.labels}
    for label, samples in got.items():
        kernel.subscribe(Label(label), samples.append, beat=samples.append)
    with Recorder(path, metadata={}) as recorder:
        recorder.attach(kernel, **wanted)
        kernel.run()
    return got


def test_every_stream_of_a_network_is_recorded(tmp_path: Path) -> None:
    """Generators are recorded as subscribers see them, and inputs as their processes do."""
    kernel = network(Given(numbers(9)))
    inputs: dict[str, list[Any]] = {}
    for proxy in kernel.streams:
        taken = inputs.setdefault(f"{proxy.receiver}/{proxy.number}", [])
        proxy.tap(taken.append, taken.append)

    got = record(tmp_path / "run.mcap", kernel)

    with open_recording(tmp_path / "run.mcap") as recording:
        assert recording.topics == {*got, *inputs, "violations"}
        for topic, said in {**got, **inputs}.items():
            assert list(recording.contents(topic)) == said
        assert {len(said) > 3 for said in inputs.values()} == {True}


def test_violations_are_recorded_with_what_was_left_out(tmp_path: Path) -> None:
    """Each violation comes back with its reason, and with the sample that it left out."""
    kernel = network(Given(numbers(9)))
    kernel.add_unit(Label("w"), Twice(), [(X, Policy(max_delay=Duration(1)))])
    told: list[StreamViolation] = []
    kernel.subscribe_violations(told.append)

    record(tmp_path / "run.mcap", kernel)

    with open_recording(tmp_path / "run.mcap") as recording:
        found = list(recording.violations())
        assert found == told
        left_out = [each.violation.sample for each in found]
        assert left_out == [each.violation.sample for each in told]
        assert sample(99.5, 5, 90) in left_out
        assert None in left_out


def test_replay_writes_the_same_streams(tmp_path: Path) -> None:
    """The same network on the recorded source makes a recording with the same bytes."""
    record(tmp_path / "run.mcap", network(Given(numbers(30))))

    with open_recording(tmp_path / "run.mcap") as recording:
        record(tmp_path / "again.mcap", network(recording.source("x")))
        with open_recording(tmp_path / "again.mcap") as again:
            assert compare(recording, again) == []


def test_streams_of_other_generators_are_left_out(tmp_path: Path) -> None:
    """Only what is asked for is recorded, and adapted streams with their providers."""
    record(tmp_path / "some.mcap", network(Given(numbers(9))), labels=["y", "z"])
    record(tmp_path / "others.mcap", network(Given(numbers(9))), without=["z"])

    with open_recording(tmp_path / "some.mcap") as recording:
        assert recording.topics == {"y", "z", "z/2", "violations"}
        assert list(recording.violations()) == []
    with open_recording(tmp_path / "others.mcap") as recording:
        assert recording.topics == {"x", "y", "y/1", "z/1", "z/2", "violations"}
    with (
        Recorder(tmp_path / "none.mcap", metadata={}) as recorder,
        pytest.raises(NoSuchLabelError, match="'yy'"),
    ):
        recorder.attach(network(Given([])), ["yy"])


def test_replaced_policies_and_new_processes_are_followed(tmp_path: Path) -> None:
    """What changes while a network runs is recorded as its processes see it."""
    kernel = network(Given(numbers(12)))
    taken: list[Any] = []
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        attachment: Attachment = recorder.attach(kernel)
        (stream,) = (proxy for proxy in kernel.streams if proxy.receiver == Y)
        stream.tap(taken.append, taken.append)
        kernel.run(TimePoint(45))
        stream.replace_policy(Policy(change=ANY_CHANGE))
        kernel.add_unit(Label("w"), Twice(), [(Y, Policy())])
        attachment.refresh()
        kernel.run()

    with open_recording(tmp_path / "run.mcap") as recording:
        assert list(recording.contents("y/1")) == taken
        assert [each.valid_time for each in recording.samples("w/1")][:3] == [50, 60, 70]
        assert recording.streams["w"].count > 3


def test_nothing_is_taken_after_the_end(tmp_path: Path) -> None:
    """A network goes on without the recorder when that is closed."""
    kernel = network(Given(numbers(12)))
    with Recorder(tmp_path / "run.mcap", metadata={}) as recorder:
        recorder.attach(kernel)
        kernel.run(TimePoint(30))

    kernel.run()

    with open_recording(tmp_path / "run.mcap") as recording:
        assert [each.valid_time for each in recording.samples("x")] == [0, 10, 20, 30]


_KPL = """
source number x
compunit number Twice(number)
strmgen x = x
strmgen y = Twice(x with any change)
stream doubled = y with max delay 1 s
"""


def declared(recording_folder: Path) -> Recording:
    """Record a network that was made from a specification."""
    implementations = Implementations({"x": lambda: Given(numbers(9))}, {"Twice": Twice})
    made = build_network(parse_specification(_KPL), implementations)
    with Recorder(recording_folder / "run.mcap", metadata={"kpl": _KPL}) as recorder:
        recorder.attach(made)
        made.kernel.run()
    return open_recording(recording_folder / "run.mcap")


def test_declared_networks_are_described(tmp_path: Path) -> None:
    """Outputs are recorded by name; policies and processes stand beside the streams."""
    with declared(tmp_path) as recording:
        assert recording.topics == {"x", "y", "y/1", "output/doubled", "violations"}
        assert recording.streams["y/1"].about["policy"] == "any change"
        assert "Twice(x" in recording.streams["y"].about["process"]
        assert recording.streams["output/doubled"].provider == "y"
        description = json.loads(recording.metadata["network"])
        assert [each["label"] for each in description["generators"]] == ["x", "y"]
        assert list(recording.samples("output/doubled")) == list(recording.samples("y"))

"""A recording tells of its network what the network would have told of itself."""

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.inspection.snapshot import Snapshot
from dyknow.inspection.taking import snapshot
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, build_network
from dyknow.recordings.recorder import Recorder
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import TimePoint
from tests.support.policies import streams
from tests.support.streams import GivenSource, ms, stream
from traffic.errors import ResultError
from traffic.inspecting.recorded import network_from_recording

POLICIES = (
    "strict order",
    "sample every 20, max delay 50",
    "max delay 30, monotone order",
    "sample every 10, use most recent, max delay 20, from 0 to oo",
    "any change",
)
SAMPLES = stream("0:a 100:b@150 50:c@300 400:d")


class Copy(Reactive):
    """Emits its input again."""

    def push(self, now, inputs):
        """Emit the input."""
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]


def recorded(path: Path, samples: list, first: str, second: str) -> Snapshot:
    """Run a network while it is recorded to *path*, and return what it tells of itself."""
    text = f"""
    source any src
    compunit any Copy(any)
    strmgen given = src
    strmgen copy = Copy(given with {first})
    stream copies = copy
    stream direct = given with {second}
    """
    implementations = Implementations(
        sources={"src": lambda: GivenSource(samples)}, units={"Copy": Copy}
    )
    network = build_network(parse_specification(text), implementations)
    with Recorder(path, metadata={}) as recorder:
        recorder.attach(network)
        network.kernel.run()
        return snapshot(network)


@settings(derandomize=True, deadline=None, max_examples=15)
@given(streams(), st.sampled_from(POLICIES), st.sampled_from(POLICIES))
def test_a_recording_knows_what_its_network_knew(samples, first, second):
    """Streams with all their figures, and processes but for their cost, are the same."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "run.mcap"
        live = recorded(path, samples, first, second)

        found, missing = network_from_recording(path)

    assert missing is None
    alike = {each.name: each for each in live.streams}
    assert {each.name for each in found.streams} == alike.keys()
    for each in found.streams:
        assert replace(each, delay_99=None) == replace(alike[each.name], delay_99=None)
        # The network counts the delays of all its streams together, in wider bins.
        assert (each.delay_99 or 0) <= (alike[each.name].delay_99 or 0) + ms(1)
    assert found.outputs == live.outputs
    assert found.processes == tuple(
        replace(each, calls=None, seconds=None, cached=0, cache_limit=None)
        for each in live.processes
    )


def test_heartbeats_are_no_samples(tmp_path):
    """A heartbeat is counted as one, and not as a sample."""
    path = tmp_path / "run.mcap"
    recorded(path, [*SAMPLES, Heartbeat(TimePoint(ms(500)), ms(600))], "any order", "any order")

    found, _ = network_from_recording(path)

    assert (found.processes[0].samples, found.processes[0].heartbeats) == (4, 1)


def test_what_is_cut_off_is_told(tmp_path):
    """Of a recording that is cut off, what is whole is counted, and what is missing is told."""
    path, cut = tmp_path / "run.mcap", tmp_path / "cut.mcap"
    recorded(path, SAMPLES, "any order", "any order")
    content = path.read_bytes()
    cut.write_bytes(content[: len(content) - 40])

    found, missing = network_from_recording(cut)

    assert missing is not None
    assert [each.samples for each in found.processes] == [4, 4]


def test_a_recording_without_a_network_is_refused(tmp_path):
    """A recording that does not say what its network was is refused."""
    path = tmp_path / "run.mcap"
    with Recorder(path, metadata={"something": json.dumps({})}):
        pass

    with pytest.raises(ResultError, match="says what its network was"):
        network_from_recording(path)

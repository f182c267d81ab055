"""The system of a run again, from its recording."""

import pytest

from dyknow.streams.values import are_equal
from dyknow.time import SECOND, TimePoint
from traffic.errors import ReplayError
from traffic.recording.describing import RunDescription
from traffic.recording.rebuilding import describe, open_run, recorded_labels, system_of, world_of
from traffic.sumo.replayed import TRUTH
from traffic.system import implementations_of


@pytest.mark.sumo
def test_a_recording_says_what_it_was_made_from(recorded_run):
    """Specification as written, parameters, outputs, origin; it goes to the end."""
    with open_run(recorded_run.path) as recording:
        said = describe(recording)

    assert said.is_complete
    assert said.parameters == {
        "view": "truth",
        "sample_period": 100.0,
        "position_noise": 0.5,
        "longest_frame_period": 40.0,
    }
    assert said.outputs[:4] == ("percepts", "cars", "recognised_turns", "recognised_overtakes")
    assert said.origin.scenario.name == "crossing"
    assert said.named_text[0] == "monitoring.kpl"
    assert RunDescription.from_metadata(said.as_metadata(), recorded_run.path) != said
    assert said.text == (recorded_run.folder / "specification" / "monitoring.kpl").read_text()


@pytest.mark.sumo
def test_units_made_again_draw_the_same_random_numbers(recorded_run):
    """A noisy unit of a new world does again what was recorded."""
    with open_run(recorded_run.path) as recording:
        unit = implementations_of(world_of(recording)).units["NoisyPositions"](error=0.5)
        pairs = zip(
            recording.samples("vehicles"), recording.samples("percepts[truth]"), strict=True
        )
        for given, recorded in pairs:
            (made,) = unit.push(given.available_time, (given,))
            assert are_equal(made.value, recorded.value)


@pytest.mark.sumo
def test_the_system_of_a_recording_is_fed_with_it(recorded_run):
    """It makes the same cars as were recorded."""
    with open_run(recorded_run.path) as recording:
        system = system_of(recording)
        cars = []
        system.network.subscribe("cars", cars.append)
        system.network.kernel.run(TimePoint(2 * SECOND))
        recorded = [s for s in recording.samples("cars") if s.available_time <= 2 * SECOND]

    assert len(cars) == len(recorded) == 21
    assert all(are_equal(a.value, b.value) for a, b in zip(cars, recorded, strict=True))


@pytest.mark.sumo
def test_the_truth_is_no_label(recorded_run):
    """What could be taken as a source does not have it."""
    with open_run(recorded_run.path) as recording:
        labels = recorded_labels(recording)

    assert TRUTH not in labels
    assert {"vehicles", "cars", "turns"} <= set(labels)


@pytest.mark.parametrize(
    ("metadata", "message"),
    [
        ({}, "expected a recording of 'traffic run', found one without 'specification'"),
        ({"specification": ""}, "found one without 'origin'"),
        ({"specification": "", "origin": "{}"}, "what it says of its run cannot be read"),
    ],
)
def test_recordings_of_something_else_are_refused(metadata, message, tmp_path):
    """Which are perhaps recordings of another application of the library."""
    with pytest.raises(ReplayError, match=message):
        RunDescription.from_metadata(metadata, tmp_path / "x.mcap")

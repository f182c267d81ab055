"""Everything that flows in the application comes back from a recording as it was."""

import math
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event, Recognition
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import MILLISECOND, TimePoint
from networks.reading import read_road_map
from perception.camera import Calibration, Camera
from traffic.bundled import data_folder
from traffic.recording.codecs import CODECS
from traffic.sumo.recorded import RecordedSimulation
from traffic.system import MonitoringSystem, image_labels
from traffic.world import World

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"
FINITE = st.floats(-1e6, 1e6)
TIMES = st.integers(-(2**62), 2**62)
EVENTS = st.builds(
    Event,
    attribute=st.text(max_size=5),
    arguments=st.lists(st.text(max_size=5), max_size=3).map(tuple),
    from_value=st.none() | st.text(max_size=5),
    to_value=st.none() | st.text(max_size=5),
    time=TIMES,
)
RECOGNITIONS = st.builds(
    Recognition,
    chronicle=st.text(max_size=5),
    arguments=st.dictionaries(st.text(max_size=3), st.text(max_size=5), max_size=3),
    instants=st.dictionaries(st.text(max_size=3), TIMES, max_size=3),
    events=st.lists(EVENTS, max_size=3).map(tuple),
    begin=TIMES,
    end=TIMES,
    recognised_at=TIMES,
)
CAMERAS = st.builds(
    Camera,
    position=st.tuples(FINITE, FINITE, st.floats(1, 1e3)),
    heading=st.floats(-4, 4),
    pitch=st.floats(1.3, 1.5),
    calibration=st.builds(
        Calibration,
        width=st.integers(1, 100),
        height=st.integers(1, 100),
        focal_length_px=st.floats(1e3, 1e4),
        centre_px=st.tuples(st.floats(0, 99), st.floats(0, 99)),
    ),
)
VALUES = st.one_of(
    st.lists(EVENTS, max_size=3).map(tuple), st.lists(RECOGNITIONS, max_size=3).map(tuple), CAMERAS
)


class Car:
    """A car that drives north over the crossing, and turns."""

    def samples(self):
        """Yield it as the simulator would."""
        rows = "t,vehicle,x,y,heading,speed,length,width\n" + "\n".join(
            f"{t},a,{2 + t / 400 * (t > 4000):.3f},{-40 + t / 125:.3f},{math.pi / 2},8,4.5,1.8"
            for t in range(0, 8000, 100)
        )
        with TemporaryDirectory() as folder:
            path = Path(folder) / "r.csv"
            path.write_text(rows)
            simulation = RecordedSimulation(path)
        while (frame := simulation.step()) is not None:
            yield Sample(frame.vehicles, frame.time, frame.time)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(VALUES, min_size=1, max_size=4))
def test_values_of_the_application_come_back(values):
    """Whatever comes after what: events, recognitions and cameras, with every field."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "x.mcap"
        with Recorder(path, metadata={}, codecs=CODECS) as recorder:
            tap = recorder.generator("x")
            for at, value in enumerate(values):
                tap(Sample(value, TimePoint(at), TimePoint(at)))
        with open_recording(path, CODECS) as recording:
            found = [sample.value for sample in recording.samples("x")]

    assert found == values
    assert [type(value) for value in found] == [type(value) for value in values]


@pytest.mark.parametrize("view", ["truth", "vision"])
def test_every_label_of_the_specification_comes_back(view, tmp_path):
    """Each value of each stream generator but those of images, to the last bit and type."""
    calibration = Calibration.from_field_of_view(width=160, height=90, horizontal=1.0)
    camera = Camera.looking_at(0.0, 0.0, 90.0, heading=0.0, calibration=calibration)
    world = World(read_road_map(CROSSING), Car(), camera, np.random.Generator(np.random.PCG64(1)))
    parameters = {"view": view, "sample_period": 100.0, "position_noise": 0.5}
    system = MonitoringSystem(world, parameters, ("recognised_turns", "recognised_overtakes"))
    kernel = system.network.kernel
    images = image_labels(system.specification)
    labels = [label for label in kernel.labels if label not in images]
    given = {label: [] for label in labels}
    with Recorder(tmp_path / "x.mcap", metadata={}, codecs=CODECS) as recorder:
        for label in labels:
            kernel.subscribe(label, recorder.generator(label))
            kernel.subscribe(label, given[label].append)
        kernel.run(TimePoint((7_900 if view == "truth" else 400) * MILLISECOND))

    with open_recording(tmp_path / "x.mcap", CODECS) as recording:
        for label, samples in given.items():
            found = list(recording.samples(label))
            assert [(s.valid_time, s.available_time) for s in found] == [
                (s.valid_time, s.available_time) for s in samples
            ]
            assert all(
                are_equal(one.value, other.value)
                for one, other in zip(found, samples, strict=True)
            )
    assert given["link_turns"]
    if view == "truth":
        assert any(sample.value for sample in given["car_changes"])
    else:
        assert given["camera_pose"]

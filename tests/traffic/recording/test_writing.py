"""What a run writes while it is recorded."""

import pytest
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from mcap.reader import make_reader

from dyknow.recordings.channels import ChannelRole
from dyknow.time import MILLISECOND, TimePoint
from networks.reading import read_road_map
from tests.support.judging import assert_judged_correct
from traffic.bundled import data_folder
from traffic.errors import RequestError
from traffic.origin import origin_of
from traffic.recording.describing import RunDescription
from traffic.recording.rebuilding import describe, open_run
from traffic.recording.writing import recorded
from traffic.request import RecordingRequest, RunRequest
from traffic.sumo.replayed import TRUTH
from traffic.system import MonitoringSystem, bundled_specification
from traffic.world import World, camera_of, generators_of

CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"
VISION = {
    "vehicles", "signals[truth]", "camera_pose", "percepts[vision]", "world_objects",
    "on_road_objects", "cars",
}  # fmt: skip


class NoVehicles:
    """An empty road."""

    def samples(self):
        """Yield nothing."""
        return iter(())


@pytest.fixture
def write(tmp_path):
    """Return a function that records a system with cameras, and returns the path."""

    def write(streams=None, *, images=False, fails=False):
        asked = RunRequest.from_texts(scenario="crossing", duration="200 ms")
        road_map = read_road_map(CROSSING)
        _, sensors = generators_of(asked.seed)
        camera = camera_of(asked.scenario.camera, road_map)
        world = World(road_map, NoVehicles(), camera, sensors)
        parameters = {"view": "vision", "sample_period": 100.0}
        system = MonitoringSystem(world, parameters, ("percepts", "cars"))
        description = RunDescription(
            origin=origin_of(asked),
            text=bundled_specification().read_text("utf-8"),
            place="monitoring.kpl",
            parameters=parameters,
            outputs=("percepts", "cars"),
        )
        request = RecordingRequest(tmp_path / "x.mcap", streams, images)
        with recorded(request, description, system, road_map, None):
            system.network.kernel.run(TimePoint(200 * MILLISECOND))
            if fails:
                raise ZeroDivisionError
        assert_judged_correct(request.path)
        return request.path

    return write


def roles(path):
    """Return the topics by their roles."""
    with open_run(path) as recording:
        found = {role: set() for role in ChannelRole}
        for topic, stream in recording.streams.items():
            found[stream.role].add(topic)
        return found


def test_every_stream_but_images_is_recorded(write):
    """Generators, inputs, outputs and views; nothing of images, or of states of images."""
    path = write()

    found = roles(path)
    assert found[ChannelRole.GENERATOR] == VISION
    assert {"world_objects/1", "cars/1", "output/cars"} <= found[ChannelRole.STREAM]
    views = {"view/cars", "view/map", "view/camera_pose", "view/camera_pose/transform"}
    assert found[ChannelRole.VIEW] == views
    with open_run(path) as recording:
        assert {recording.streams[each].provider for each in found[ChannelRole.STREAM]} <= VISION


def test_only_named_streams_are_recorded(write):
    """And the map, and views of what is named."""
    found = roles(write(("cars", "percepts[vision]")))

    assert found[ChannelRole.GENERATOR] == {"cars", "percepts[vision]"}
    assert found[ChannelRole.VIEW] == {"view/cars", "view/map"}


@pytest.mark.parametrize(
    ("streams", "images", "shown"),
    [
        (None, True, {"view/colour_images", "view/thermal_images"}),
        (("cars",), True, {"view/colour_images", "view/thermal_images"}),
        (("cars", "thermal_images"), False, {"view/thermal_images"}),
    ],
)
def test_images_are_views_that_say_that_they_are_lossy(streams, images, shown, write):
    """They are there when they were asked for, as JPEG; never as streams."""
    path = write(streams, images=images)

    found = roles(path)
    assert {topic for topic in found[ChannelRole.VIEW] if "image" in topic} == shown
    assert not any("image" in topic for topic in found[ChannelRole.GENERATOR])
    with open_run(path) as recording:
        assert all("lossy: JPEG" in recording.streams[topic].about["about"] for topic in shown)
        assert {recording.streams[topic].schema for topic in shown} == {
            CompressedImage.DESCRIPTOR.full_name
        }


@pytest.mark.parametrize(
    ("streams", "message"),
    [
        (("carz",), r"--streams: expected labels of this run, which has .*did you mean 'cars'\?"),
        (("sync(colour_images, thermal_images)",), "--streams: expected labels of streams, or of"),
    ],
)
def test_what_cannot_be_recorded_is_refused(streams, message, write, tmp_path):
    """Before anything is written."""
    with pytest.raises(RequestError, match=message):
        write(streams)

    assert list(tmp_path.iterdir()) == []


def test_standard_tools_read_the_views(write):
    """The library for MCAP finds the schema by its name, and the map at time 0."""
    with write().open("rb") as file:
        messages = list(make_reader(file).iter_messages(["view/map"]))

    ((schema, _, message),) = messages
    assert schema is not None
    assert (schema.name, schema.encoding) == ("foxglove.SceneUpdate", "protobuf")
    assert message.log_time == 0
    assert len(SceneUpdate.FromString(message.data).entities) == 2


def test_what_fails_stays_partial_and_says_so(write, tmp_path):
    """What was recorded is kept under another name, and does not look complete."""
    with pytest.raises(ZeroDivisionError):
        write(fails=True)

    (path,) = tmp_path.iterdir()
    assert path.name == "x.mcap.partial"
    with open_run(path) as recording:
        assert not describe(recording).is_complete


@pytest.mark.sumo
def test_the_truth_stands_beside_the_streams(recorded_run):
    """With lanes and names, which no stream of the network has."""
    with open_run(recorded_run.path) as recording:
        frames = list(recording.samples(TRUTH))
        labels = recording.topics - {TRUTH, "dyknow/violations"}
        first = {label: next(recording.samples(label), None) for label in labels}

    assert len(frames) == 71
    table, names, lanes, signals = frames[0].value
    assert {"lane", "lane_position", "position"} <= set(table.columns)
    assert names
    assert lanes
    assert len(signals) == 8  # the lanes that lead to the middle of the town
    for sample in first.values():
        assert "lane_position" not in getattr(getattr(sample, "value", None), "columns", {})

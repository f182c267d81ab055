"""Writes a run to a file while it goes on."""

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PoseInFrame_pb2 import PoseInFrame
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.message import Message

from dyknow.kpl.plan import Network
from dyknow.recordings.recorder import Recorder
from dyknow.runtime.generators import Label
from dyknow.source_text import nearest_name
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from networks.roads import RoadMap
from traffic.errors import RequestError
from traffic.recording.codecs import CODECS
from traffic.recording.describing import COMPLETE, RunDescription
from traffic.recording.views import (
    CarScenes,
    image_view,
    log_of_recognitions,
    pose_of_camera,
    scene_of_map,
    transform_of_camera,
)
from traffic.request import RecordingRequest
from traffic.sumo.replayed import TRUTH, FrameKeeper
from traffic.sumo.simulation import Frame, Simulation
from traffic.system import IMAGE_SORTS, MonitoringSystem, image_labels, labels_of_sort

__all__ = ["recorded"]

_RECORDER = Label("recorder")
_TRUTH_IS = "the truth, for scoring alone: no process may take it"

Observe = Callable[[Frame], None]
"""Takes the frames of a simulation."""


@contextmanager
def recorded(
    request: RecordingRequest,
    description: RunDescription,
    system: MonitoringSystem,
    road_map: RoadMap,
    simulation: Simulation | None,
) -> Iterator[Observe]:
    """Record what *system* does while the block lasts; give what is to be shown each frame.

    The truth is recorded too, if there is a *simulation* that knows it.

    The file has its name when the block has ended well; until then, and after an error, it is
    called `….partial`.

    Raises:
        RequestError: A stream that is wanted is not part of the system.
        RecordingError: There is a file of this name.
    """
    labels, images = _wanted(request, system)
    with Recorder(request.path, metadata=description.as_metadata(), codecs=CODECS) as recorder:
        recorder.attach(system.network, labels)
        views = _Views(recorder, system.network)
        for label in images:
            views.add(label, "", CompressedImage, image_view)
        _add_scenes(views, system, set(labels))
        show_map = recorder.view(
            "view/map", SceneUpdate, lambda sample: scene_of_map(sample.value)
        )
        show_map(Sample(road_map, TimePoint(0), TimePoint(0)))
        yield _keeping(recorder, simulation)
        recorder.annotate(COMPLETE)


def _keeping(recorder: Recorder, simulation: Simulation | None) -> Observe:
    """Return what records the frames of a simulation, if there is one."""
    if simulation is None:
        return lambda _: None
    truth = recorder.generator(TRUTH, {"about": _TRUTH_IS})
    keeper = FrameKeeper(simulation)
    return lambda frame: truth(keeper.sample(frame))


def _wanted(request: RecordingRequest, system: MonitoringSystem) -> tuple[list[str], list[str]]:
    """Return the labels of the streams to be recorded, and of the images to be looked at."""
    built = [str(label) for label in system.network.kernel.labels]
    asked = built if request.streams is None else list(request.streams)
    for label in asked:
        if label not in built:
            raise RequestError("--streams", _expected(label, built), label)
    of_images = image_labels(system.specification)
    exact = [label for label in asked if label not in of_images]
    single = [
        label for label in labels_of_sort(system.specification, *IMAGE_SORTS) if label in built
    ]
    if request.images:
        return exact, single
    if request.streams is None:
        return exact, []
    for label in asked:
        if label in of_images and label not in single:
            raise RequestError("--streams", "labels of streams, or of single images", label)
    return exact, [label for label in single if label in asked]


def _expected(label: str, built: Sequence[str]) -> str:
    nearest = nearest_name(label, built)
    hint = f"; did you mean '{nearest}'?" if nearest else ""
    return f"labels of this run, which has {', '.join(built)}{hint}"


def _add_scenes(views: "_Views", system: MonitoringSystem, labels: Collection[str]) -> None:
    """Let viewers see the cameras, the cars and what was recognised, as far as is recorded."""
    specification = system.specification
    for label in labels_of_sort(specification, "camera_pose"):
        if label in labels:
            views.add(label, "", PoseInFrame, pose_of_camera)
            views.add(label, "/transform", FrameTransform, transform_of_camera)
    if "cars" in labels_of_sort(specification, "cars") and "cars" in labels:
        views.add("cars", "", SceneUpdate, CarScenes().scene)
    for label in labels_of_sort(specification, "recognitions"):
        if label in labels:
            views.add(label, "", Log, log_of_recognitions)


class _Views:
    """Makes views of the streams of a network."""

    def __init__(self, recorder: Recorder, network: Network) -> None:
        self._recorder = recorder
        self._kernel = network.kernel

    def add(
        self,
        label: str,
        part: str,
        kind: type[Message],
        convert: Callable[[Sample[Any]], Message | None],
    ) -> None:
        """Let viewers see what *convert* makes of each sample of *label*."""
        show = self._recorder.view(f"view/{label}{part}", kind, convert)
        self._kernel.subscribe(Label(label), show, name=_RECORDER)

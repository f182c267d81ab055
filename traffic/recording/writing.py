"""Writes a run to a file while it goes on."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
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
from dyknow.service.governor import PeriodChange
from dyknow.source_text import did_you_mean, nearest_name
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from networks.roads import RoadMap
from traffic.errors import RequestError
from traffic.recording.codecs import CODECS
from traffic.recording.describing import COMPLETE, RunDescription, metadata_of_periods
from traffic.recording.views import (
    JPEG_QUALITY,
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
from traffic.system import (
    IMAGE_SORTS,
    MonitoringSystem,
    image_labels,
    labels_of_sort,
    sort_of,
)

__all__ = ["RunRecorder", "recorded"]

_RECORDER = Label("recorder")
_LOSSY = {"about": f"lossy: JPEG of quality {JPEG_QUALITY}, to be looked at; not for a replay"}
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
) -> Iterator["RunRecorder"]:
    """Record what *system* does while the block lasts; give what else is to be told of the run.

    The truth is recorded too, if there is a *simulation* that knows it.

    The file has its name when the block has ended well; until then, and after an error, it is
    called `….partial`.

    Raises:
        RequestError: A stream that is wanted is not part of the system.
        RecordingError: There is a file of this name.
    """
    wanted = _wanted(request, system)
    with Recorder(request.path, metadata=description.as_metadata(), codecs=CODECS) as recorder:
        recorder.attach(system.network, wanted.labels, wanted.without)
        views = _Views(recorder, system.network)
        for label in wanted.images:
            views.add(label, CompressedImage, image_view, about=_LOSSY)
        _add_scenes(views, system, wanted)
        show_map = recorder.view(
            "view/map", SceneUpdate, lambda sample: scene_of_map(sample.value)
        )
        show_map(Sample(road_map, TimePoint(0), TimePoint(0)))
        yield RunRecorder(_keeping(recorder, simulation), recorder)
        recorder.annotate(COMPLETE)


class RunRecorder:
    """Is told of a run what its network does not tell.

    Attributes:
        observe: Takes the frames of the simulation.
    """

    def __init__(self, observe: Observe, recorder: Recorder) -> None:
        self.observe = observe
        self._recorder = recorder

    def keep_periods(self, changes: Sequence[PeriodChange]) -> None:
        """Take note of which sample periods have been changed so far."""
        self._recorder.annotate(metadata_of_periods(changes))


def _keeping(recorder: Recorder, simulation: Simulation | None) -> Observe:
    """Return what records the frames of a simulation, if there is one."""
    if simulation is None:
        return lambda _: None
    truth = recorder.generator(TRUTH, {"about": _TRUTH_IS})
    keeper = FrameKeeper(simulation)
    return lambda frame: truth(keeper.sample(frame))


@dataclass(frozen=True, slots=True)
class _Wanted:
    """What is to be recorded.

    Attributes:
        labels: Of the streams; None for all, also those that come while the network runs.
        without: Of the streams that are not.
        images: Of the images that are to be looked at.
    """

    labels: frozenset[str] | None
    without: frozenset[str]
    images: tuple[str, ...]

    def has(self, label: str) -> bool:
        """Return whether a stream is recorded."""
        return label not in self.without and (self.labels is None or label in self.labels)


def _wanted(request: RecordingRequest, system: MonitoringSystem) -> _Wanted:
    """Return what is to be recorded, if all that was asked for can be."""
    built = [str(label) for label in system.network.kernel.labels]
    of_images = image_labels(system.specification) & frozenset(built)
    single = labels_of_sort(system.specification, *IMAGE_SORTS)
    images = tuple(label for label in single if label in built)
    if request.streams is None:
        return _Wanted(None, of_images, images if request.images else ())
    for label in request.streams:
        if label not in built:
            raise RequestError("--streams", _expected(label, built), label)
        if label in of_images and label not in images:
            raise RequestError("--streams", "labels of streams, or of single images", label)
    asked = frozenset(request.streams)
    shown = tuple(label for label in images if request.images or label in asked)
    return _Wanted(asked - of_images, of_images, shown)


def _expected(label: str, built: Sequence[str]) -> str:
    hint = did_you_mean(nearest_name(label, built))
    return f"labels of this run, which has {', '.join(built)}{hint}"


def _add_scenes(views: "_Views", system: MonitoringSystem, wanted: _Wanted) -> None:
    """Let viewers see the cameras, the cars and what was recognised, as far as is recorded."""
    made = [
        label
        for label in labels_of_sort(system.specification, "camera_pose", "cars", "recognitions")
        if wanted.has(label) and label in system.network.kernel.labels
    ]
    for label in made:
        match sort_of(system.specification, label):
            case "camera_pose":
                views.add(label, PoseInFrame, pose_of_camera)
                views.add(label, FrameTransform, transform_of_camera, part="/transform")
            case "recognitions":
                views.add(label, Log, log_of_recognitions)
            case _ if label == "cars":
                views.add(label, SceneUpdate, CarScenes().scene)
            case _:
                pass  # the same cars with further columns


class _Views:
    """Makes views of the streams of a network."""

    def __init__(self, recorder: Recorder, network: Network) -> None:
        self._recorder = recorder
        self._kernel = network.kernel

    def add(
        self,
        label: str,
        kind: type[Message],
        convert: Callable[[Sample[Any]], Message | None],
        *,
        part: str = "",
        about: Mapping[str, str] | None = None,
    ) -> None:
        """Let viewers see what *convert* makes of each sample of *label*."""
        show = self._recorder.view(f"view/{label}{part}", kind, convert, about)
        self._kernel.subscribe(Label(label), show, name=_RECORDER)

"""Views: what a recording shows in Foxglove and in Rerun, with the schemas that these know.

A view is made from a stream, only to be looked at: a replay never reads it. All views stand in
the frame `map`, which is the world frame: metres, x east, y north, z up.
"""

import colorsys
import math
from collections.abc import Iterable
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.CubePrimitive_pb2 import CubePrimitive
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.PoseInFrame_pb2 import PoseInFrame
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneEntityDeletion_pb2 import SceneEntityDeletion
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.TextPrimitive_pb2 import TextPrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp
from scipy.spatial.transform import Rotation

from chronicles.events import Recognition
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import SECOND, TimePoint
from networks.roads import RoadMap
from perception.camera import Camera
from perception.overlay import jpeg_from

__all__ = [
    "JPEG_QUALITY",
    "CarScenes",
    "image_view",
    "log_of_recognitions",
    "pose_of_camera",
    "scene_of_map",
    "transform_of_camera",
]

JPEG_QUALITY = 85
"""Of images that are recorded to be looked at."""

_WORLD = "map"
_CAMERA = "camera"
_HEIGHT = 1.5
"""Metres; a car has no height of its own, for the cameras look straight down."""

_LETTERS = 2.5
"""Metres; height of the symbols."""

_PREDICTED = (0.6, 0.6, 0.6, 0.5)
_OUTLINE = (0.35, 0.35, 0.35, 1.0)
_PAINT = (0.85, 0.85, 0.85, 1.0)
_UPRIGHT = Quaternion(w=1.0)

Points = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]


class CarScenes:
    """Makes one scene of each table of cars: a box and the symbol for each car.

    Boxes of cars that are only predicted are grey and half transparent. A car that is gone is
    deleted from the scene.
    """

    def __init__(self) -> None:
        self._shown: set[int] = set()

    def scene(self, sample: Sample[Table]) -> SceneUpdate:
        """Return what changes in the scene with *sample*."""
        cars, time = sample.value, _timestamp(sample.valid_time)
        ids: list[int] = cars.ids.tolist()
        gone = self._shown.difference(ids)
        self._shown = set(ids)
        columns = (cars[name].tolist() for name in ("position", "heading", "length", "width"))
        rows = zip(ids, *columns, cars["observed"].tolist(), strict=True)
        return SceneUpdate(
            deletions=[
                SceneEntityDeletion(timestamp=time, id=cars.symbol(one)) for one in sorted(gone)
            ],
            entities=[
                SceneEntity(
                    timestamp=time,
                    frame_id=_WORLD,
                    id=cars.symbol(one),
                    cubes=[_box(position, heading, length, width, _colour(one, seen))],
                    texts=[_symbol(cars.symbol(one), position)],
                )
                for one, position, heading, length, width, seen in rows
            ],
        )


def scene_of_map(road_map: RoadMap) -> SceneUpdate:
    """Return the road network as lines: the outlines of roads, and what is painted on them."""
    outlines = [_line(points, _OUTLINE, closed=True) for points in road_map.road_polygons()]
    paint = [_line(marking.points, _PAINT) for marking in road_map.markings]
    entities = [
        SceneEntity(timestamp=_timestamp(TimePoint(0)), frame_id=_WORLD, id=name, lines=lines)
        for name, lines in (("roads", outlines), ("markings", paint))
    ]
    return SceneUpdate(entities=entities)


def pose_of_camera(sample: Sample[Camera]) -> PoseInFrame:
    """Return where the cameras are and how they look, z forward and y down in the image."""
    camera = sample.value
    x, y, z = camera.position
    pose = Pose(position=Vector3(x=x, y=y, z=z), orientation=_orientation(camera))
    return PoseInFrame(timestamp=_timestamp(sample.valid_time), frame_id=_WORLD, pose=pose)


def transform_of_camera(sample: Sample[Camera]) -> FrameTransform:
    """Return the same as the place of the frame `camera`, in which images stand."""
    x, y, z = sample.value.position
    return FrameTransform(
        timestamp=_timestamp(sample.valid_time),
        parent_frame_id=_WORLD,
        child_frame_id=_CAMERA,
        translation=Vector3(x=x, y=y, z=z),
        rotation=_orientation(sample.value),
    )


def image_view(sample: Sample[Image]) -> CompressedImage:
    """Return an image as a JPEG; what is lost is lost."""
    return CompressedImage(
        timestamp=_timestamp(sample.valid_time),
        frame_id=_CAMERA,
        data=jpeg_from(sample.value, JPEG_QUALITY),
        format="jpeg",
    )


def log_of_recognitions(sample: Sample[tuple[Recognition, ...]]) -> Log | None:
    """Return the recognitions of a sample as a message of a log, a line each; None for none."""
    if not sample.value:
        return None
    lines = [
        f"{each.chronicle.replace('_', ' ')}: {', '.join(each.arguments.values())}"
        for each in sample.value
    ]
    return Log(
        timestamp=_timestamp(sample.available_time),
        level=Log.INFO,
        name="recognised",
        message="\n".join(lines),
    )


def _box(
    position: Iterable[float], heading: float, length: float, width: float, colour: Color
) -> CubePrimitive:
    x, y = position
    turned = Quaternion(z=math.sin(heading / 2), w=math.cos(heading / 2))
    return CubePrimitive(
        pose=Pose(position=Vector3(x=x, y=y, z=_HEIGHT / 2), orientation=turned),
        size=Vector3(x=length, y=width, z=_HEIGHT),
        color=colour,
    )


def _symbol(text: str, position: Iterable[float]) -> TextPrimitive:
    x, y = position
    return TextPrimitive(
        pose=Pose(position=Vector3(x=x, y=y, z=2 * _HEIGHT), orientation=_UPRIGHT),
        billboard=True,
        font_size=_LETTERS,
        color=Color(r=1.0, g=1.0, b=1.0, a=1.0),
        text=text,
    )


@lru_cache(maxsize=4096)
def _colour(car: int, seen: bool) -> Color:  # noqa: FBT001, a column of the table
    """Return a colour of its own for each car: hues as far apart as the golden section."""
    if not seen:
        return _as_colour(_PREDICTED)
    return _as_colour((*colorsys.hsv_to_rgb(car * 0.618034 % 1.0, 0.75, 0.95), 1.0))


def _as_colour(colour: tuple[float, ...]) -> Color:
    r, g, b, a = colour
    return Color(r=r, g=g, b=b, a=a)


def _line(points: Points, colour: tuple[float, ...], *, closed: bool = False) -> LinePrimitive:
    return LinePrimitive(
        type=LinePrimitive.LINE_LOOP if closed else LinePrimitive.LINE_STRIP,
        pose=Pose(orientation=_UPRIGHT),
        thickness=1.5,
        scale_invariant=True,
        points=[Point3(x=x, y=y) for x, y in points.tolist()],
        color=_as_colour(colour),
    )


def _orientation(camera: Camera) -> Quaternion:
    """Return the rotation from the camera frame to the world."""
    x, y, z, w = Rotation.from_matrix(camera.camera_from_world.T).as_quat()
    return Quaternion(x=x, y=y, z=z, w=w)


def _timestamp(time: TimePoint) -> Timestamp:
    whole, rest = divmod(time, SECOND)
    return Timestamp(seconds=whole, nanos=rest)

"""Cameras and perception as knowledge processes; the only module here that knows samples."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from perception.camera import Camera, Points
from perception.painting import GroundPainter, Image, make_texture
from perception.pipeline import Percepts, Pipeline, PipelineSettings
from perception.rendering import ColourRenderer, ThermalRenderer
from perception.scene import Ground, Surroundings, Vehicles

__all__ = ["ColourCamera", "ThermalCamera", "VisionPercepts", "make_painter"]


def make_painter(
    ground: Ground, surroundings: Surroundings, generator: np.random.Generator
) -> GroundPainter:
    """Return the painter of one piece of country, to be shared by all cameras above it."""
    return GroundPainter(ground, surroundings, make_texture(generator))


class _CameraUnit(Reactive):
    """Turns each sample of vehicles into an image with the same valid time."""

    def __init__(self, renderer: ColourRenderer | ThermalRenderer) -> None:
        self._renderer = renderer
        self._last = TimePoint(-1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Image]]:
        """Emit one image for each new sample of vehicles, once a pose of the camera is known."""
        vehicles, pose = inputs
        if vehicles.value is NO_VALUE or pose.value is NO_VALUE:
            return ()
        if vehicles.valid_time <= self._last:
            return ()
        self._last = vehicles.valid_time
        camera: Camera = pose.value
        image = self._renderer.render(vehicles_from_table(vehicles.value), camera)
        return (Sample(image, vehicles.valid_time, now),)


class ColourCamera(_CameraUnit):
    """The unit `ColourCamera(vehicles, camera_pose)`: images (h, w, 3), blue, green, red."""

    def __init__(self, *, painter: GroundPainter, generator: np.random.Generator) -> None:
        super().__init__(ColourRenderer(painter, generator))


class ThermalCamera(_CameraUnit):
    """The unit `ThermalCamera(vehicles, camera_pose)`: images (h, w), brighter where warmer."""

    def __init__(self, *, painter: GroundPainter, generator: np.random.Generator) -> None:
        super().__init__(ThermalRenderer(painter, generator))


class VisionPercepts(Reactive):
    """The unit `VisionPercepts(images, camera_pose)`: what the images show, of sort `percept`.

    The first input is a stream of states: tuples of a colour and a thermal image of one valid
    time, either of which may be `NO_VALUE`. For each state one table is emitted, with the valid
    time of the state, as soon as it comes; nothing before the first pose has come.
    """

    def __init__(
        self, *, roads: Sequence[Points], settings: PipelineSettings | None = None
    ) -> None:
        self._pipeline = Pipeline(roads, settings)
        self._last = TimePoint(-1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the percepts of a new state of images."""
        images, pose = inputs
        if images.value is NO_VALUE or pose.value is NO_VALUE:
            return ()
        if images.valid_time <= self._last:
            return ()
        self._last = images.valid_time
        colour, thermal = (None if image is NO_VALUE else image for image in images.value)
        percepts = self._pipeline.perceive(images.valid_time, colour, thermal, pose.value)
        return (Sample(_table(percepts, images.valid_time), images.valid_time, now),)


def vehicles_from_table(table: Table) -> Vehicles:
    """Return the columns of a table of vehicles that can be seen."""
    return Vehicles(
        table.ids,
        table["position"],
        table["heading"],
        table["length"],
        table["width"],
        table["height"],
        table["colour"],
    )


def _table(percepts: Percepts, observed_at: TimePoint) -> Table:
    return Table(
        "percept",
        percepts.ids,
        {
            "position": percepts.position,
            "velocity": percepts.velocity,
            "covariance": percepts.covariance,
            "length": percepts.length,
            "width": percepts.width,
            "colour": percepts.colour,
            "temperature": percepts.temperature,
            "observed_at": np.full(len(percepts), observed_at, dtype=np.int64),
        },
    )

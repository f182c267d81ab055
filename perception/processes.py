"""Cameras and perception as knowledge processes; the only module here that knows samples."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.table import Column, Table
from dyknow.time import TimePoint
from perception.camera import Camera, Points
from perception.lamps import LampReader, Lamps
from perception.painting import GroundPainter, Image, make_texture
from perception.pipeline import Percepts, Pipeline, PipelineSettings
from perception.rendering import ColourRenderer, ThermalRenderer
from perception.scene import Ground, Surroundings, Vehicles

__all__ = ["ColourCamera", "SignalLamps", "ThermalCamera", "VisionPercepts", "make_painter"]


def make_painter(
    ground: Ground, surroundings: Surroundings, generator: np.random.Generator
) -> GroundPainter:
    """Return the painter of one piece of country, to be shared by all cameras above it."""
    return GroundPainter(ground, surroundings, make_texture(generator))


class _CameraUnit(Reactive):
    """Turns each sample of vehicles into an image with the same valid time."""

    def __init__(self, take: Callable[[Vehicles, Camera, tuple[Sample[Any], ...]], Image]) -> None:
        self._take = take
        self._last = TimePoint(-1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Image]]:
        """Emit one image for each new sample of vehicles, once a pose of the camera is known."""
        vehicles, pose = inputs[:2]
        if vehicles.value is NO_VALUE or pose.value is NO_VALUE:
            return ()
        if vehicles.valid_time <= self._last:
            return ()
        self._last = vehicles.valid_time
        image = self._image(vehicles_from_table(vehicles.value), pose.value, inputs[2:])
        return (Sample(image, vehicles.valid_time, now),)

    def _image(self, vehicles: Vehicles, camera: Camera, others: tuple[Sample[Any], ...]) -> Image:
        raise NotImplementedError


class ColourCamera(_CameraUnit):
    """The unit `ColourCamera(vehicles, camera_pose, signals)`: images (h, w, 3).

    The channels are blue, green, red. The third input may be left out; then no lamp is lit.
    """

    def __init__(
        self,
        *,
        painter: GroundPainter,
        generator: np.random.Generator,
        lamps: Lamps | None = None,
    ) -> None:
        super().__init__(self._image)
        self._n_lamps = 0 if lamps is None else len(lamps)
        self._renderer = ColourRenderer(painter, generator, lamps=lamps)

    def _image(self, vehicles: Vehicles, camera: Camera, others: tuple[Sample[Any], ...]) -> Image:
        lights = np.zeros(self._n_lamps, dtype=np.int8)
        for signals in others:
            if signals.value is not NO_VALUE:
                lights[signals.value.ids] = signals.value["state"]
        return self._renderer.render(vehicles, camera, lights)

    def skip(self, time: TimePoint, camera: Camera) -> None:
        """Pass over the image of *time*, at a small part of the cost of taking it.

        All later images are what they are if this one is taken.
        """
        self._last = time
        self._renderer.skip(camera)


class ThermalCamera(_CameraUnit):
    """The unit `ThermalCamera(vehicles, camera_pose)`: images (h, w), brighter where warmer."""

    def __init__(self, *, painter: GroundPainter, generator: np.random.Generator) -> None:
        super().__init__(self._image)
        self._renderer = ThermalRenderer(painter, generator)

    def _image(self, vehicles: Vehicles, camera: Camera, others: tuple[Sample[Any], ...]) -> Image:
        del others
        return self._renderer.render(vehicles, camera)

    def skip(self, time: TimePoint, camera: Camera) -> None:
        """Pass over the image of *time*, at a small part of the cost of taking it.

        All later images are what they are if this one is taken.
        """
        self._last = time
        self._renderer.skip(camera)


class SignalLamps(Reactive):
    """The unit `SignalLamps(images, camera_pose)`: what signals show, of sort `signal`.

    A table comes out for each colour image, with the signals whose lamps have been seen so far.
    Columns: `state`, int8, what a lamp shows (`perception.lamps.Light`), or showed when it was
    seen last; `since`, int64, when it was first seen to do so; `observed`, whether it is seen now.
    """

    def __init__(self, *, lamps: Lamps) -> None:
        self._reader = LampReader(lamps)
        self._last = TimePoint(-1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit what is known of the signals with a new image."""
        images, pose = inputs
        if images.value is NO_VALUE or pose.value is NO_VALUE:
            return ()
        if images.valid_time <= self._last:
            return ()
        self._last = images.valid_time
        lights = self._reader.read(images.valid_time, images.value, pose.value)
        columns: dict[str, Column] = {
            "state": lights.light,
            "since": lights.since,
            "observed": lights.is_seen,
        }
        table = Table("signal", lights.rows.astype(np.int64), columns)
        return (Sample(table, images.valid_time, now),)


class VisionPercepts(Reactive):
    """The unit `VisionPercepts(images, camera_pose)`: what the images show, of sort `percept`.

    The first input is a stream of states: tuples of a colour and a thermal image of one valid
    time, either of which may be `NO_VALUE`. For each state one table is emitted, with the valid
    time of the state, as soon as it comes; nothing before the first pose has come.
    """

    def __init__(
        self,
        *,
        roads: Sequence[Points],
        settings: PipelineSettings | None = None,
        lamps: Lamps | None = None,
    ) -> None:
        self._pipeline = Pipeline(roads, settings, lamps)
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

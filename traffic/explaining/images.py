"""The images of a run, made again: the same simulation, and only the frames that are wanted.

No run stores images. The scenario and the seed give the same vehicles again, and a camera gives
the same image if its noise has been drawn as often before. A small network of the camera and of
what feeds it, with the policies of the run, does what the run did; images that are not wanted are
passed over. The run keeps a digest of what each image shows, so that another simulation is never
taken for it.
"""

import tempfile
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from dyknow.errors import ProcessError
from dyknow.kpl.plan import build_network
from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.time import SECOND, TimePoint
from networks.roads import RoadMap
from perception.camera import Camera
from traffic.errors import ExplanationError
from traffic.explaining.columns import digest_of
from traffic.explaining.kept import KeptRun
from traffic.sumo.feeding import FrameFeed
from traffic.sumo.opening import open_simulation
from traffic.system import implementations_of, specification_from
from traffic.watching import OnProgress
from traffic.world import World, generators_of

__all__ = ["Image", "images_again"]

Image = npt.NDArray[np.uint8]
"""Shape (h, w) or, with blue, green and red, (h, w, 3)."""

_OUTPUT = "images_again"
_SOURCE = "source"


class _CameraUnit(Protocol):
    """A camera that can pass over images; what it films is its first input, its pose the next."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Image]]:
        """Take an image."""

    def skip(self, time: TimePoint, camera: Camera) -> None:
        """Pass over an image."""


def images_again(
    run: KeptRun,
    stream: str,
    numbers: Collection[int],
    scene: tuple[RoadMap, Camera],
    on_progress: OnProgress,
) -> dict[int, Image]:
    """Return some images of a run, made again, by their numbers.

    Args:
        run: The run.
        stream: The stream of the images.
        numbers: Of the images, counted from 0.
        scene: The map, and the camera of the run.
        on_progress: Told the seconds simulated so far and those in all.

    Raises:
        ExplanationError: The simulation is not what it was.
        SimulatorError: It cannot be run again.
    """
    if not numbers:
        return {}
    road_map, camera = scene
    known = _Known(run, stream, numbers)
    name = run.process_of(stream).partition("(")[0]
    with _feed(run, road_map) as (feed, sensors):
        world = World(road_map, feed.vehicles, camera, sensors, feed.signals)
        offered = implementations_of(world)
        if name not in offered.units:
            fault = f"'{stream}' is made by '{name}', which this version does not know"
            raise ExplanationError(fault)
        maker: Any = offered.units[name]
        chooser = _Chooser(maker(), known)
        network = build_network(
            specification_from(_text(run, stream, name), f"<{stream}>"),
            replace(offered, units={**offered.units, name: lambda: chooser}),
            {},
            (_OUTPUT,),
        )
        end = TimePoint(known.end)
        try:
            network.kernel.run(end, lambda now: on_progress(now / SECOND, end / SECOND))
        except ProcessError as error:
            raise (error.__cause__ or error) from None
    if missing := sorted(set(numbers) - chooser.images.keys()):
        raise ExplanationError(f"'{stream}' has no image {missing[0]} when it is made again")
    return chooser.images


class _Known:
    """What the run knows of the images of one stream.

    Attributes:
        end: The time of the last one that is wanted.
    """

    def __init__(self, run: KeptRun, stream: str, numbers: Collection[int]) -> None:
        rows = run.images[run.images["stream"] == stream].sort_values("number")
        times = rows["valid_time"].astype("int64").tolist()
        self.end = times[max(numbers)]
        self._run = run
        self._numbers = numbers
        self._number_by_time = {time: number for number, time in enumerate(times)}
        self._digests = rows["digest"].tolist()

    def number_of(self, time: TimePoint, shown: Iterable[Any]) -> int | None:
        """Return the number of the image of some time; None if there was none.

        Raises:
            ExplanationError: What it is to show is not what was filmed.
        """
        number = self._number_by_time.get(time)
        if number is not None and self._digests[number] != digest_of(shown):
            raise ExplanationError(_changed(self._run, time))
        return number

    def is_wanted(self, number: int) -> bool:
        """Return whether an image is wanted."""
        return number in self._numbers


class _Chooser(Reactive):
    """In the place of a camera: takes the images that are wanted, and passes over the others.

    Attributes:
        images: Those that were taken, by their numbers.
    """

    def __init__(self, camera: _CameraUnit, known: _Known) -> None:
        self.images: dict[int, Image] = {}
        self._camera = camera
        self._known = known
        self._last = TimePoint(-1)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Take or pass over the image of what is new in the first input; emit nothing."""
        vehicles, pose = inputs[:2]
        if (
            vehicles.value is NO_VALUE
            or pose.value is NO_VALUE
            or vehicles.valid_time <= self._last
        ):
            return ()
        self._last = vehicles.valid_time
        shown = (sample.value for sample in inputs)
        number = self._known.number_of(vehicles.valid_time, shown)
        if number is not None and self._known.is_wanted(number):
            for sample in self._camera.push(now, inputs):
                self.images[number] = sample.value
        elif number is not None:
            self._camera.skip(vehicles.valid_time, pose.value)
        return ()


@contextmanager
def _feed(run: KeptRun, road_map: RoadMap) -> Iterator[tuple[FrameFeed, np.random.Generator]]:
    """Give the simulation of a run from its beginning, and the randomness of its sensors."""
    traffic, sensors = generators_of(int(run.origin.request["seed"] or 0))
    with (
        tempfile.TemporaryDirectory(prefix="traffic-") as folder,
        open_simulation(run.origin.scenario, Path(folder), traffic) as simulation,
    ):
        yield FrameFeed(simulation, road_map.signals), sensors


def _text(run: KeptRun, stream: str, unit: str) -> str:
    """Return a specification of a camera and its sources, as they were in the run."""
    generators = run.roles.generators
    inputs = [generators[label] for label in run.roles.providers(stream)]
    if others := [each["label"] for each in inputs if each["kind"] != _SOURCE]:
        raise ExplanationError(f"'{stream}' is made of '{others[0]}', which cannot be made again")
    lines = [f"source {each['sort']} {each['process']}" for each in inputs]
    lines += [f"strmgen {each['label']} = {each['process']}" for each in inputs]
    sorts = ", ".join(each["sort"] for each in inputs)
    lines.append(f"compunit {generators[stream]['sort']} {unit}({sorts})")
    lines.append(f"strmgen {stream} = {generators[stream]['process']}")
    lines.append(f"stream {_OUTPUT} = {stream}")
    return "\n".join(lines) + "\n"


def _changed(run: KeptRun, time: int) -> str:
    versions = ", ".join(f"{name} {number}" for name, number in run.origin.versions.items())
    return (
        f"the images of '{run.folder}' cannot be made again: at {time / SECOND:.2f} s the "
        "vehicles or signals are not those that were filmed. The run was made with "
        f"{versions}; its files may have changed since then"
    )

"""One run: a scenario, simulated, watched, recognised, scored, and written to a folder."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from chronicles.events import Recognition
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, TimePoint
from networks.reading import read_road_map
from networks.roads import RoadMap
from perception.camera import Camera
from traffic.origin import write_origin
from traffic.overlaying import Overlay
from traffic.request import RunRequest, View
from traffic.results import RunResult, Timing, new_folder, run_folder, write_result
from traffic.scoring.score import Scorer
from traffic.sumo.opening import network_of, open_simulation
from traffic.sumo.simulation import Frame, Simulation
from traffic.system import MonitoringSystem
from traffic.world import World, camera_of, generators_of

__all__ = ["run_scenario"]

_RECOGNITIONS = ("recognised_turns", "recognised_overtakes")
_IMAGES = ("colour_images", "thermal_images")

OnProgress = Callable[[float, float], None]
"""Told the seconds simulated so far and the seconds in all."""


def run_scenario(request: RunRequest, on_progress: OnProgress) -> tuple[RunResult, Path]:
    """Do what is asked; return the result and the folder it was written to.

    Raises:
        TrafficError: The folder exists or cannot be written, the simulator gave up, or the
            scenario has a fault that only its network shows.
        NetworkError: The network cannot be read.
    """
    road_map = read_road_map(network_of(request.scenario))
    camera = camera_of(request.scenario.camera, road_map) if request.view is View.VISION else None
    traffic, sensors = generators_of(request.seed)
    path = request.out or new_folder(request.scenario.name)
    with (
        run_folder(path) as folder,
        open_simulation(request.scenario, folder / "sumo", traffic) as simulation,
    ):
        write_origin(request, folder)
        run = _Run(request, road_map, simulation, camera, sensors)
        with _film(request, camera, run):
            result = run.complete(on_progress)
        write_result(result, folder)
    return result, path


@contextmanager
def _film(request: RunRequest, camera: Camera | None, run: "_Run") -> Iterator[None]:
    """Film what is believed while the block lasts, if that was asked for.

    The film is made beside its place, so that it turns out at once if nothing can be written.
    """
    if request.overlay is None or camera is None:
        yield
        return
    overlay = Overlay(request.overlay.with_suffix(".partial.mp4"), camera)
    kept: Path | None = None
    try:
        run.show(overlay)
        yield
        kept = request.overlay
    finally:
        overlay.close(kept)


class _Run:
    """The parts of one run, connected."""

    def __init__(
        self,
        request: RunRequest,
        road_map: RoadMap,
        simulation: Simulation,
        camera: Camera | None,
        sensors: np.random.Generator,
    ) -> None:
        self._request = request
        self._recognitions: list[Recognition] = []
        footprint = camera.footprint() if camera is not None else None
        self._scorer = Scorer(road_map, simulation, footprint)
        vehicles = _Vehicles(simulation, self._scorer.observe_frame)
        world = World(road_map, vehicles, camera, sensors)
        outputs = ("cars", *_RECOGNITIONS)
        images = _IMAGES if request.overlay is not None else ()
        self._system = MonitoringSystem(world, _parameters(request), (*outputs, *images))
        network = self._system.network
        network.subscribe("cars", self._scorer.observe_cars)
        for output in _RECOGNITIONS:
            network.subscribe(output, self._note)

    def show(self, overlay: Overlay) -> None:
        """Let *overlay* receive what it shows."""
        network = self._system.network
        colour, thermal = _IMAGES
        network.subscribe(colour, overlay.receive_colour)
        network.subscribe(thermal, overlay.receive_thermal)
        network.subscribe("cars", overlay.receive_cars)
        for output in _RECOGNITIONS:
            network.subscribe(output, overlay.receive_recognitions)

    def complete(self, on_progress: OnProgress) -> RunResult:
        """Run to the end and judge what was recognised."""
        request = self._request
        duration = request.scenario.duration
        kernel = self._system.network.kernel
        began = time.perf_counter()
        kernel.run(TimePoint(duration), lambda now: on_progress(now / SECOND, duration / SECOND))
        wall = time.perf_counter() - began
        self._recognitions.sort(key=lambda recognition: (recognition.begin, recognition.end))
        verdict = self._scorer.judge(self._recognitions)
        stages = {str(label): account.seconds for label, account in kernel.accounts.items()}
        return RunResult(
            scenario=request.scenario.name,
            settings=_settings(request),
            recognitions=verdict.recognitions,
            missed=verdict.missed,
            score=verdict.score,
            timing=Timing(
                simulated_s=duration / SECOND,
                wall_s=wall,
                real_time_factor=duration / SECOND / wall,
                stages=stages,
            ),
        )

    def _note(self, sample: Sample[tuple[Recognition, ...]]) -> None:
        self._recognitions.extend(sample.value)


class _Vehicles:
    """The source of the simulator's vehicles; shows each frame to an observer as well."""

    def __init__(self, simulation: Simulation, observe: Callable[[Frame], None]) -> None:
        self._simulation = simulation
        self._observe = observe

    def samples(self) -> Iterator[Sample[Table]]:
        """Yield the vehicles of each frame, available at once."""
        while (frame := self._simulation.step()) is not None:
            self._observe(frame)
            yield Sample(frame.vehicles, frame.time, frame.time)


def _parameters(request: RunRequest) -> dict[str, object]:
    return {
        "view": str(request.view),
        "sample_period": request.sample_period / MILLISECOND,
        "position_noise": request.position_noise,
    }


def _settings(request: RunRequest) -> dict[str, str | int | float | None]:
    is_truth = request.view is View.TRUTH
    return {
        "view": str(request.view),
        "seed": request.seed,
        "sample period ms": request.sample_period / MILLISECOND,
        "position noise m": request.position_noise if is_truth else None,
        "duration s": request.scenario.duration / SECOND,
    }

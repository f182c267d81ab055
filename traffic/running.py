"""One run: a scenario, simulated, watched, recognised, scored, and written to a folder."""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from chronicles.events import Recognition
from dyknow.inspection.taking import snapshot
from dyknow.kpl.names import Declarations
from dyknow.kpl.plan import Network
from dyknow.kpl.syntax import Specification
from dyknow.runtime.clock import WallClock
from dyknow.runtime.failures import Failure
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.names import input_name
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.service.governor import GovernorSettings, LoadGovernor
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, SECOND, Duration, TimePoint, text_from_duration
from networks.reading import read_road_map
from perception.camera import Camera
from traffic.errors import RequestError
from traffic.origin import Origin, origin_of, write_origin
from traffic.overlaying import Overlay
from traffic.recording.describing import RunDescription
from traffic.recording.periods import KeepPeriods
from traffic.recording.writing import RunRecorder, recorded
from traffic.request import DEFAULT_PERIOD, FRAME_PERIOD, RunRequest, View
from traffic.results import Lateness, RunResult, Timing, new_folder, run_folder, write_result
from traffic.scoring.score import Scorer, Verdict, unjudged
from traffic.sumo.opening import network_of, open_simulation
from traffic.sumo.simulation import Frame, Simulation
from traffic.system import (
    MonitoringSystem,
    bundled_specification,
    outputs_of,
    outputs_of_sort,
    read_specification,
)
from traffic.world import World, camera_of, generators_of

__all__ = [
    "Companion",
    "OnProgress",
    "Told",
    "Watch",
    "run_scenario",
    "scorer_for",
    "told_of",
    "write_network",
]

_CARS = "cars"
_RECOGNITIONS = "recognitions"
_IMAGES = ("colour_images", "thermal_images")

OnProgress = Callable[[float, float], None]
"""Told the seconds simulated so far and the seconds in all."""


class Companion(Protocol):
    """Keeps pace with a run."""

    def advance(self, now: TimePoint) -> None:
        """Take note that the work of the instant *now* begins."""

    def finish(self) -> None:
        """Take note that the run is over."""


@dataclass(frozen=True, slots=True)
class Told:
    """What a result says of a run that the run itself does not find out.

    Attributes:
        scenario: Name of the scenario.
        settings: What was asked for.
        duration: How long the run is to be.
        deadline: In real time, how late the work of an instant may be done.
    """

    scenario: str
    settings: Mapping[str, str | int | float | None]
    duration: Duration
    deadline: Duration


def run_scenario(request: RunRequest, on_progress: OnProgress) -> tuple[RunResult, Path]:
    """Do what is asked; return the result and the folder it was written to.

    Raises:
        TrafficError: The folder exists or cannot be written, the simulator gave up, or the
            scenario has a fault that only its network shows.
        NetworkError: The network cannot be read.
        SpecificationErrors: The specification that was asked for has faults.
    """
    specification = read_specification(request.specification)
    road_map = read_road_map(network_of(request.scenario))
    camera = camera_of(request.scenario.camera, road_map) if request.view is View.VISION else None
    traffic, sensors = generators_of(request.seed)
    path = request.out or new_folder(request.scenario.name)
    with (
        run_folder(path) as folder,
        open_simulation(request.scenario, folder / "sumo", traffic) as simulation,
    ):
        vehicles = _Vehicles(simulation)
        world = World(road_map, vehicles, camera, sensors)
        system = _system(request, specification, world)
        description = _description(request, system)
        write_origin(description.origin, description.named_text, system.files, folder)
        scorer = scorer_for(world, simulation)
        vehicles.observers.append(scorer.observe_frame)
        watch = Watch(system, scorer)
        with (
            _film(request, camera, watch),
            _recording(request, description, system, world, simulation) as keep,
        ):
            if keep is not None:
                vehicles.observers.append(keep.observe)
                watch.keep_periods = keep.keep_periods
            told = told_of(description.origin)
            result = watch.complete(told, on_progress, real_time=request.real_time)
        write_network(system.network, folder)
        write_result(result, folder)
    return result, path


class Watch:
    """A system at work: what it recognises is collected, and scored if the truth is known.

    Args:
        system: The system, before it runs.
        scorer: Knows the truth, from outside; None if nothing does.
        is_governed: Whether streams may stand back when the work falls behind the clock.

    Attributes:
        keep_periods: Told what has been changed because of that.
    """

    def __init__(
        self, system: MonitoringSystem, scorer: Scorer | None, *, is_governed: bool = True
    ) -> None:
        self.keep_periods: KeepPeriods = lambda _: None
        self._is_governed = is_governed
        self._network = system.network
        self._scorer = scorer if _CARS in outputs_of_sort(system.specification, _CARS) else None
        self._recognitions: list[Recognition] = []
        self._violations: Counter[str] = Counter()
        self._last_violation: StreamViolation | None = None
        self._failures: list[str] = []
        told = set(outputs_of_sort(system.specification, _RECOGNITIONS))
        self._outputs = [name for name in self._network.outputs if name in told]
        if self._scorer is not None:
            self._network.subscribe(_CARS, self._scorer.observe_cars)
        for output in self._outputs:
            self._network.subscribe(output, self._note)
        self._network.kernel.subscribe_violations(self._count)
        self._network.kernel.subscribe_failures(self._report)

    def show(self, overlay: Overlay) -> None:
        """Let *overlay* receive what it shows.

        Raises:
            RequestError: The system has no cars.
        """
        if _CARS not in self._network.outputs:
            expected = f"a specification with an output stream '{_CARS}'"
            raise RequestError("--overlay", expected, "none")
        colour, thermal = _IMAGES
        self._network.subscribe(colour, overlay.receive_colour)
        self._network.subscribe(thermal, overlay.receive_thermal)
        self._network.subscribe(_CARS, overlay.receive_cars)
        for output in self._outputs:
            self._network.subscribe(output, overlay.receive_recognitions)

    def complete(
        self,
        told: Told,
        on_progress: OnProgress,
        companion: Companion | None = None,
        *,
        real_time: bool = False,
    ) -> RunResult:
        """Run to the end and judge what was recognised.

        The *companion* keeps pace with it. In *real_time* an instant is worked on when it is
        that time on the clock on the wall; nothing else changes, unless the specification allows
        streams to stand back when the work falls behind.
        """
        total = told.duration / SECOND
        kernel = self._network.kernel
        pace = _Pace(kernel, told.deadline) if real_time else None

        def tell(now: TimePoint) -> None:
            if pace is not None and self._is_governed and pace.has_changed(now):
                self.keep_periods(pace.governor.changes)
            if companion is not None:
                companion.advance(now)
            on_progress(now / SECOND, total)

        began = time.perf_counter()
        kernel.run(TimePoint(told.duration), tell, pace.clock if pace else None)
        wall = time.perf_counter() - began
        if companion is not None:
            companion.finish()
        verdict = self._verdict()
        return RunResult(
            scenario=told.scenario,
            settings=dict(told.settings),
            recognitions=verdict.recognitions,
            missed=verdict.missed,
            score=verdict.score,
            timing=Timing(
                simulated_s=total,
                wall_s=wall,
                real_time_factor=total / wall,
                stages={str(label): each.seconds for label, each in kernel.accounts.items()},
                lateness=pace.lateness() if pace else None,
            ),
            violations=dict(self._violations),
            failures=self._failures,
        )

    def _verdict(self) -> Verdict:
        self._recognitions.sort(key=lambda recognition: (recognition.begin, recognition.end))
        if self._scorer is None:
            return unjudged(self._recognitions)
        return self._scorer.judge(self._recognitions)

    def _note(self, sample: Sample[tuple[Recognition, ...]]) -> None:
        self._recognitions.extend(sample.value)

    def _count(self, violation: StreamViolation) -> None:
        """Count a violation; once, if several who are called alike have the stream."""
        name, last = _name_of(violation), self._last_violation
        self._last_violation = violation
        is_known = last is not None and last.violation is violation.violation
        if not (is_known and last is not None and _name_of(last) == name):
            self._violations[name] += 1

    def _report(self, failure: Failure) -> None:
        at = text_from_duration(failure.time)
        self._failures.append(f"process '{failure.label}' failed at {at} ms: {failure.text}")


def _name_of(violation: StreamViolation) -> str:
    """Return what a stream is called: an input by its number, an output by its provider."""
    if violation.number:
        return input_name(violation.receiver, violation.number)
    if violation.receiver == violation.provider:
        return violation.receiver
    return f"{violation.provider} for {violation.receiver}"


@contextmanager
def _film(request: RunRequest, camera: Camera | None, watch: Watch) -> Iterator[None]:
    """Film what is believed while the block lasts, if that was asked for.

    The film is made beside its place, so that it turns out at once if nothing can be written.
    """
    if request.overlay is None or camera is None:
        yield
        return
    overlay = Overlay(request.overlay.with_suffix(".partial.mp4"), camera)
    kept: Path | None = None
    try:
        watch.show(overlay)
        yield
        kept = request.overlay
    finally:
        overlay.close(kept)


class _Vehicles:
    """The source of the simulator's vehicles; shows each frame to observers as well.

    Attributes:
        observers: Who is shown each frame before it enters the network.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.observers: list[Callable[[Frame], None]] = []
        self._simulation = simulation

    def samples(self) -> Iterator[Sample[Table]]:
        """Yield the vehicles of each frame, available at once."""
        while (frame := self._simulation.step()) is not None:
            for observe in self.observers:
                observe(frame)
            yield Sample(frame.vehicles, frame.time, frame.time)


def scorer_for(world: World, simulation: Simulation) -> Scorer:
    """Return what scores a run in *world*, given the truth that *simulation* knows."""
    footprint = world.camera.footprint() if world.camera is not None else None
    return Scorer(world.road_map, simulation, footprint)


def write_network(network: Network, folder: Path) -> None:
    """Write what the network looks like now into the folder of its run."""
    (folder / "network.json").write_text(snapshot(network).to_json(), encoding="utf-8")


def _system(request: RunRequest, specification: Specification, world: World) -> MonitoringSystem:
    outputs = outputs_of(specification)
    if request.overlay is not None:
        outputs += tuple(name for name in _IMAGES if name not in outputs)
    parameters = _parameters(request, specification)
    return MonitoringSystem(world, parameters, outputs, specification=specification)


def _description(request: RunRequest, system: MonitoringSystem) -> RunDescription:
    place = request.specification or bundled_specification()
    return RunDescription(
        origin=origin_of(request, system.files),
        text=place.read_text(encoding="utf-8"),
        place=str(place),
        parameters=_parameters(request, system.specification),
        outputs=system.network.outputs,
    )


@contextmanager
def _recording(
    request: RunRequest,
    description: RunDescription,
    system: MonitoringSystem,
    world: World,
    simulation: Simulation,
) -> Iterator[RunRecorder | None]:
    """Record what the system does while the block lasts, if that was asked for."""
    if request.recording is None:
        yield None
        return
    parts = system, world.road_map, simulation
    with recorded(request.recording, description, *parts) as keep:
        yield keep


def _parameters(request: RunRequest, specification: Specification) -> dict[str, object]:
    """Return values for the parameters of the specification.

    Raises:
        RequestError: An option sets a parameter that the specification does not have.
    """
    declared = Declarations(specification).parameters
    period, noise = request.sample_period, request.position_noise
    longest = request.longest_frame_period
    for name, option, is_set in (
        ("sample_period", "--sample-period", period != DEFAULT_PERIOD),
        ("position_noise", "--position-noise", noise != 0),
        ("longest_frame_period", "--longest-frame-period", longest != FRAME_PERIOD),
    ):
        if is_set and name not in declared:
            expected = f"a specification with the parameter '{name}'"
            raise RequestError(option, expected, "none")
    values = {
        "view": str(request.view),
        "sample_period": period / MILLISECOND,
        "position_noise": noise,
        "longest_frame_period": longest / MILLISECOND,
    }
    return {name: value for name, value in values.items() if name in declared}


def told_of(origin: Origin) -> Told:
    """Return what a result says of a run with this origin."""
    asked, scenario = origin.request, origin.scenario
    settings: dict[str, str | int | float | None] = {
        "view": asked["view"],
        "seed": asked["seed"],
        "sample period ms": int(asked["sample_period_ns"] or 0) / MILLISECOND,
        "position noise m": asked["position_noise"] if asked["view"] == View.TRUTH else None,
        "duration s": scenario.duration / SECOND,
    }
    return Told(scenario.name, settings, scenario.duration, scenario.step_length)


class _Pace:
    """The clock on the wall, and the governor of what may stand back when work is late by it."""

    def __init__(self, kernel: Kernel, deadline: Duration) -> None:
        self.clock = WallClock(deadline)
        settings = GovernorSettings(late_after=deadline)
        self.governor = LoadGovernor(kernel, lambda: self.clock.last_lateness, settings)

    def has_changed(self, now: TimePoint) -> bool:
        """Let streams stand back, or no longer; return whether any did."""
        before = len(self.governor.changes)
        self.governor.watch(now)
        return len(self.governor.changes) > before

    def lateness(self) -> Lateness:
        """Return how late the work was done."""
        late = self.clock.lateness
        return Lateness(
            max_ms=late.largest / MILLISECOND,
            mean_ms=late.mean / MILLISECOND,
            late_share=self.clock.n_missed / late.samples if late.samples else 0.0,
            period_changes=len(self.governor.changes),
        )

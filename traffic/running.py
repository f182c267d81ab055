"""One run: a scenario, simulated, watched, recognised, scored, and written to a folder."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from pathlib import Path

from dyknow.errors import SpecificationErrors
from dyknow.inspection.taking import snapshot
from dyknow.kpl.names import Declarations
from dyknow.kpl.plan import Network
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import Specification
from dyknow.source_text import did_you_mean, nearest_name
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND
from perception.camera import Camera
from traffic.errors import RequestError, TrafficError
from traffic.explaining.keeping import explanations_kept
from traffic.origin import origin_of, write_origin
from traffic.overlaying import Overlay
from traffic.recording.describing import RunDescription
from traffic.recording.finding import note_recording
from traffic.recording.writing import RunRecorder, recorded
from traffic.request import DEFAULT_PERIOD, FRAME_PERIOD, RunRequest, View
from traffic.results import RunResult, new_folder, run_folder, write_result
from traffic.scoring.score import Scorer, lines_scored
from traffic.settings import changed_specification, parameters_in
from traffic.sumo.feeding import FrameFeed
from traffic.sumo.opening import network_of, open_simulation
from traffic.sumo.simulation import Simulation
from traffic.system import (
    MonitoringSystem,
    bundled_specification,
    labels_of_sort,
    outputs_behind,
    outputs_of,
    read_specification,
)
from traffic.watching import IMAGES, OnProgress, Watch, told_of
from traffic.world import World, camera_of, generators_of, road_map_at

__all__ = [
    "CheckedRequest",
    "RequestChecks",
    "check_request",
    "outputs_recognising",
    "run_scenario",
    "scorer_for",
    "write_network",
]

_RECOGNITIONS = "recognitions"
_RECOGNISED = "recognised_"
"""Before the names of the output streams that `--recognise` chooses from."""


def run_scenario(request: RunRequest, on_progress: OnProgress) -> tuple[RunResult, Path]:
    """Do what is asked; return the result and the folder it was written to.

    Raises:
        TrafficError: The folder exists or cannot be written, the simulator gave up, or the
            scenario has a fault that only its network shows.
        NetworkError: The network cannot be read.
        SpecificationErrors: The specification that was asked for has faults.
    """
    specification = _specification(request)
    road_map = road_map_at(network_of(request.scenario))
    camera = camera_of(request.scenario.camera, road_map) if request.view is View.VISION else None
    traffic, sensors = generators_of(request.seed)
    path = request.out or new_folder(request.scenario.name)
    with (
        run_folder(path) as folder,
        open_simulation(request.scenario, folder / "sumo", traffic) as simulation,
    ):
        feed = FrameFeed(simulation, road_map.signals)
        world = World(road_map, feed.vehicles, camera, sensors, feed.signals)
        system = _system(request, specification, world)
        description = _description(request, system)
        write_origin(description.origin, description.named_text, system.files, folder)
        scorer = scorer_for(world, simulation, system)
        feed.observers.append(scorer.observe_frame)
        watch = Watch(system, scorer)
        with (
            _film(request, camera, watch),
            _recording(request, description, system, world, simulation, folder) as keep,
            explanations_kept(system, road_map, folder),
        ):
            if keep is not None:
                feed.observers.append(keep.observe)
                watch.keep_periods = keep.keep_periods
            told = told_of(description.origin)
            result = watch.complete(told, on_progress, real_time=request.real_time)
        write_network(system.network, folder)
        write_result(result, folder)
    return result, path


@dataclass(frozen=True, slots=True)
class CheckedRequest:
    """What is known of a run before it begins.

    Attributes:
        files: That it reads: the network, the specification, chronicles.
        kinds: Of manoeuvres that it scores.
    """

    files: tuple[Path, ...]
    kinds: tuple[str, ...]


def check_request(request: RunRequest) -> CheckedRequest:
    """Find out whether a run is possible, as far as that shows before the simulator starts.

    Raises:
        TrafficError: It is not, or a file cannot be read.
        NetworkError: The network cannot be read.
        SpecificationErrors: The specification has faults, or cannot have a new setting.
    """
    network = network_of(request.scenario)
    road_map = road_map_at(network)
    camera = camera_of(request.scenario.camera, road_map) if request.view is View.VISION else None
    world = World(road_map, _NoVehicles(), camera, generators_of(request.seed)[1])
    system = _system(request, _specification(request), world)
    specification = request.specification or bundled_specification()
    return CheckedRequest(
        files=(network, specification, *system.files),
        kinds=lines_scored(system.chronicles),
    )


class RequestChecks:
    """Checks many runs as `check_request` does, but those that are alike to it only once.

    They are if they differ in nothing but their seeds, their folders, and what the simulator alone
    is told. It is for runs that are checked at one time: a file that changes is not read again.
    """

    def __init__(self) -> None:
        self._found: dict[str, CheckedRequest | TrafficError | SpecificationErrors] = {}

    def check(self, request: RunRequest) -> CheckedRequest:
        """Find out whether a run is possible; see `check_request`."""
        key = _what_is_checked(request)
        if key not in self._found:
            try:
                self._found[key] = check_request(request)
            except (TrafficError, SpecificationErrors) as error:
                self._found[key] = error
        found = self._found[key]
        if isinstance(found, CheckedRequest):
            return found
        raise found


def _what_is_checked(request: RunRequest) -> str:
    """Return a text that tells runs apart whose checks may differ."""
    others = {"scenario", "seed", "out"}
    told = {
        each.name: getattr(request, each.name)
        for each in fields(request)
        if each.name not in others
    }
    scenario = request.scenario
    return repr((network_of(scenario), scenario.camera, scenario.recognise, told))


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


class _NoVehicles:
    """A source without samples."""

    def samples(self) -> Iterator[Sample[Table]]:
        """Yield nothing."""
        yield from ()


def scorer_for(world: World, simulation: Simulation, system: MonitoringSystem) -> Scorer:
    """Return what scores a run of *system* in *world*, by the truth that *simulation* knows."""
    footprint = world.camera.footprint() if world.camera is not None else None
    error = float(str(system.parameters.get("position_noise", 0)))
    return Scorer(world.road_map, simulation, footprint, system.chronicles, position_error=error)


def write_network(network: Network, folder: Path) -> None:
    """Write what the network looks like now into the folder of its run."""
    (folder / "network.json").write_text(snapshot(network).to_json(), encoding="utf-8")


def _specification(request: RunRequest) -> Specification:
    """Return the specification of a run, with the changes that are asked for."""
    return changed_specification(read_specification(request.specification), request.changes)


def _system(request: RunRequest, specification: Specification, world: World) -> MonitoringSystem:
    outputs = _outputs(request, specification)
    if request.overlay is not None:
        outputs += tuple(name for name in IMAGES if name not in outputs)
    parameters = _parameters(request, specification)
    return MonitoringSystem(world, parameters, outputs, specification=specification)


def outputs_recognising(
    specification: Specification, names: Collection[str] | None, place: str
) -> tuple[str, ...]:
    """Return the names of the output streams that are wanted, without those of images.

    Args:
        specification: Which output streams there are.
        names: What is to be recognised; None for everything.
        place: Where these names were written.

    Raises:
        RequestError: Something is to be recognised that the specification does not tell.
    """
    outputs = outputs_of(specification)
    told = outputs_behind(specification, labels_of_sort(specification, _RECOGNITIONS))
    by_name = {name.removeprefix(_RECOGNISED): name for name in told}
    if names is None:
        return outputs
    for name in names:
        if name not in by_name:
            hint = did_you_mean(nearest_name(name, by_name))
            expected = f"'all', or some of {', '.join(by_name)} with commas between them{hint}"
            raise RequestError(place, expected, name)
    unwanted = set(told) - {by_name[name] for name in names}
    return tuple(name for name in outputs if name not in unwanted)


def _outputs(request: RunRequest, specification: Specification) -> tuple[str, ...]:
    is_asked = request.recognise != request.scenario.recognise
    place = "--recognise" if is_asked else "'recognise' in the scenario"
    return outputs_recognising(specification, request.recognise, place)


def _description(request: RunRequest, system: MonitoringSystem) -> RunDescription:
    place = request.specification or bundled_specification()
    written = read_specification(request.specification)
    is_changed = changed_specification(written, request.changes) != written
    return RunDescription(
        origin=origin_of(request, system.files),
        text=text_from(system.specification) if is_changed else place.read_text(encoding="utf-8"),
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
    folder: Path,
) -> Iterator[RunRecorder | None]:
    """Record what the system does while the block lasts, if that was asked for."""
    if request.recording is None:
        yield None
        return
    note_recording(request.recording.path, folder)
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
    changed = parameters_in(request.changes, specification)
    for name in changed:
        if name in values:
            option = f"--{name.replace('_', '-')}"
            raise RequestError("--set", f"the option {option} for this parameter", name)
    return {name: value for name, value in values.items() if name in declared} | changed

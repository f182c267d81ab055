"""From a scenario to a running simulator."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from traffic.errors import SimulatorError
from traffic.scenarios.model import Scenario
from traffic.sumo.acts.director import beginnings
from traffic.sumo.configuration import read_options, relocate, write_configuration
from traffic.sumo.demand import departures, route_document
from traffic.sumo.simulator import SumoSettings, SumoSimulation
from traffic.sumo.topology import read_topology
from traffic.sumo.vehicle_types import base_types_document, text_of

__all__ = ["network_of", "open_simulation", "prepare"]

_SMOOTH = {"lanechange.duration": "2.5"}
_GENTLE = {"collision.action": "warn"}
_OURS = {"time-to-teleport": "-1"}
_SUBLANES = "lateral-resolution"


def open_simulation(
    scenario: Scenario, folder: Path, generator: np.random.Generator
) -> SumoSimulation:
    """Start SUMO on *scenario*; everything that is written goes into *folder*.

    The same state of *generator* gives the same traffic, step by step.

    Raises:
        SimulatorError: A file is missing or broken, or SUMO refuses to start.
    """
    demand, running, painting, acting = generator.spawn(4)
    configuration = prepare(scenario, folder, demand, seed=int(running.integers(2**31 - 1)))
    settings = SumoSettings(
        configuration=configuration,
        messages=folder / "messages.txt",
        step_length=scenario.step_length,
        duration=scenario.duration,
        warm_up=scenario.warm_up,
        vehicle_types=scenario.vehicle_types,
        acts=beginnings(scenario, acting),
    )
    return SumoSimulation(settings, painting)


def prepare(scenario: Scenario, folder: Path, generator: np.random.Generator, seed: int) -> Path:
    """Write SUMO's configuration for *scenario* into *folder* and return its path.

    `sumo -c` with that file runs the same traffic again.
    """
    folder.mkdir(parents=True, exist_ok=True)
    options = (
        _options_of_traffic(scenario, folder, generator)
        if scenario.sumocfg is None
        else _options_of_configuration(scenario.sumocfg, folder)
    )
    if scenario.acts:
        options = _with_base_types(options, scenario, folder)
    further = {name: text_of(value) for name, value in scenario.sumo.items()}
    path = folder / "simulation.sumocfg"
    write_configuration({**options, **further, "seed": str(seed)}, path)
    return path


def network_of(scenario: Scenario) -> Path:
    """Return the path of the compiled network on which *scenario* takes place.

    Raises:
        SimulatorError: The SUMO configuration is missing or broken, or names no network.
    """
    if scenario.network is not None:
        return scenario.network
    if scenario.sumocfg is None:
        raise SimulatorError(f"the scenario '{scenario.name}' names no network")
    options = read_options(scenario.sumocfg)
    if not options.get("net-file"):
        raise SimulatorError(f"the SUMO configuration '{scenario.sumocfg}' names no 'net-file'")
    return scenario.sumocfg.parent / options["net-file"]


def _options_of_traffic(
    scenario: Scenario, folder: Path, generator: np.random.Generator
) -> dict[str, str]:
    network = network_of(scenario).resolve()
    drawn = departures(scenario, read_topology(network), generator)
    routes = folder / "traffic.rou.xml"
    routes.write_text(route_document(scenario, drawn, generator), encoding="utf-8")
    return {"net-file": str(network), "route-files": routes.name, **_SMOOTH, **_GENTLE, **_OURS}


def _options_of_configuration(configuration: Path, folder: Path) -> dict[str, str]:
    configuration = configuration.resolve()
    options = read_options(configuration)
    moved = relocate(options, configuration.parent, folder)
    smooth: Mapping[str, str] = {} if _SUBLANES in options else _SMOOTH
    return {**smooth, **_GENTLE, **moved}


def _with_base_types(
    options: Mapping[str, str], scenario: Scenario, folder: Path
) -> dict[str, str]:
    """Return *options* with the types of the vehicles that acts bring in."""
    path = folder / "types.add.xml"
    path.write_text(base_types_document(scenario.vehicle_types), encoding="utf-8")
    others = options.get("additional-files", "")
    return {**options, "additional-files": f"{others},{path.name}" if others else path.name}

"""Scenarios with acts, and what happens in them."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from dyknow.time import MILLISECOND, SECOND, Duration
from traffic.scenarios import Scenario, VehicleType, find_scenario
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.acts.driving import Drive
from traffic.sumo.acts.stage import Stage
from traffic.sumo.libraries import load_simulator
from traffic.sumo.opening import open_simulation, prepare
from traffic.sumo.simulation import Frame

CAR = VehicleType(name="car", length=(4.0, 5.0), max_speed=(30.0, 30.0), speed_factor=(1.0, 1.0))


def rural(*acts: AnyAct, seconds: int = 20, warm_up: int = 0) -> Scenario:
    """Return a scenario on the country road without other traffic."""
    return Scenario(
        name="acts",
        network=find_scenario("rural").network,
        duration=Duration(seconds * SECOND),
        warm_up=Duration(warm_up * SECOND),
        step_length=Duration(100 * MILLISECOND),
        vehicle_types=(CAR,),
        acts=acts,
    )


def frames(scenario: Scenario, folder: Path, seed: int = 1) -> tuple[list[Frame], list[str]]:
    """Return all frames of a scenario, and the names of its vehicles."""
    with open_simulation(scenario, folder, np.random.default_rng(seed)) as simulation:

        def until_none() -> Iterator[Frame]:
            while (frame := simulation.step()) is not None:
                yield frame

        return list(until_none()), list(simulation.names)


@contextmanager
def empty_stage(folder: Path) -> Iterator[Stage]:
    """Yield a stage on the country road; what happens there is up to the caller."""
    never = Drive(
        kind="drive", types={"car": 1}, route=("west_junction",), times=(0,), speed=(9, 9)
    )
    scenario = rural(never)
    libsumo = load_simulator()
    generator = np.random.default_rng(1)
    configuration = prepare(scenario, folder, generator, seed=1)
    libsumo.start(["sumo", "-c", str(configuration), "--step-length", "0.1", "--no-step-log"])
    stage = Stage(libsumo, scenario.vehicle_types, 0.1)
    try:
        yield stage
    finally:
        stage.end()
        libsumo.close()


def step(stage: Stage, n: int = 1) -> None:
    """Let the simulator make *n* steps."""
    for _ in range(n):
        stage.api.simulationStep()
        stage.begin_step(stage.now + 0.1)

"""Drivers who run red lights do, and those who only seem to do not."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import MILLISECOND, SECOND, Duration
from networks.reading import read_road_map
from tests.support.staging import CAR
from traffic.scenarios import Scenario, find_scenario
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.acts.crossings import CreepOverLine, HaltInCrossing, RunRedLight
from traffic.scenarios.acts.wrong_way import DriveOpposite
from traffic.sumo.opening import open_simulation
from traffic.sumo.simulation import Frame
from traffic.truth.ground_truth import GroundTruth
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.watchers import WATCHERS

pytestmark = pytest.mark.sumo

THROUGH = {"types": {"car": 1}, "route": ("south_centre", "centre_north"), "speed": (11, 11)}


def truth(name: str, act: AnyAct, folder: Path, seconds: int = 80) -> list[TrueManoeuvre]:
    """Return what the vehicle of the act did, alone on a bundled network."""
    scenario = Scenario(
        name="acts",
        network=find_scenario(name).network,
        duration=Duration(seconds * SECOND),
        step_length=Duration(100 * MILLISECOND),
        vehicle_types=(CAR,),
        acts=(act,),
    )
    kinds = {kind: WATCHERS[kind] for kind in ("red_light", "stop_in_crossing", "wrong_way")}
    run, lanes = frames_and_lanes(scenario, folder)
    watched = GroundTruth(read_road_map(scenario.network or ""), lanes, kinds)
    for frame in run:
        watched.observe(frame)
    return watched.manoeuvres()


def frames_and_lanes(scenario: Scenario, folder: Path) -> tuple[list[Frame], list[str]]:
    """Return all frames of a scenario, and the names of its lanes."""
    with open_simulation(scenario, folder, np.random.default_rng(1)) as simulation:
        run = []
        while (frame := simulation.step()) is not None:
            run.append(frame)
        return run, list(simulation.lanes)


def test_a_driver_runs_the_red_light(tmp_path: Path) -> None:
    """Once, and some seconds after it has turned."""
    act = RunRedLight(kind="run_red_light", times=(0,), after=(4 * SECOND, 4 * SECOND), **THROUGH)

    assert [found.kind for found in truth("crossing", act, tmp_path, 120)] == ["red_light"]


def test_a_driver_who_only_stops_past_the_line_runs_no_light(tmp_path: Path) -> None:
    """Wherever in the cycle that is."""
    times = tuple(Duration(i * 9 * SECOND) for i in range(5))
    act = CreepOverLine(kind="creep_over_line", times=times, over=(1.5, 1.5), **THROUGH)

    assert truth("crossing", act, tmp_path) == []


@pytest.mark.parametrize(("seconds", "kinds"), [(7, ["stop_in_crossing"]), (3, [])])
def test_a_driver_halts_in_the_crossing(seconds: int, kinds: list[str], tmp_path: Path) -> None:
    """For as long as was said, which is a stop from five seconds on."""
    span = (Duration(seconds * SECOND),) * 2
    act = HaltInCrossing(
        kind="halt_in_crossing", times=(0,), into=(15, 15), duration=span, **THROUGH
    )

    assert [found.kind for found in truth("crossing", act, tmp_path)] == kinds


@pytest.mark.parametrize(("seconds", "kinds"), [(6, ["wrong_way"]), (0, [])])
def test_a_driver_is_on_the_other_side(seconds: int, kinds: list[str], tmp_path: Path) -> None:
    """For as long as was said, and a little while he goes over and comes back."""
    span = (Duration(seconds * SECOND),) * 2
    act = DriveOpposite(
        kind="drive_opposite",
        times=(0,),
        types={"car": 1},
        route=("west_junction",),
        speed=(12, 12),
        place=(100, 100),
        aside=(3.2, 3.2),
        going=(2 * SECOND, 2 * SECOND),
        duration=span,
    )

    assert [found.kind for found in truth("rural", act, tmp_path, seconds=40)] == kinds

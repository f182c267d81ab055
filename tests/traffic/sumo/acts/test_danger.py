"""Drivers who cut others off, and those who leave them room."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import MILLISECOND, SECOND, Duration
from networks.reading import read_road_map
from tests.support.staging import CAR
from traffic.scenarios import Scenario, find_scenario
from traffic.scenarios.acts import AnyAct
from traffic.scenarios.acts.danger import BrakeLate, CrossWithRoom, CutOff
from traffic.sumo.opening import open_simulation
from traffic.truth.ground_truth import GroundTruth
from traffic.truth.manoeuvres import TrueManoeuvre
from traffic.truth.watchers import WATCHERS

pytestmark = pytest.mark.sumo

CROSSING = {
    "types": {"car": 1},
    "route": ("east_south-se", "se-ne"),
    "place": (60.0, 80.0),
    "other_route": ("south_east-se", "se-sw"),
    "other_types": {"car": 1},
    "other_place": (255.0, 275.0),
    "other_speed": (9.0, 10.0),
}


def quarter(act: AnyAct) -> Scenario:
    """Return a scenario in the quarter without other traffic."""
    network = find_scenario("near_collision").network
    return Scenario(
        name="danger", network=network, duration=Duration(40 * SECOND),
        step_length=Duration(SECOND // 20), vehicle_types=(CAR,), acts=(act,),
    )  # fmt: skip


def near_collisions(act: AnyAct, folder: Path, seed: int = 1) -> list[TrueManoeuvre]:
    """Return what truly happens when an act is performed."""
    scenario = quarter(act)
    with open_simulation(scenario, folder, np.random.default_rng(seed)) as simulation:
        road_map = read_road_map(scenario.network or "")
        kinds = {"near_collision": WATCHERS["near_collision"]}
        truth = GroundTruth(road_map, simulation.lanes, kinds)
        while (frame := simulation.step()) is not None:
            truth.observe(frame)
        return truth.manoeuvres()


def test_who_cuts_another_off_nearly_collides(tmp_path: Path) -> None:
    """Both drivers of the act, once."""
    brakes_at = (Duration(600 * MILLISECOND), Duration(650 * MILLISECOND))
    act = CutOff(kind="cut_off", times=(0,), brakes_at=brakes_at, **CROSSING)

    assert [found.vehicles for found in near_collisions(act, tmp_path)] == [(0, 1)]


def test_who_crosses_with_room_does_not(tmp_path: Path) -> None:
    """The other one comes when the first is gone."""
    gap = (Duration(1200 * MILLISECOND), Duration(1500 * MILLISECOND))
    act = CrossWithRoom(kind="cross_with_room", times=(0,), gap=gap, **CROSSING)

    assert near_collisions(act, tmp_path) == []


def test_who_brakes_late_nearly_collides_with_who_stands(tmp_path: Path) -> None:
    """The one who stands is the first vehicle."""
    act = BrakeLate(
        kind="brake_late", types={"car": 1}, route=("south_east-se",), times=(0,),
        speed=(11.0, 11.0), place=(150.0, 150.0), duration=(Duration(30 * SECOND),) * 2,
    )  # fmt: skip

    assert [found.vehicles for found in near_collisions(act, tmp_path)] == [(0, 1)]

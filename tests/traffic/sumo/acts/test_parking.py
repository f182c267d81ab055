"""Drivers who park stand beside the lane for as long as was said, and come back."""

from pathlib import Path

import numpy as np
import pytest

from dyknow.time import SECOND, Duration
from networks.reading import read_road_map
from tests.support.staging import CAR, frames
from traffic.scenarios import Scenario, find_scenario
from traffic.scenarios.acts.parking import Park
from traffic.sumo.simulation import Frame

pytestmark = pytest.mark.sumo


def street(*acts: Park, seconds: int = 60) -> Scenario:
    """Return a scenario on the high street without other traffic."""
    network = find_scenario("parking").network
    return Scenario(
        name="parking", network=network, duration=Duration(seconds * SECOND),
        step_length=Duration(SECOND // 10), vehicle_types=(CAR,), acts=acts,
    )  # fmt: skip


def park(times: tuple[int, ...], places: tuple[float, ...], seconds: int = 10) -> Park:
    """Return drivers who come at these times and choose among these places."""
    return Park(
        kind="park", types={"car": 1}, route=("west_lights", "lights_east"), speed=(12, 12),
        times=tuple(Duration(time * SECOND) for time in times), places=places, aside=(3, 3),
        duration=(Duration(seconds * SECOND), Duration(seconds * SECOND)),
    )  # fmt: skip


def of_vehicle(run: list[Frame], vehicle: int, column: str) -> np.ndarray:
    """Return a column of one vehicle, frame by frame."""
    return np.array(
        [
            f.vehicles[column][f.vehicles.ids == vehicle][0]
            for f in run
            if vehicle in f.vehicles.ids
        ]
    )


def test_a_driver_parks_in_the_bay_and_leaves_it(tmp_path: Path) -> None:
    """Smoothly, for the time that was drawn, and back onto the lane."""
    run, _ = frames(street(park((0,), (190.0,))), tmp_path)

    road_map = read_road_map(find_scenario("parking").network or "")
    position, speed = of_vehicle(run, 0, "position"), of_vehicle(run, 0, "speed")
    standing = (speed < 0.01) & (position[:, 1] < -3.0)  # not at the lights
    assert np.count_nonzero(standing) == pytest.approx(100, abs=8)
    np.testing.assert_allclose(position[standing][:, 1], -1.75 - 3.0, atol=0.5)
    np.testing.assert_allclose(
        position[standing][:, 0] + CAR.length[0] / 2, -260.0 + 190.0, atol=0.6
    )
    assert np.abs(np.diff(position, axis=0)).max() < 1.5
    heading = np.degrees(of_vehicle(run, 0, "heading"))
    assert abs(heading[standing][-1]) < 15.0
    assert position[-1][0] > position[standing][-1][0] + 50
    assert road_map.locate(position[-1:]).lane[0] >= 0


def test_no_two_drivers_choose_one_place(tmp_path: Path) -> None:
    """Who finds no place drives on."""
    run, names = frames(street(park((0, 4), (190.0,), seconds=25)), tmp_path)

    stood = [bool((of_vehicle(run, i, "speed") < 0.01).any()) for i in range(len(names))]
    assert sorted(stood) == [False, True]

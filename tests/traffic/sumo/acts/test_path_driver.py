"""A path driver puts the vehicle exactly where its path says, on the road and off it."""

from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.staging import empty_stage, step
from traffic.sumo.acts.native_driver import NativeDriver
from traffic.sumo.acts.path_driver import PathDriver, towards
from traffic.sumo.acts.performance import VehicleGoneError
from traffic.sumo.acts.stage import Entrance, Stage

pytestmark = pytest.mark.sumo

ROAD = "junction_east"


def come_in(stage: Stage) -> str:
    """Let a car come in at 10 m/s and return its name."""
    entrance = Entrance("car", (ROAD,), place=50.0, speed=10.0)
    vehicle = stage.enter(entrance, np.random.default_rng(1))
    step(stage, 2)
    return vehicle


def test_the_front_of_the_vehicle_is_where_the_path_says(tmp_path: FilePath) -> None:
    """Along the lane, swaying, and off the road; then it is SUMO's again."""
    with empty_stage(tmp_path) as stage:
        vehicle = come_in(stage)
        driver = PathDriver(stage, vehicle, stage.lane_path((ROAD,)))
        begin = driver.s
        wrong = []
        for i in range(100):
            driver.move(10.0, aside=-6.0 * np.sin(i / 100 * np.pi) ** 2)
            step(stage)
            x, y = stage.api.vehicle.getPosition(vehicle)
            wrong.append(np.hypot(*np.subtract((x, y), driver.path.point(driver.s, driver.aside))))
        assert max(wrong) < 0.01
        assert driver.s == pytest.approx(begin + 100.0)
        step(stage, 20)
        assert stage.is_here(vehicle)
        assert stage.api.vehicle.getRoadID(vehicle) == ROAD


def test_a_vehicle_that_is_left_alone_off_the_road_is_gone(tmp_path: FilePath) -> None:
    """Its driver says so when it is moved again."""
    with empty_stage(tmp_path) as stage:
        driver = PathDriver(stage, come_in(stage), stage.lane_path((ROAD,)))
        for i in range(60):
            driver.move(5.0, aside=-0.15 * i)
            step(stage)
        step(stage, 2)

        with pytest.raises(VehicleGoneError):
            driver.move(5.0, aside=-9.0)


def test_a_vehicle_that_has_not_come_in_cannot_be_asked(tmp_path: FilePath) -> None:
    """Until there is room for it, it is not there."""
    with empty_stage(tmp_path) as stage:
        vehicle = stage.enter(Entrance("car", (ROAD,)), np.random.default_rng(1))
        driver = NativeDriver(stage, vehicle)

        assert not driver.is_here
        with pytest.raises(VehicleGoneError):
            _ = driver.speed


@settings(derandomize=True, deadline=None, max_examples=100)
@given(value=st.floats(-50, 50), wanted=st.floats(-50, 50), step_size=st.floats(0, 5))
def test_a_value_goes_towards_what_is_wanted(
    value: float, wanted: float, step_size: float
) -> None:
    """By at most one step, never past it."""
    found = towards(value, wanted, step_size)

    assert abs(found - value) <= step_size + 1e-9
    assert abs(wanted - found) <= abs(wanted - value)
    assert min(value, wanted) <= found <= max(value, wanted)

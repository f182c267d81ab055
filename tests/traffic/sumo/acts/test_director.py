"""Acts begin when they are due, the same way for the same seed, and end with their vehicles."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from dyknow.time import SECOND, Duration
from tests.support.staging import CAR, empty_stage, frames, rural, step
from traffic.scenarios import find_scenario, scenario_of_configuration
from traffic.scenarios.acts.driving import Drive, Halt
from traffic.sumo.acts.director import Director, beginnings
from traffic.sumo.acts.native_driver import NativeDriver
from traffic.sumo.acts.performance import Script
from traffic.sumo.acts.registry import performance_of
from traffic.sumo.acts.stage import Entrance, Stage

pytestmark = pytest.mark.sumo

ROUTE = ("west_junction", "junction_east")
SLOW = Drive(kind="drive", types={"car": 1}, route=ROUTE, times=(0, 5 * SECOND), speed=(8, 12))
OFTEN = Drive(kind="drive", types={"car": 1}, route=ROUTE, rate_per_hour=360, speed=(8, 12))


def test_given_times_are_kept_and_rates_cover_the_warm_up() -> None:
    """A rate gives random times from the warm-up to the end; given times are as given."""
    due = beginnings(rural(SLOW, OFTEN, seconds=3600, warm_up=1800), np.random.default_rng(4))

    given = [each.time for each in due if each.act is SLOW]
    drawn = [each.time for each in due if each.act is OFTEN]
    assert given == [0.0, 5.0]
    assert len(drawn) == pytest.approx(540, abs=70)
    assert -1800 <= drawn[0] < -1600
    assert 3400 < drawn[-1] < 3600
    assert [each.time for each in due] == sorted(each.time for each in due)


def test_acts_are_the_same_for_the_same_seed(tmp_path: Path) -> None:
    """To the last bit; another seed gives other vehicles and other speeds."""
    scenario = rural(SLOW, OFTEN, seconds=15)

    runs = [frames(scenario, tmp_path / str(i), seed)[0] for i, seed in enumerate((1, 1, 2))]

    positions = [[f.vehicles["position"].tobytes() for f in each] for each in runs]
    assert positions[0] == positions[1]
    assert positions[0] != positions[2]


def test_acts_leave_the_other_traffic_as_it_is_drawn() -> None:
    """A scenario with acts draws the same vehicles for its flows as one without."""
    due = beginnings(rural(SLOW, OFTEN), np.random.default_rng(4))
    alone = beginnings(rural(SLOW), np.random.default_rng(4))

    assert [each.time for each in due if each.act is SLOW] == [each.time for each in alone]


def test_a_driver_holds_the_speed_that_was_drawn(tmp_path: Path) -> None:
    """The vehicles come at their times, with bodies of their type, and drive as they are told."""
    run, names = frames(rural(SLOW), tmp_path)

    first, last = next(f for f in run if len(f.vehicles)), run[-1]
    assert first.time == 0
    assert names == ["car.act0", "car.act1"]
    assert np.all((last.vehicles["length"] >= 4.0) & (last.vehicles["length"] <= 5.0))
    assert np.ptp(last.vehicles["length"]) > 0
    assert np.all((last.vehicles["speed"] > 7.9) & (last.vehicles["speed"] < 12.1))


def test_a_driver_halts_where_and_as_long_as_was_said(tmp_path: Path) -> None:
    """It stands on its lane, and drives on afterwards."""
    act = Halt(
        kind="halt", types={"car": 1}, route=("junction_east",), times=(0,), place=(200, 200),
        duration=(4 * SECOND, 4 * SECOND),
    )  # fmt: skip

    run, _ = frames(rural(act, seconds=16), tmp_path)

    standing = [f for f in run if len(f.vehicles) and f.vehicles["speed"][0] < 0.01 and f.time > 0]
    place = {round(float(f.hidden["lane_position"][0]), 1) for f in standing}
    assert len(standing) == pytest.approx(40, abs=2)
    assert place == {200.0}
    assert run[-1].vehicles["speed"][0] > 3


def test_acts_come_into_the_traffic_of_a_configuration(tmp_path: Path) -> None:
    """A SUMO configuration that brings its own traffic takes acts as well."""
    (tmp_path / "r.rou.xml").write_text("<routes/>")
    network = find_scenario("rural").network
    (tmp_path / "c.sumocfg").write_text(
        f'<configuration><net-file value="{network}"/>'
        '<route-files value="r.rou.xml"/></configuration>'
    )
    plain = scenario_of_configuration(tmp_path / "c.sumocfg", Duration(2 * SECOND))
    scenario = plain.model_copy(update={"vehicle_types": (CAR,), "acts": (SLOW,)})

    _, names = frames(scenario, tmp_path / "run")

    assert names == ["car.act0"]


def test_a_performance_ends_when_its_vehicle_is_gone(tmp_path: Path) -> None:
    """Whatever it still meant to do; what it holds is given back first."""
    ended: list[str] = []

    def play(stage: Stage) -> Iterator[None]:
        vehicle = stage.enter(Entrance("car", ROUTE), np.random.default_rng(1))
        with NativeDriver(stage, vehicle) as driver:
            try:
                while not driver.is_here:
                    yield
                while True:
                    driver.drive_at(5.0)
                    yield
            finally:
                ended.append(vehicle)

    with empty_stage(tmp_path) as stage:
        script = Script(lambda: play(stage))
        director = Director([])
        director._running.append(script)  # noqa: SLF001, an act of its own for this test
        for _ in range(30):
            director.step(stage, stage.now)
            step(stage)
        assert director.n_running == 1
        stage.api.vehicle.remove("car.act0")
        step(stage, 2)
        director.step(stage, stage.now)

    assert ended == ["car.act0"]
    assert director.n_running == 0


def test_every_kind_can_be_performed() -> None:
    """The registry knows what performs each act."""
    for act in (SLOW, Halt(kind="halt", types={"car": 1}, route=ROUTE, times=(0,), place=(9, 9),
                           duration=(0, 0))):  # fmt: skip
        assert performance_of(act, None, np.random.default_rng(1)) is not None  # type: ignore[arg-type]

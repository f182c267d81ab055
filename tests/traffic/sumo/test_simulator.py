"""SUMO in this process, from scenarios and from configurations."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from dyknow.time import MILLISECOND, SECOND, Duration
from traffic.errors import SimulatorError
from traffic.scenarios import Scenario, find_scenario, scenario_of_configuration
from traffic.scenarios.model import Flow, VehicleType
from traffic.sumo.opening import network_of, open_simulation
from traffic.sumo.simulation import Frame

pytestmark = pytest.mark.sumo

EIGHT_SECONDS = Duration(8 * SECOND)
BOLOGNA = Path("/work/shared/networks/bologna-acosta/run.sumocfg")


def one_car(duration: Duration = EIGHT_SECONDS, **sumo: str) -> Scenario:
    """Return a scenario in which cars of 4 m drive along the country road."""
    crossing = find_scenario("rural")
    car = VehicleType(name="car", length=(4.0, 4.0), speed_factor=(0.5, 0.5))
    flow = Flow(route=("west_junction",), rate_per_hour=3600, types={"car": 1})
    return Scenario(
        name="one",
        network=crossing.network,
        duration=duration,
        vehicle_types=(car,),
        flows=(flow,),
        step_length=Duration(100 * MILLISECOND),
        sumo=sumo,
    )


def run(scenario: Scenario, folder: Path, seed: int = 1) -> list[Frame]:
    """Return all frames of a scenario."""

    def frames() -> Iterator[Frame]:
        with open_simulation(scenario, folder, np.random.default_rng(seed)) as simulation:
            while (frame := simulation.step()) is not None:
                yield frame

    return list(frames())


def test_frames_come_at_every_step_from_the_begin_to_the_end(tmp_path: Path) -> None:
    """The first frame has time 0, the last the duration."""
    frames = run(one_car(), tmp_path)

    assert [frame.time for frame in frames] == [i * 100 * MILLISECOND for i in range(81)]


def test_a_car_moves_by_its_speed_along_its_heading(tmp_path: Path) -> None:
    """Positions are those of the body's centre; heading and speed are those of its motion."""
    frames = [frame for frame in run(one_car(), tmp_path) if 0 in frame.vehicles.ids]

    rows = [frame.vehicles.row(0) for frame in frames]
    position = np.array([row["position"] for row in rows if row])
    heading = np.array([row["heading"] for row in rows if row])
    speed = np.array([row["speed"] for row in rows if row])
    moved = np.diff(position, axis=0)
    assert len(frames) > 10
    np.testing.assert_allclose(np.hypot(*moved.T), speed[1:] * 0.1, atol=0.02)
    np.testing.assert_allclose(np.arctan2(*moved.T[::-1]), heading[1:], atol=0.02)
    first = frames[0]
    front = first.hidden["lane_position"][0]
    start = np.array([-877.49, -78.0])  # where the lane begins
    behind = np.hypot(*(position[0] - start))
    assert abs(behind - abs(front - 2.0)) < 0.1


def test_columns_have_their_types(tmp_path: Path) -> None:
    """Every column of a frame is there, with one row for each vehicle."""
    frame = run(one_car(), tmp_path)[-1]

    n = len(frame.vehicles)
    assert n > 0
    assert {name: (c.dtype.name, c.shape) for name, c in frame.vehicles.columns.items()} == {
        "position": ("float64", (n, 2)),
        "heading": ("float64", (n,)),
        "speed": ("float64", (n,)),
        "length": ("float64", (n,)),
        "width": ("float64", (n,)),
        "height": ("float64", (n,)),
        "colour": ("uint8", (n, 3)),
        "vehicle_class": ("int8", (n,)),
    }
    assert frame.hidden["lane"].dtype == np.int32


def test_the_same_seed_gives_the_same_frames(tmp_path: Path) -> None:
    """A run can be repeated to the last bit; another seed gives other traffic."""
    runs = [run(find_short(), tmp_path / str(i), seed) for i, seed in enumerate((1, 1, 2))]

    bytes_of = [[frame.vehicles["position"].tobytes() for frame in frames] for frames in runs]
    assert bytes_of[0] == bytes_of[1]
    assert bytes_of[0] != bytes_of[2]


def find_short() -> Scenario:
    """Return two seconds of the bundled crossing after a short warm-up."""
    short = {"duration": Duration(2 * SECOND), "warm_up": Duration(4 * SECOND)}
    return find_scenario("crossing").model_copy(update=short)


def test_nothing_reaches_the_terminal(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """What SUMO prints, even when it is told to talk, goes to a file of the run."""
    run(one_car(verbose="true"), tmp_path)

    assert capfd.readouterr() == ("", "")
    assert "Loading" in (tmp_path / "messages.txt").read_text()


def test_a_bad_option_is_explained(tmp_path: Path) -> None:
    """SUMO's own words are part of the message, and the next simulation can start."""
    with pytest.raises(SimulatorError, match=r"(?s)SUMO cannot start.*no-such-option"):
        run(one_car(**{"no-such-option": "1"}), tmp_path / "a")

    assert run(one_car(duration=Duration(SECOND)), tmp_path / "b")


def test_a_failure_on_the_way_is_explained(tmp_path: Path) -> None:
    """When SUMO gives up while it runs, the time and its words are in the message."""
    routes = tmp_path / "bad.rou.xml"
    routes.write_text(
        '<routes><trip id="w" depart="2" from="west_junction" to="west_junction"/>'
        '<trip id="x" depart="3" from="west_junction" to="nowhere"/></routes>'
    )
    configuration = tmp_path / "bad.sumocfg"
    network = find_scenario("rural").network
    configuration.write_text(
        f'<configuration><net-file value="{network}"/><route-files value="bad.rou.xml"/>'
        '<route-steps value="1"/></configuration>'
    )

    with pytest.raises(SimulatorError, match=r"(?s)SUMO failed at \d+ ms.*nowhere"):
        run(scenario_of_configuration(configuration), tmp_path / "run")


def test_a_missing_network_is_explained(tmp_path: Path) -> None:
    """A configuration whose network is missing gives a message with its path."""
    configuration = tmp_path / "bad.sumocfg"
    configuration.write_text('<configuration><net-file value="gone.net.xml"/></configuration>')

    with pytest.raises(SimulatorError, match=r"(?s)SUMO cannot start.*gone\.net\.xml"):
        run(scenario_of_configuration(configuration), tmp_path / "run")
    assert network_of(scenario_of_configuration(configuration)) == tmp_path / "gone.net.xml"


def test_a_closed_simulation_has_no_more_frames(tmp_path: Path) -> None:
    """Closing twice is no fault; afterwards there is nothing to step to."""
    simulation = open_simulation(one_car(), tmp_path, np.random.default_rng(1))

    simulation.close()
    simulation.close()

    assert simulation.step() is None


def test_time_begins_with_the_begin_of_the_configuration(tmp_path: Path) -> None:
    """Whatever time of day a scenario has, its first frame has time 0."""
    routes = tmp_path / "r.rou.xml"
    routes.write_text(
        '<routes><trip id="x" depart="36001" from="west_junction" to="west_junction"/></routes>'
    )
    (tmp_path / "c.sumocfg").write_text(
        f'<configuration><net-file value="{find_scenario("rural").network}"/>'
        '<route-files value="r.rou.xml"/><begin value="36000"/></configuration>'
    )
    scenario = scenario_of_configuration(tmp_path / "c.sumocfg", Duration(2 * SECOND))

    frames = run(scenario, tmp_path / "run")

    there = [frame.time for frame in frames if len(frame.vehicles)]
    assert frames[0].time == 0
    assert there[0] == SECOND


@pytest.mark.skipif(not BOLOGNA.exists(), reason="the shared networks are absent")
def test_a_real_town_runs_and_its_folder_stays_as_it_was(tmp_path: Path) -> None:
    """All that the town's configuration writes is in the run's folder."""
    before = sorted(BOLOGNA.parent.iterdir())
    scenario = scenario_of_configuration(BOLOGNA, Duration(3 * SECOND))

    frames = run(scenario, tmp_path / "run")

    assert len(frames[-1].vehicles)
    assert len(np.unique(frames[-1].vehicles["colour"], axis=0)) > 1
    assert sorted(BOLOGNA.parent.iterdir()) == before
    written = {path.name for path in (tmp_path / "run" / "output").iterdir()}
    assert written == {"e1_output.xml", "sumo_log.txt", "tripinfos.xml"}

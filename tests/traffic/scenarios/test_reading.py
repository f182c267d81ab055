"""Scenario files: what they say, and what is said about their faults."""

from pathlib import Path

import pytest

from dyknow.time import MILLISECOND, MINUTE, SECOND
from traffic.errors import ScenarioError
from traffic.scenarios import (
    bundled_scenarios,
    find_scenario,
    read_scenario,
    scenario_of_configuration,
)

GOOD = """
network = "rural"
duration = "2 min"
[camera]
look_at = [0, 0]
[[vehicle_types]]
name = "car"
length = [3.8, 5.2]
[[flows]]
route = ["west_junction"]
rate_per_hour = 100
types = { car = 1 }
"""


def read(text: str, folder: Path) -> ScenarioError:
    """Return the error that reading the text gives."""
    path = folder / "s.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    return caught.value


def faults(text: str, folder: Path) -> list[str]:
    """Return the faults of a text, without folder and excerpt."""
    found = read(text, folder).faults
    return [fault.split("\n")[0].removeprefix(f"{folder}/") for fault in found]


def test_the_bundled_scenarios_can_be_read() -> None:
    """A crossing, a country road and others, each with a camera and a sentence about it."""
    scenarios = bundled_scenarios()

    assert {"crossing", "rural"} <= {scenario.name for scenario in scenarios}
    assert all(scenario.description and scenario.camera for scenario in scenarios)


def test_a_scenario_is_found_by_name_or_path(tmp_path: Path) -> None:
    """A bundled name, or a file; what the file leaves out has a default."""
    path = tmp_path / "mine.toml"
    path.write_text(GOOD)

    mine = find_scenario(str(path))

    assert find_scenario("crossing").name == "crossing"
    assert (mine.name, mine.duration, mine.warm_up) == ("mine", 2 * MINUTE, 0)
    assert mine.step_length == 40 * MILLISECOND
    assert mine.flows[0].route == ("west_junction",)


def test_an_unknown_name_suggests_the_nearest() -> None:
    """A misspelt bundled name is answered with the right one."""
    with pytest.raises(
        ScenarioError, match="no scenario called 'crosing'; did you mean 'crossing'"
    ):
        find_scenario("crosing")


def test_all_faults_are_told_at_once_with_their_places(tmp_path: Path) -> None:
    """Unknown keys, impossible values and missing keys, each at its line and column."""
    text = """network = "rural"
duratoin = "60 s"
warm_up = "-1 s"
[camera]
look_at = "nowhere"
altitude = 0
heigth = 7
[[flows]]
route = []
rate_per_hour = "many"
"""
    assert faults(text, tmp_path) == [
        "s.toml:1:1: the key 'duration' is missing",
        "s.toml:2:1: no key called 'duratoin' here; did you mean 'duration'?",
        "s.toml:3:1: expected greater than or equal to 0, found '-1 s'",
        "s.toml:6:1: expected greater than 0, found 0",
        "s.toml:7:1: no key called 'heigth' here; did you mean 'height'?",
        "s.toml:8:1: the key 'types' is missing",
        "s.toml:9:1: expected at least one item for 'route', found none",
        "s.toml:10:1: expected a valid number, found 'many'",
    ]


def test_names_must_stand_for_something(tmp_path: Path) -> None:
    """Vehicle types, roads and junctions that do not exist are faults, with the nearest."""
    text = (
        GOOD.replace("{ car = 1 }", "{ cra = 1 }")
        .replace('["west_junction"]', '["west_juntcion"]')
        .replace("[0, 0]", '"junktion"')
    )

    assert faults(text, tmp_path) == [
        "s.toml:5:1: no junction called 'junktion'; did you mean 'junction'?",
        "s.toml:10:1: no road called 'west_juntcion'; did you mean 'west_junction'?",
        "s.toml:12:11: no vehicle type called 'cra'; did you mean 'car'?",
    ]


def test_files_must_exist(tmp_path: Path) -> None:
    """A network is a bundled name or a file beside the scenario; a configuration is a file."""
    (network,) = faults(GOOD.replace('"rural"', '"rurall"'), tmp_path)
    (configuration,) = faults('sumocfg = "x.sumocfg"\nduration = "1 s"', tmp_path)

    assert "no network called 'rurall'; did you mean 'rural'?" in network
    assert configuration.startswith("s.toml:1:1: no SUMO configuration at")


def test_traffic_has_one_source(tmp_path: Path) -> None:
    """A scenario has a network or a configuration, not both and not neither."""
    assert faults('duration = "1 s"', tmp_path) == [
        "s.toml:1:1: expected either 'network' or 'sumocfg'"
    ]


def test_ranges_are_in_order(tmp_path: Path) -> None:
    """The smaller number of a range stands first."""
    (fault,) = faults(GOOD.replace("[3.8, 5.2]", "[5.2, 3.8]"), tmp_path)

    assert fault == "s.toml:6:1: expected the smaller number first, in [5.2, 3.8]"


def test_broken_toml_has_a_place(tmp_path: Path) -> None:
    """What is no TOML at all is told with line and column."""
    assert faults('network = "rural"\nduration = ', tmp_path) == ["s.toml:2:12: invalid value"]


def test_a_file_that_cannot_be_read_is_a_fault_of_the_user(tmp_path: Path) -> None:
    """Missing files and texts in another encoding give a message."""
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe")

    with pytest.raises(ScenarioError, match="cannot read"):
        find_scenario(str(tmp_path / "missing.toml"))
    with pytest.raises(ScenarioError, match="not a text in UTF-8"):
        find_scenario(str(tmp_path / "binary.toml"))


def test_any_configuration_is_a_scenario(tmp_path: Path) -> None:
    """A SUMO configuration runs for the time asked for."""
    path = tmp_path / "town.sumocfg"
    path.touch()

    assert scenario_of_configuration(path, SECOND).duration == SECOND
    with pytest.raises(ScenarioError, match="no SUMO configuration"):
        scenario_of_configuration(tmp_path / "nothing.sumocfg")

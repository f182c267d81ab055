"""Acts in scenario files: what they say, and what is said about their faults."""

from pathlib import Path

import pytest

from dyknow.time import SECOND
from traffic.errors import ScenarioError
from traffic.scenarios import Scenario, read_scenario
from traffic.scenarios.acts import ACTS
from traffic.scenarios.acts.driving import Drive, Halt

GOOD = """
network = "rural"
duration = "2 min"
[[vehicle_types]]
name = "car"
[[acts]]
kind = "drive"
types = { car = 1 }
route = ["west_junction"]
times = ["10 s", 500]
speed = [8, 12]
[[acts]]
kind = "halt"
types = { car = 1 }
route = ["west_junction", "junction_east"]
rate_per_hour = 100
place = 40
duration = ["5 s", "9 s"]
"""


def scenario_of(text: str, folder: Path) -> Scenario:
    """Return the scenario that a text says."""
    path = folder / "s.toml"
    path.write_text(text, encoding="utf-8")
    return read_scenario(path)


def faults(text: str, folder: Path) -> list[str]:
    """Return the faults of a text, without folder and excerpt."""
    with pytest.raises(ScenarioError) as caught:
        scenario_of(text, folder)
    return [fault.split("\n")[0].removeprefix(f"{folder}/") for fault in caught.value.faults]


def test_the_kind_of_an_act_says_what_else_it_has(tmp_path: Path) -> None:
    """Durations become nanoseconds, and a single number is a range of one."""
    drive, halt = scenario_of(GOOD, tmp_path).acts

    assert isinstance(drive, Drive)
    assert drive.times == (10 * SECOND, SECOND // 2)
    assert drive.speed == (8.0, 12.0)
    assert isinstance(halt, Halt)
    assert halt.place == (40.0, 40.0)
    assert halt.duration == (5 * SECOND, 9 * SECOND)


def test_a_scenario_with_acts_survives_being_written_down(tmp_path: Path) -> None:
    """What a run keeps of its scenario says the same acts again."""
    scenario = scenario_of(GOOD, tmp_path)

    assert Scenario.model_validate_json(scenario.model_dump_json()) == scenario


def test_all_faults_of_acts_have_places(tmp_path: Path) -> None:
    """Unknown kinds, keys, types and roads, and missing keys, each with what may be meant."""
    text = GOOD.replace('"halt"', '"hlat"').replace("speed =", "sped =")

    assert faults(text, tmp_path) == [
        "s.toml:6:1: the key 'speed' is missing",
        "s.toml:11:1: no key called 'sped' here; did you mean 'speed'?",
        "s.toml:13:1: no kind of act called 'hlat'; did you mean 'halt'?",
    ]


def test_names_in_acts_must_stand_for_something(tmp_path: Path) -> None:
    """Vehicle types and roads that do not exist are faults at their keys."""
    text = GOOD.replace("{ car = 1 }", "{ cra = 1 }").replace('"junction_east"', '"junctoin"')

    assert faults(text, tmp_path) == [
        "s.toml:8:11: no vehicle type called 'cra'; did you mean 'car'?",
        "s.toml:14:11: no vehicle type called 'cra'; did you mean 'car'?",
        "s.toml:15:1: no road called 'junctoin'; did you mean 'west_junction'?",
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("rate_per_hour = 100", "", "expected either 'rate_per_hour' or 'times'"),
        (
            "place = 40",
            'place = 40\ntimes = ["1 s"]',
            "expected either 'rate_per_hour' or 'times'",
        ),
        ("[8, 12]", "[12, 8]", "expected the smaller number first, in [12.0, 8.0]"),
        ("[8, 12]", "[8, 120]", "expected less than or equal to 100, found 120"),
        ('["5 s", "9 s"]', '["9 s", "5 s"]', "expected the shorter duration first"),
        ('["5 s", "9 s"]', '["5 s"]', "expected a duration, or [shortest, longest]"),
        ('kind = "halt"', "", "the key 'kind' is missing"),
    ],
)
def test_impossible_values_are_faults(tmp_path: Path, old: str, new: str, expected: str) -> None:
    """Each with one message at the act or at the key."""
    (fault,) = faults(GOOD.replace(old, new), tmp_path)

    assert expected in fault


def test_every_kind_has_its_name() -> None:
    """The table of kinds agrees with the classes, and every class says what it is."""
    for kind, act in ACTS.items():
        assert act.model_fields["kind"].annotation.__args__ == (kind,)  # type: ignore[union-attr]
        assert act.__doc__

"""The page on scenarios agrees with what can be read."""

import re
from pathlib import Path

import pytest

from traffic.scenarios import Scenario, read_scenario
from traffic.scenarios.acts import ACTS, Act
from traffic.scenarios.fields import Settings
from traffic.scenarios.model import (
    CameraSettings,
    Circulation,
    Flow,
    Trips,
    TurnShares,
    VehicleType,
)

PAGE = (Path(__file__).parents[3] / "docs" / "scenarios.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^##+ (.+?)\n(.*?)(?=^##|\Z)", PAGE, re.MULTILINE | re.DOTALL))


def test_the_example_is_a_scenario(tmp_path: Path) -> None:
    """The whole example can be read as it stands."""
    (example,) = re.findall(r"```toml town.toml\n(.*?)```", PAGE, re.DOTALL)
    path = tmp_path / "town.toml"
    path.write_text(example, encoding="utf-8")

    scenario = read_scenario(path)

    assert scenario.acts[0].kind == "drive"


@pytest.mark.parametrize(
    ("section", "models"),
    [
        ("The file", [Scenario]),
        ("`[camera]`", [CameraSettings]),
        ("`[[vehicle_types]]`", [VehicleType]),
        ("`[[flows]]`, `[[trips]]`, `[[circulations]]`", [Flow, Trips, Circulation, TurnShares]),
        ("`[[acts]]`", [Act]),
    ],
)
def test_every_key_is_documented(section: str, models: list[type[Settings]]) -> None:
    """What a table may hold stands in the section about it."""
    documented = set(re.findall(r"^\|.*$", SECTIONS[section], re.MULTILINE))
    named = {name for row in documented for name in re.findall(r"`(\w+)`", row)}
    keys = {key for model in models for key in model.model_fields} - {"name"}

    assert keys - named == set()


@pytest.mark.parametrize("kind", ACTS)
def test_every_kind_of_act_is_documented(kind: str) -> None:
    """Each with all the keys that acts in general do not have."""
    own = set(ACTS[kind].model_fields) - set(Act.model_fields) - {"kind"}

    rows = re.findall(r"^\| (`.*?) \|", SECTIONS[f"`{kind}`"], re.MULTILINE)
    assert own <= {name for row in rows for name in re.findall(r"`(\w+)`", row)}

"""Scenarios: what happens where, for how long, and from where it is watched.

Read in this order: `fields` (kinds of values), `acts` (what drivers do on purpose), `model` (what
a scenario consists of), `reading` (from TOML files, with every fault), `changing` (with new values
in place of some of the file's), `toml_files` (what all TOML files have in common), `places` (where
each key of a TOML text stands).
"""

from traffic.scenarios.model import CameraSettings, Scenario, VehicleType
from traffic.scenarios.reading import (
    bundled_scenarios,
    find_scenario,
    read_scenario,
    scenario_of_configuration,
    scenario_path,
)

__all__ = [
    "CameraSettings",
    "Scenario",
    "VehicleType",
    "bundled_scenarios",
    "find_scenario",
    "read_scenario",
    "scenario_of_configuration",
    "scenario_path",
]

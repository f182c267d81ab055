"""The specifications that come with the project."""

from pathlib import Path

import pytest

from dyknow.kpl.check import faults
from dyknow.kpl.parser import parse_specification, parse_value
from dyknow.kpl.printer import text_from
from dyknow.kpl.unused import warnings

SPECIFICATIONS = sorted(Path("data/specifications").glob("*.kpl"))


@pytest.mark.parametrize("path", SPECIFICATIONS, ids=lambda path: path.stem)
def test_a_bundled_specification_is_free_of_faults(path):
    """It parses, passes all checks, has nothing unused, and survives printing."""
    specification = parse_specification(path.read_text(), path.name)

    assert faults(specification) == []
    assert warnings(specification) == []
    assert parse_specification(text_from(specification)) == specification


@pytest.mark.parametrize("view", ["vision", "truth"])
def test_monitoring_has_two_views(view):
    """The application can be fed by the cameras or by noisy positions."""
    path = Path("data/specifications/monitoring.kpl")
    specification = parse_specification(path.read_text(), path.name)

    assert faults(specification, {"view": parse_value(view)}) == []

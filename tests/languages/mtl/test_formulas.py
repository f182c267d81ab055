"""Formulas as files: those that are right, and those that are wrong with their messages."""

from pathlib import Path

import pytest

from dyknow.errors import SpecificationError
from dyknow.mtl.check import check, faults
from dyknow.mtl.parser import parse_formula

HERE = Path(__file__).parent


@pytest.mark.parametrize("path", sorted(HERE.glob("*.ok")), ids=lambda path: path.stem)
def test_a_right_formula_is_read_and_has_no_faults(path):
    """Every formula of the file parses and passes the check."""
    for text in path.read_text(encoding="utf-8").split("\n\n"):
        check(parse_formula(text, path.name))


@pytest.mark.parametrize("path", sorted(HERE.glob("*.bad")), ids=lambda path: path.stem)
def test_a_wrong_formula_gives_exactly_the_expected_messages(path):
    """Each fault is reported with its place, the line, and carets."""
    expected = path.with_suffix(".err").read_text(encoding="utf-8")
    try:
        found = faults(parse_formula(path.read_text(encoding="utf-8"), path.name))
    except SpecificationError as error:
        found = [error]
    assert "\n".join(fault.report() for fault in found) + "\n" == expected

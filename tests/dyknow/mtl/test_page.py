"""The page about formulas says what is true."""

import doctest
import re
from pathlib import Path

import pytest

from dyknow.mtl.declarations import read_document
from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.syntax import MAX_DEPTH, TimeModel

PAGE = Path(__file__).parents[3] / "docs" / "formulas.md"
TEXT = PAGE.read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```mtl\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
_PROSE = re.sub(r"^```.*?^```", "", TEXT, flags=re.MULTILINE | re.DOTALL)
SPANS = list(dict.fromkeys(span.replace("\n", " ") for span in re.findall(r"`([^`]+)`", _PROSE)))
_OPERATOR = re.compile(
    r"\w.*(?: until |->|→|↔|[<>≠≥]|!=)"
    r"|^(?:always|eventually|forall|exists)\W"
    r"|[□◇∀∃¬∧∨]"
)
FORMULAS = [span for span in SPANS if re.search(r"\w", span) and _OPERATOR.search(span)]


@pytest.mark.parametrize("block", BLOCKS)
def test_blocks_are_formulas(block):
    """Each example stands as it could stand in a file."""
    read_document(block)


@pytest.mark.parametrize("formula", FORMULAS)
def test_formulas_in_the_text_are_formulas(formula):
    """Each formula is read; only residuals have intervals that reach back."""
    if "[-" not in formula:
        assert parse_formula(formula)


def test_formulas_are_found():
    """The test sees the formulas of the tables and of the text."""
    assert len(BLOCKS) == 2
    assert len(FORMULAS) > 45


def test_the_examples_run():
    """The Python on the page does what it says."""
    assert doctest.testfile(str(PAGE), module_relative=False).failed == 0


def test_the_limits_are_those_of_the_code():
    """Nesting and time models are as they are described."""
    assert f"nested {MAX_DEPTH} deep" in TEXT
    assert all(f"**`{time_model}`**" in TEXT for time_model in TimeModel)


def test_what_is_said_to_be_seen_is_seen():
    """The formulas of the section on simplification are simplified, those of its table not."""
    section = TEXT.partition("### What is not seen")[2].partition("## In Python")[0]
    before, table = section.split("\n\n")[1:3]
    seen = [s.replace("\n", " ") for s in re.findall(r"`([^`]+)`", before)]
    unseen = re.findall(r"^\| `([^`]+)`", table, re.MULTILINE)

    assert (len(seen), len(unseen)) == (4, 3)
    assert all(FormulaGraph(parse_formula(text)).root == 0 for text in seen)
    assert all(FormulaGraph(parse_formula(text)).root > 1 for text in unseen)

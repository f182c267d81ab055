"""Printing and parsing are inverse."""

import pytest
from hypothesis import given, settings

from dyknow.mtl import syntax
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula, text_from_interval
from dyknow.mtl.syntax import Interval
from dyknow.time import Duration
from tests.dyknow.mtl.formulas import any_formulas


@settings(derandomize=True, deadline=None, max_examples=150)
@given(any_formulas())
def test_parsing_what_is_printed_gives_the_formula_back(formula):
    """Every formula is read back from its text as it was."""
    assert parse_formula(text_from_formula(formula)) == formula


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("□ p", "always p"),
        ("◇[0,1.5s](p ∨ ¬q)", "eventually [0, 1500] (p or not q)"),
        ("always [0, oo) p", "always p"),
        ("p until [1 ms, 1500 us] q", "p until [1, 1500000 ns] q"),
        ("∀ u ∈ UAV speed[u] ≤ 2", "forall u in UAV (speed(u) <= 2)"),
        ("∃ u ∈ UAV (⊤ → u ≠ v)", "exists u in UAV (true -> u != v)"),
        ("(p and q) and r", "(p and q) and r"),
        ("p and q and r", "p and q and r"),
        ("p -> q -> r", "p -> (q -> r)"),
        ("(a + b) * -c < 2 / (d - 1)", "(a + b) * -c < 2 / (d - 1)"),
        ('p or q and r until not s == "x"', 'p or q and r until not s = "x"'),
    ],
)
def test_signs_and_words_mean_the_same(text, printed):
    """A formula has one printed form, with parentheses only where they matter."""
    assert text_from_formula(parse_formula(text)) == printed


def test_an_interval_without_end_prints_as_oo():
    """No bound is written `oo`."""
    assert text_from_interval(Interval(Duration(200_000_000), None)) == "[200, oo]"


def test_what_is_not_syntax_cannot_be_printed():
    """The printer refuses anything but a formula or a term."""
    with pytest.raises(TypeError, match="not a formula"):
        text_from_formula("p")  # type: ignore[arg-type]


def test_a_number_of_the_syntax_is_never_negative():
    """A negative number is written with a minus, which is an operator."""
    with pytest.raises(ValueError, match="expected a finite number of at least 0, found -1"):
        syntax.Number(-1.0)

"""What follows from what, against the naive meaning."""

from itertools import permutations

import pytest
from hypothesis import given, settings

from dyknow.mtl.entailment import Entailment
from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.semantics import evaluate
from dyknow.mtl.syntax import Conjunction
from tests.dyknow.mtl.formulas import small_formulas, traces


def is_seen(premise, conclusion):
    """Whether `premise -> conclusion` is seen to be true in any case."""
    return FormulaGraph(parse_formula(f"({premise}) -> ({conclusion})")).root == 0


@pytest.mark.parametrize(
    ("premise", "conclusion"),
    [
        ("eventually [0, 10] p", "eventually [0, 20] p"),
        ("always [0, 20] p", "always [5, 10] p"),
        ("always p", "p"),
        ("p", "eventually [0, 5] p"),
        ("q", "p until q"),
        ("p until q", "p or q"),
        ("p until [3, 5] q", "p"),
        ("p until [3, 5] q", "eventually [0, 9] q"),
        ("always (p and q)", "always p"),
        ("not eventually p", "not p"),
        ("p and q", "q or r"),
        ("p until [0, 4] (q and r)", "(p or r) until [0, 5] q"),
        ("always eventually [0, 5] p", "eventually [0, 7] p"),
        ("p and q", "eventually (p and q)"),
        ("not (p until q)", "not q"),
    ],
)
def test_what_the_form_shows_is_seen(premise, conclusion):
    """Narrower intervals, stronger sides, and now as a part of the future."""
    assert is_seen(premise, conclusion)


@pytest.mark.parametrize(
    ("premise", "conclusion"),
    [
        ("eventually [0, 20] p", "eventually [0, 10] p"),
        ("eventually p", "p"),
        ("p until q", "p"),
        ("p until [3, 5] q", "q"),
        ("p or q", "p"),
        ("not eventually [3, 5] p", "not p"),
        ("p", "eventually [1, 5] p"),
        ("eventually [0, 5] p", "eventually [0, 5] (p and q)"),
    ],
)
def test_what_does_not_follow_is_not_seen(premise, conclusion):
    """The converses are not true."""
    assert not is_seen(premise, conclusion)


def test_two_operators_are_not_put_together():
    """That p holds soon or does not hold soon is seen about now, not about later."""
    assert FormulaGraph(parse_formula("eventually [0, 9] p or eventually [0, 9] not p")).root == 0
    assert FormulaGraph(parse_formula("eventually [1, 9] p or eventually [1, 9] not p")).root > 1


@settings(derandomize=True, deadline=None, max_examples=150)
@given(small_formulas(size=3), small_formulas(size=3), traces(most=5))
def test_what_follows_is_never_less_true(one, other, trace):
    """Kleene's value of a conclusion is at least that of its premise, after each state."""
    graph = FormulaGraph(Conjunction((one, other)))
    entailment = Entailment(graph.nodes)
    for premise, conclusion in permutations(range(2, 2 * len(graph.nodes)), 2):
        if entailment.follows([premise], conclusion):
            for count in range(1, len(trace) + 1):
                known = trace[:count]
                less = evaluate(graph.formula(premise), known)
                more = evaluate(graph.formula(conclusion), known)
                assert less <= more

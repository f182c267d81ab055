"""The naive meaning of formulas, by examples that can be checked by eye."""

import pytest

from dyknow.mtl.parser import parse_formula
from dyknow.mtl.semantics import deciding_state, evaluate
from dyknow.mtl.syntax import TimeModel, Verdict

TRUE, FALSE, UNDECIDED = Verdict.TRUE, Verdict.FALSE, Verdict.UNDECIDED


def trace(*states):
    """States of p and q at times in nanoseconds, written as (time, "pq")."""
    return [(time, {"p": "p" in holds, "q": "q" in holds}) for time, holds in states]


@pytest.mark.parametrize(
    ("text", "states", "verdict", "state"),
    [
        ("p", [(3, "p"), (5, "")], TRUE, 0),
        ("p and q", [(0, "p")], FALSE, 0),
        ("always p", [(0, "p"), (9, "p")], UNDECIDED, None),
        ("always p", [(0, "p"), (9, "")], FALSE, 1),
        ("eventually p", [(0, ""), (9, "p")], TRUE, 1),
        ("always [0, 5 ns] p", [(0, "p"), (5, "p")], TRUE, 1),
        ("always [0, 5 ns] p", [(0, "p"), (4, "p"), (9, "")], TRUE, 2),
        ("eventually [0, 5 ns] p", [(0, ""), (6, "p")], FALSE, 1),
        ("eventually [3 ns, 5 ns] p", [(0, ""), (2, "p"), (4, "")], TRUE, 2),
        ("eventually [3 ns, 5 ns] p", [(0, ""), (2, "p"), (3, "")], UNDECIDED, None),
        ("p until q", [(0, "p"), (4, "q")], TRUE, 1),
        ("p until q", [(0, "p"), (4, "")], FALSE, 1),
        ("p until q", [(0, "q")], TRUE, 0),
        ("p until [2 ns, 9 ns] q", [(0, "pq"), (4, "p"), (6, "pq")], TRUE, 1),
        ("p until [5 ns, 9 ns] q", [(0, "q")], FALSE, 0),
        ("eventually [200 ns, oo] true", [(0, ""), (199, ""), (201, "")], TRUE, 2),
        ("true", [(0, "")], TRUE, 0),
        ("p <-> q", [(0, "pq")], TRUE, 0),
        ("always [0, 9 ns] p <-> q", [(0, "p"), (3, "")], TRUE, 1),
        ("always [0, 9 ns] p or q -> not p", [(0, "p"), (3, "")], TRUE, 1),
    ],
)
def test_a_formula_is_decided_at_the_state_that_tells(text, states, verdict, state):
    """The verdict, and the first state at which the known instants decide it."""
    assert deciding_state(parse_formula(text), trace(*states)) == (verdict, state)


def test_a_state_holds_until_the_next_one():
    """A formula about instants between two states sees the earlier of them."""
    formula = parse_formula("eventually [4 ns, 4 ns] p")
    assert evaluate(formula, trace((0, "p"), (5, ""))) is TRUE


def test_what_holds_in_any_case_may_be_decided_late():
    """Operators are taken one by one; that one implies the other is not seen."""
    formula = parse_formula("eventually [0, 10 ns] q -> eventually [0, 20 ns] q")
    assert evaluate(formula, trace((0, ""), (5, ""))) is UNDECIDED


def test_without_a_state_nothing_is_known():
    """An empty trace decides nothing."""
    assert evaluate(parse_formula("true"), []) is UNDECIDED


def test_quantifiers_have_no_meaning_without_domains():
    """Quantifiers are expanded before a formula is evaluated."""
    with pytest.raises(ValueError, match="use expand first"):
        evaluate(parse_formula("exists x in Car (p)"), trace((0, "p")))


@pytest.mark.parametrize(
    ("text", "states", "verdict", "state"),
    [
        ("always [0, 5 ns] p", [(0, "p"), (4, "p"), (9, "")], TRUE, 2),
        ("always [1 ns, 3 ns] false", [(0, ""), (4, "")], TRUE, 1),
        ("always [1 ns, 3 ns] false", [(0, ""), (3, "")], FALSE, 1),
        ("eventually [1 ns, 3 ns] true", [(0, ""), (4, "")], FALSE, 1),
        ("eventually [3 ns, 5 ns] p", [(0, ""), (2, "p"), (4, "")], UNDECIDED, None),
        ("eventually [3 ns, 5 ns] p", [(0, ""), (2, "p"), (6, "p")], FALSE, 2),
        ("eventually [3 ns, 5 ns] p", [(0, ""), (5, "p")], TRUE, 1),
        ("p until [2 ns, 9 ns] q", [(0, "p"), (1, "q"), (4, "q")], FALSE, 1),
        ("p until [2 ns, 9 ns] q", [(0, "p"), (1, "p"), (4, "q")], TRUE, 2),
        ("always p", [(0, "p"), (9, "p")], UNDECIDED, None),
        ("eventually [0, 5 ns] always [0, 2 ns] p", [(0, ""), (5, "p"), (8, "")], TRUE, 2),
    ],
)
def test_between_points_there_is_nothing(text, states, verdict, state):
    """In the time model of points an interval holds the time-points of states alone."""
    found = deciding_state(parse_formula(text), trace(*states), TimeModel.POINTS)
    assert found == (verdict, state)

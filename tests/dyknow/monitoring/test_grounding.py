"""Formulas without what no stream is needed for."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import FeatureError
from dyknow.monitoring.grounding import constants_in, grounded
from dyknow.monitoring.interpretation import Interpretation
from dyknow.mtl import syntax
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.quantifiers import expand
from dyknow.mtl.semantics import deciding_state
from dyknow.mtl.syntax import TimeModel
from tests.dyknow.mtl.formulas import TWO_FEATURES, small_formulas, traces

MEANING = Interpretation(
    constants={"limit": 3, "armed": True}, domains={"UAV": ["uav1", "uav2"], "Empty": []}
)
_RIGID = ["true", "false", "armed", "limit > 2", "limit = 4", "uav1 = uav2"]
_LEAVES = TWO_FEATURES | st.sampled_from([parse_formula(text) for text in _RIGID])


def _text(formula):
    return text_from_formula(grounded(parse_formula(formula), MEANING))


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("forall x in UAV (x != uav1 -> always d[x, uav1] > 10)", "always d(uav2, uav1) > 10"),
        ("exists x in UAV (x = uav1 and p[x])", "p(uav1)"),
        ("forall x in Empty p[x]", "true"),
        ("exists x in Empty p[x] or q", "q"),
        ("armed -> p", "p"),
        ("p -> not armed", "not p"),
        ("p <-> limit < 3", "not p"),
        ("limit + 1 = 4 <-> not not p", "p"),
        ("p > limit", "p > limit"),
        ("p until limit = 3", "p until true"),
        ("eventually [5, oo] armed", "eventually [5, oo] true"),
        ("not (armed and limit = 3)", "false"),
    ],
)
def test_what_constants_decide_is_decided(formula, expected):
    """Operators over time stay, since they say when there has to be a state."""
    assert _text(formula) == expected


@settings(derandomize=True, deadline=None, max_examples=100)
@given(small_formulas(_LEAVES, longest=5), traces(most=5, longest=4), st.sampled_from(TimeModel))
def test_the_meaning_stays_the_same(formula, trace, time_model):
    """The same verdict at the same state, by definition, with and without simplification."""
    names = {**MEANING.constants, "uav1": "uav1", "uav2": "uav2"}
    full = [(time, {**state, **names}) for time, state in trace]

    ground = grounded(formula, MEANING)

    assert deciding_state(ground, trace, time_model) == deciding_state(
        expand(formula, MEANING.domains), full, time_model
    )


def test_constants_that_cannot_be_compared_are_refused():
    """The fault is in the formula, before there is any state."""
    with pytest.raises(FeatureError, match="expected a text, found 3"):
        _text("uav1 = limit")


def test_constants_are_found_where_they_stand_alone():
    """A name with objects is a feature, whatever it is called."""
    formula = parse_formula("limit(uav1) > limit and other")
    assert constants_in([formula], MEANING) == {"limit": 3}
    assert isinstance(grounded(formula, MEANING), syntax.Conjunction)

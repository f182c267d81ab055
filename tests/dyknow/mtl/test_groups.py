"""Formula groups."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import (
    FeatureError,
    FormulaSyntaxError,
    SpecificationErrors,
    StateOrderError,
    UnknownNameError,
)
from dyknow.mtl.check import NUMBER, FeatureSignature, Vocabulary
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import milliseconds
from tests.dyknow.mtl.formulas import small_formulas, traces

MODELS = st.sampled_from(TimeModel)


def ms(amount):
    """A time point in milliseconds."""
    return milliseconds(amount)


def test_each_verdict_is_reported_once_and_kept():
    """A step returns the verdicts that it brought about, by name."""
    group = FormulaGroup()
    group.add("calm", "always speed < 5")
    group.add("starts", "eventually [0, 200] moving")

    assert group.step(ms(0), {"speed": 0, "moving": False}) == {}
    assert group.step(ms(100), {"speed": 3, "moving": True}) == {"starts": Verdict.TRUE}
    assert group.step(ms(200), {"speed": 6}) == {"calm": Verdict.FALSE}
    assert group.step(ms(300), {}) == {}
    assert group.verdicts == {"calm": Verdict.FALSE, "starts": Verdict.TRUE}


def test_formulas_come_and_go_while_states_arrive():
    """A formula that is added while running is about the states from the next one on."""
    group = FormulaGroup()
    group.add("first", "always p")
    group.step(ms(0), {"p": True})
    group.add("second", "always p")
    assert group.remove("first") is Verdict.UNDECIDED
    assert "first" not in group

    assert group.step(ms(1), {"p": False}) == {"second": Verdict.FALSE}


def test_a_state_that_is_refused_changes_nothing():
    """After a fault the group goes on with the next state as if there had been none."""
    group = FormulaGroup()
    group.add("one", "p until q")
    group.add("other", "always p")
    group.step(ms(5), {"p": True, "q": False})

    with pytest.raises(FeatureError, match="'q'"):
        group.step(ms(6), {"p": False})
    with pytest.raises(StateOrderError, match="states must be in order of time"):
        group.step(ms(5), {"p": False, "q": False})
    assert group.step(ms(6), {"p": True, "q": True}) == {"one": Verdict.TRUE}


def test_the_domain_is_that_of_the_group():
    """Quantifiers range over the objects of the group; symbols say what a state must have."""
    group = FormulaGroup({"Car": ("car1", "car2")})
    group.add("limit", "always forall x in Car (speed[x] <= limit)")

    symbols = group.symbols()
    assert [text_from_formula(f) for f in symbols.features] == [
        "speed(car1)",
        "limit",
        "speed(car2)",
    ]
    assert symbols.sorts == ("Car",)
    assert group.step(ms(0), {"speed[car1]": 3, "speed(car2)": 9, "limit": 8.5}) == {
        "limit": Verdict.FALSE
    }


def test_names_are_unique_and_known():
    """A name is taken until its formula is removed; an unknown one is refused."""
    group = FormulaGroup()
    group.add("calm", "p")
    with pytest.raises(ValueError, match="there is a formula called 'calm' already"):
        group.add("calm", "q")
    with pytest.raises(ValueError, match=r"no formula called 'clam'; did you mean 'calm'\?"):
        group.remove("clam")


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.lists(small_formulas(), min_size=1, max_size=4), traces(), st.integers(0, 3), MODELS)
def test_a_group_gives_what_its_formulas_give_alone(formulas, trace, late, time_model):
    """Whenever a formula is added, its verdicts are those of a monitor from then on."""
    group = FormulaGroup(time_model=time_model)
    alone, expected = {}, {}
    for step, (time, state) in enumerate(trace):
        for number, formula in enumerate(formulas):
            if step == (late if number % 2 else 0):
                group.add(str(number), formula)
                alone[str(number)] = Monitor(formula, time_model)
        changed = group.step(time, state)
        before, expected = expected, {n: m.step(time, state) for n, m in alone.items()}
        assert group.verdicts == expected
        assert changed == {n: v for n, v in expected.items() if v and not before.get(n)}


def test_faults_are_reported_when_a_formula_is_added():
    """Unknown names, unknown domains and reversed intervals, with a vocabulary or without."""
    known = Vocabulary({"speed": FeatureSignature(("Car",), NUMBER)}, {}, {"Car": "Car"})
    group = FormulaGroup({"Car": ()}, known)

    with pytest.raises(SpecificationErrors) as caught:
        group.add("limit", "always [5, 1] forall c in Cra (sped(c) < 3)")
    assert [fault.message for fault in caught.value.exceptions] == [
        "expected an interval that ends after it begins, found [5, 1]",
        "no domain called 'Cra'; did you mean 'Car'?",
        "no feature called 'sped'; did you mean 'speed'?",
    ]
    with pytest.raises(UnknownNameError, match="no domain called 'Car'"):
        FormulaGroup().add("limit", "forall c in Car (speed(c) < 3)")
    with pytest.raises(FormulaSyntaxError) as syntax:
        group.add("limit", "always (")
    assert syntax.value.span.place == "limit:1:9"
    assert len(group) == 0


def test_an_empty_domain_decides_at_the_first_state():
    """`forall` is true and `exists` false, and no features are needed."""
    group = FormulaGroup({"Car": ()})
    group.add("all", "forall c in Car always p(c)")
    group.add("some", "exists c in Car always p(c)")

    assert group.symbols().features == ()
    assert group.step(ms(0), {}) == {"all": Verdict.TRUE, "some": Verdict.FALSE}
    assert group.symbols().sorts == ("Car",)
    assert text_from_formula(group.formula("all")) == "forall c in Car (always p(c))"
    assert text_from_formula(group.residual("some")) == "false"

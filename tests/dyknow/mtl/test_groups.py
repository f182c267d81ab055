"""Formula groups."""

import pytest

from dyknow.errors import FeatureError, StateOrderError
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Verdict
from dyknow.time import milliseconds


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

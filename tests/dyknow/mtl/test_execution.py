"""Execution monitors: flags, formulas of actions, recovery."""

import pytest

from dyknow.errors import FeatureError
from dyknow.mtl.execution import ExecutionMonitor, FormulaViolation
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.operators import (
    Action,
    Condition,
    DurationConstraint,
    Effect,
    Operator,
    causal_links,
)
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Verdict
from dyknow.time import milliseconds

TRUE, FALSE = Verdict.TRUE, Verdict.FALSE
ATTACH = Operator(
    "attach_box",
    ("uav", "box"),
    effects=(Effect("attached(uav, box)", recovery="retry"),),
    duration=DurationConstraint(milliseconds(300)),
)
DETACH = Operator("detach_box", ("uav", "box"), (Condition("attached(uav, box)"),))
PICK_UP, PUT_DOWN = Action(ATTACH, ("heli1", "bx7")), Action(DETACH, ("heli1", "bx7"))


def attached(holds):
    """A state in which the box is attached or not."""
    return {"attached(heli1, bx7)": holds}


def ms(amount):
    """A time point in milliseconds."""
    return milliseconds(amount)


def test_an_action_that_succeeds_violates_nothing():
    """Its formulas are monitored from its begin to their verdicts, and then gone."""
    calls = []
    monitor = ExecutionMonitor(recoveries={"retry": calls.append})
    names = monitor.begin(PICK_UP)
    assert names == ["attach_box(heli1, bx7): effect 1", "attach_box(heli1, bx7): duration 2"]
    assert monitor.executing == ("attach_box(heli1, bx7)",)

    assert monitor.step(ms(0), attached(False)) == {}
    assert monitor.step(ms(100), attached(True)) == {}
    monitor.end(PICK_UP)
    assert monitor.step(ms(200), attached(True)) == {names[0]: TRUE, names[1]: TRUE}
    assert (len(monitor.group), monitor.executing, calls) == (0, (), [])


def test_a_recovery_is_called_exactly_once():
    """The effect is not there when the execution ends; only its own recovery is called."""
    calls = []
    monitor = ExecutionMonitor(recoveries={"retry": calls.append})
    effect, duration = monitor.begin(PICK_UP)
    formula = monitor.group.formula(effect)
    monitor.step(ms(0), attached(True))
    monitor.end(PICK_UP)

    assert monitor.step(ms(100), attached(False)) == {effect: FALSE, duration: TRUE}
    monitor.step(ms(200), attached(False))
    assert calls == [FormulaViolation(effect, formula, ms(100))]


def test_a_recovery_may_begin_an_action_again():
    """A retry within the recovery is monitored from the next state on, under a free name."""
    monitor = ExecutionMonitor(recoveries={"retry": lambda _: monitor.begin(PICK_UP)})
    first = monitor.begin(PICK_UP)
    monitor.step(ms(0), attached(False))
    monitor.end(PICK_UP)
    assert monitor.step(ms(100), attached(False)) == {first[0]: FALSE, first[1]: TRUE}

    assert monitor.executing == (PICK_UP.name,)
    assert monitor.step(ms(200), attached(False)) == {}
    monitor.end(PICK_UP)
    assert monitor.step(ms(300), attached(True)) == {first[0]: TRUE, first[1]: TRUE}


def test_the_same_action_may_be_monitored_twice():
    """Formulas that outlive their action keep their names; the next ones get others."""
    lasting = Operator("wait", formulas=(Condition("always calm"),))
    monitor = ExecutionMonitor()
    for _ in range(2):
        monitor.begin(Action(lasting))
        monitor.end(Action(lasting))

    assert monitor.step(ms(0), {"calm": False}) == {
        "wait: formula 1": FALSE,
        "wait: formula 1 #2": FALSE,
    }


def test_global_formulas_may_ask_for_flags():
    """A flag of an action that has never begun is false."""
    calls = []
    monitor = ExecutionMonitor()
    monitor.add("still", "always (executing_detach_box(heli1, bx7) -> speed < 1)", calls.append)
    monitor.step(ms(0), {"speed": 5})
    monitor.begin(PUT_DOWN)

    assert monitor.step(ms(100), {"speed": 5} | attached(True))["still"] is FALSE
    (violation,) = calls
    assert (violation.name, violation.time) == ("still", ms(100))


def test_a_causal_link_finds_a_box_that_is_dropped_in_flight():
    """The violation comes while nothing is being executed, long before the box is put down."""
    plan = [PICK_UP, PUT_DOWN]
    links = [link.monitor_formula(plan) for link in causal_links(plan)]
    monitor = ExecutionMonitor(recoveries={"retry": lambda _: None})
    *_, link = monitor.begin(PICK_UP, links)
    monitor.step(ms(0), attached(True))
    monitor.end(PICK_UP)
    monitor.step(ms(100), attached(True))

    assert monitor.step(ms(200), attached(False)) == {link: FALSE}


def test_two_actions_with_one_flag_keep_it_set():
    """The flag is false when the last of them ends."""
    fly = Operator("fly", ("uav", "x"), flag_parameters=("uav",))
    one, other = Action(fly, ("heli1", 1)), Action(fly, ("heli1", 2))
    monitor = ExecutionMonitor()
    monitor.begin(one)
    monitor.begin(other)
    monitor.end(one)
    monitor.add("flies", "executing_fly(heli1)")
    assert monitor.step(ms(0), {}) == {"flies": TRUE}
    monitor.end(other)
    monitor.add("flies", "executing_fly(heli1)")
    assert monitor.step(ms(1), {}) == {"flies": FALSE}


def test_if_one_recovery_fails_the_others_are_called():
    """The failure is raised after the last call."""
    calls = []

    def fail(violation):
        raise RuntimeError(violation.name)

    monitor = ExecutionMonitor()
    monitor.add("first", "p", fail)
    monitor.add("second", "p", calls.append)

    with pytest.raises(RuntimeError, match="first"):
        monitor.step(ms(0), {"p": False})
    assert [violation.name for violation in calls] == ["second"]
    assert monitor.step(ms(1), {}) == {}


def test_a_removed_formula_calls_no_recovery():
    """What is not monitored any more is not recovered from."""
    calls = []
    monitor = ExecutionMonitor(FormulaGroup({"Box": ("bx1", "bx2")}))
    monitor.add("all", "always forall b in Box (safe(b))", calls.append)
    monitor.step(ms(0), {"safe(bx1)": True, "safe(bx2)": True})
    assert monitor.remove("all") is Verdict.UNDECIDED
    monitor.step(ms(1), {})
    assert calls == []


def test_misuse_is_refused_and_changes_nothing():
    """An action is begun once and ended once, with recoveries that are known."""
    monitor = ExecutionMonitor()
    with pytest.raises(ValueError, match="no recovery called 'retry'"):
        monitor.begin(PICK_UP)
    with pytest.raises(ValueError, match="is not being executed"):
        monitor.end(PICK_UP)
    monitor.begin(PUT_DOWN)
    with pytest.raises(ValueError, match="is being executed already"):
        monitor.begin(PUT_DOWN)
    with pytest.raises(FeatureError, match="attached"):
        monitor.step(ms(0), {})
    residual = monitor.group.residual("detach_box(heli1, bx7): precondition 1")
    assert text_from_formula(residual) == "attached(heli1, bx7)"

"""Formulas that are generated from operators; examples and forms of the thesis, 7.6 and 7.7."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import ArityError, FormulaSyntaxError
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.operators import (
    Action,
    CausalLink,
    Condition,
    DurationConstraint,
    Effect,
    Operator,
    causal_links,
    execution_flag,
    monitor_formulas,
)
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Verdict
from dyknow.time import milliseconds

ATTACHED = "attached(uav, box)"
ATTACH = Operator(
    "attach_box",
    ("uav", "box", "x", "y"),
    preconditions=(Condition("not attached(uav, box)"),),
    effects=(Effect(ATTACHED),),
    flag_parameters=("uav", "box"),
)
DETACH = Operator(
    "detach_box",
    ("uav", "box"),
    preconditions=(Condition(ATTACHED),),
    effects=(Effect("not attached(uav, box)"),),
)
FLY = Operator("fly_to", ("uav", "x", "y"), effects=(Effect("at(uav, x, y)"),))
PICK_UP = Action(ATTACH, ("heli1", "bx7", 127.52, 5821.23))
PUT_DOWN = Action(DETACH, ("heli1", "bx7"))


def texts(operator, *arguments):
    """The formulas of an action."""
    return [formula.text for formula in monitor_formulas(Action(operator, arguments))]


def test_example_7_6_2():
    """Within 5000 ms the box is attached and stays so for 1000 ms, for the arguments given."""
    success = Condition("eventually [0, 5000] always [0, 1000] attached(uav, box)")
    operator = Operator("attach_box", ("uav", "box", "x", "y"), formulas=(success,))

    assert texts(operator, "heli1", "bx7", 127.52, 5821.23) == [
        "eventually [0, 5000] always [0, 1000] attached(heli1, bx7)"
    ]


def test_example_7_6_3():
    """Climbing goes on until the flight altitude is reached."""
    climb = Operator(
        "climb_for_flying_empty",
        ("uav",),
        effects=(Effect("altitude(uav) >= 7.0", lasting=False),),
    )
    written = Operator(
        "climb_for_flying_empty",
        ("uav",),
        formulas=(Condition("EXEC until altitude(uav) >= 7.0"),),
    )

    expected = ["executing_climb_for_flying_empty(heli1) until altitude(heli1) >= 7"]
    assert texts(climb, "heli1") == texts(written, "heli1") == expected


def test_example_7_6_4():
    """A box becomes attached within 5000 ms and remains so until it is detached."""
    operator = Operator(
        "attach_box",
        ("uav", "box"),
        formulas=(
            Condition(
                "EXEC until [0, 5000] (attached(uav, box) until executing_detach_box(uav, box))"
            ),
        ),
    )

    (text,) = texts(operator, "heli1", "bx7")
    assert text == (
        "executing_attach_box(heli1, bx7) until [0, 5000] "
        "(attached(heli1, bx7) until executing_detach_box(heli1, bx7))"
    )


@pytest.mark.parametrize(
    ("operator", "expected"),
    [
        (Operator("op", preconditions=(Condition("f < 3"),)), "f < 3"),
        (
            Operator("op", prevail_conditions=(Condition("f < 3"),)),
            "(executing_op and f < 3) until not executing_op",
        ),
        (Operator("op", effects=(Effect("f", lasting=False),)), "executing_op until f"),
        (Operator("op", effects=(Effect("f"),)), "executing_op until (not executing_op and f)"),
        (
            Operator("op", duration=DurationConstraint(milliseconds(5000))),
            "executing_op until [0, 5000] not executing_op",
        ),
        (
            Operator("op", duration=DurationConstraint(milliseconds(5000), milliseconds(200))),
            "executing_op until [200, 5000] not executing_op",
        ),
        (Operator("op", formulas=(Condition("EXEC -> EXEC"),)), "executing_op -> executing_op"),
    ],
)
def test_each_part_of_an_operator_has_its_form(operator, expected):
    """The forms are those of section 7.7."""
    (formula,) = monitor_formulas(Action(operator))
    assert formula.text == text_from_formula(parse_formula(expected))


def test_what_is_not_marked_is_not_monitored():
    """Conditions may be switched off one by one."""
    operator = Operator(
        "op",
        preconditions=(Condition("a", monitored=False), Condition("b", recovery="retry")),
        effects=(Effect("c", monitored=False),),
        duration=DurationConstraint(milliseconds(1), monitored=False),
    )

    (formula,) = monitor_formulas(Action(operator))
    assert (formula.name, formula.text, formula.recovery) == ("op: precondition 2", "b", "retry")


def test_parameters_stand_for_objects_and_numbers():
    """Bound variables hide parameters, and a number may be negative where it stands alone."""
    operator = Operator(
        "move",
        ("uav", "x"),
        formulas=(
            Condition("position(uav) > x - 1 and uav != other"),
            Condition("forall uav in UAV (speed(uav) < x)"),
        ),
        flag_parameters=("uav",),
    )

    assert texts(operator, "heli1", -2.5) == [
        'position(heli1) > -2.5 - 1 and "heli1" != other',
        "forall uav in UAV (speed(uav) < -2.5)",
    ]
    assert Action(operator, ("heli1", -2.5)).name == "move(heli1, -2.5)"


def test_the_flag_takes_a_subset_of_the_parameters():
    """The execution flag of attach_box is about the vehicle and the box."""
    assert text_from_formula(execution_flag(PICK_UP)) == "executing_attach_box(heli1, bx7)"
    assert text_from_formula(execution_flag(Action(Operator("wait")))) == "executing_wait"


def test_a_causal_link_bridges_a_plan():
    """What attaching brings about is needed by detaching; flying in between does not touch it."""
    plan = [PICK_UP, Action(FLY, ("heli1", 3.0, 4.0)), PUT_DOWN]
    (link,) = causal_links(plan)

    assert link == CausalLink(0, 2, parse_formula("attached(heli1, bx7)"))
    assert link.monitor_formula(plan).text == (
        "executing_attach_box(heli1, bx7) until "
        "(attached(heli1, bx7) until executing_detach_box(heli1, bx7))"
    )


def test_a_causal_link_may_be_interrupted():
    """With a tolerance the condition must only be restored in time."""
    (link,) = causal_links([PICK_UP, PUT_DOWN])
    text = link.monitor_formula([PICK_UP, PUT_DOWN], milliseconds(700)).text

    one, two = "executing_attach_box(heli1, bx7)", "executing_detach_box(heli1, bx7)"
    kept = "attached(heli1, bx7)"
    assert parse_formula(text) == parse_formula(
        f"{one} until ({kept} and "
        f"((not {two} and eventually [0, 700] {kept}) until ({two} and {kept})))"
    )


@pytest.mark.parametrize(
    ("between", "producers"),
    [
        ([], [0]),
        ([Action(DETACH, ("heli1", "bx8"))], [0]),
        ([Action(ATTACH, ("heli1", "bx7", 1.0, 2.0))], [1]),
        ([Action(DETACH, ("heli1", "bx7")), Action(ATTACH, ("heli1", "bx7", 1.0, 2.0))], [2]),
        ([Action(Operator("drop", (), effects=(Effect("not attached(heli1, bx7)"),)))], []),
    ],
)
def test_a_link_begins_at_the_last_effect(between, producers):
    """An effect in between about the same feature breaks the link."""
    plan = [PICK_UP, *between, PUT_DOWN]
    links = [link for link in causal_links(plan) if link.consumer == len(plan) - 1]
    assert [link.producer for link in links] == producers


def test_conditions_that_are_not_monitored_give_no_links():
    """Neither an effect nor a precondition that is switched off is linked."""
    quiet = Operator("attach", (), effects=(Effect("a and b", monitored=False),))
    loud = Operator("attach", (), effects=(Effect("a and b"),))
    needy = Operator("use", (), preconditions=(Condition("b and a"), Condition("c")))
    shy = Operator("use", (), preconditions=(Condition("a", monitored=False),))

    assert len(causal_links([Action(loud), Action(needy)])) == 2
    assert causal_links([Action(quiet), Action(needy)]) == []
    assert causal_links([Action(loud), Action(shy)]) == []


def test_faults_of_operators_are_named():
    """A wrong number of arguments, a text that is no formula, a negative argument of a feature."""
    with pytest.raises(ArityError, match=r"'detach_box' takes 2 argument\(s\), found 1"):
        Action(DETACH, ("heli1",))
    with pytest.raises(FormulaSyntaxError) as caught:
        monitor_formulas(Action(Operator("op", preconditions=(Condition("a and"),))))
    assert caught.value.span.place == "op:1:6"
    with pytest.raises(ValueError, match=r"no negative number as an argument, found -3"):
        monitor_formulas(Action(FLY, ("heli1", -3, 4)))


LENGTHS = st.tuples(*[st.integers(1, 4)] * 4)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(LENGTHS, st.lists(st.booleans(), min_size=14, max_size=14))
def test_a_causal_link_is_kept_exactly_if_the_effect_persists(lengths, attached):
    """The formula is true if the condition holds from some state of the first action on."""
    (link,) = causal_links([PICK_UP, PUT_DOWN])
    monitor = Monitor(parse_formula(link.monitor_formula([PICK_UP, PUT_DOWN]).text), "points")
    first, gap, second, _ = lengths
    verdict = Verdict.UNDECIDED
    for step in range(first + gap + second):
        state = {
            "executing_attach_box(heli1, bx7)": step < first,
            "executing_detach_box(heli1, bx7)": step >= first + gap,
            "attached(heli1, bx7)": attached[step],
        }
        verdict = monitor.step(milliseconds(100 * step), state)

    needed = attached[: first + gap]
    starts = [s for s in range(first + 1) if all(needed[s:])]
    assert verdict is (Verdict.TRUE if starts else Verdict.FALSE)

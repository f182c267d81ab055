"""A formula is followed up to the first state that decides it."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import SpecificationErrors
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import TimeModel, Verdict
from tests.dyknow.mtl.formulas import small_formulas, traces
from tests.support.state_files import Pieces, asked
from traffic.errors import LineError
from traffic.monitoring.following import document_from, follow, milliseconds_of
from traffic.monitoring.opening import read_states


def lines_of(trace):
    """Return a trace as lines of JSON."""
    return "".join(
        json.dumps({"t": time / 1e6, "values": {"p": False, "q": False, **state}}) + "\n"
        for time, state in trace
    )


def answer_to(formula, text, **options):
    """Follow a formula along states in a text."""
    question = asked(formula)
    stream = Pieces(text.encode(), options.pop("size", 1 << 20))
    return follow(question, read_states(stream, "f", question.sorts), **options)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(small_formulas(), traces(), st.sampled_from(TimeModel), st.booleans())
def test_states_in_a_file_are_followed_as_states_are(formula, trace, model, is_explained):
    """Verdict, deciding state and residual are those of a monitor that gets the states."""
    monitor = Monitor(formula, model)
    verdicts = [monitor.step(time, state) for time, state in trace]
    decided = [verdict is not Verdict.UNDECIDED for verdict in verdicts]
    last = decided.index(True) if any(decided) else len(trace) - 1
    on_step = (lambda step: None) if is_explained else None

    answer = answer_to(
        text_from_formula(formula), lines_of(trace), time_model=model, on_step=on_step
    )

    assert answer.verdict is verdicts[last]
    assert answer.decided_at == (trace[last][0] if any(decided) else None)
    assert (answer.n_states, answer.last) == (last + 1, trace[last][0])
    assert answer.residual == text_from_formula(monitor.residual)


def test_no_more_is_read_than_is_needed():
    """There is a verdict as soon as there can be one; what comes after it does not matter."""
    text = '{"t":0,"values":{"p":true}}\n{"t":1,"values":{"p":false}}\nnonsense'

    assert answer_to("always p", text).decided_at == 1_000_000
    with pytest.raises(LineError, match="f:3:1"):
        answer_to("eventually [5, 9] p", text)


def test_the_document_has_three_entries():
    """Verdict, time in milliseconds, and residual."""
    states = 't,p\n0,0\n1.5,1\n'  # fmt: skip

    assert document_from(answer_to("always eventually p", states)) == {
        "verdict": "undecided",
        "decided_at": None,
        "residual": "always eventually p",
    }
    assert document_from(answer_to("eventually p", states)) == {
        "verdict": "true",
        "decided_at": 1.5,
        "residual": "true",
    }
    assert [milliseconds_of(time) for time in (2_000_000, 1)] == [2, 1e-6]


def test_steps_tell_what_changes():
    """The first state tells all atoms, the others those that are not as before."""
    steps = []

    answer_to("always (x > 1 -> eventually [0, 2] p)", "t,x,p\n0,2,0\n1,3,0\n2,0,1\n",
              on_step=steps.append)  # fmt: skip

    assert [step.changes for step in steps] == [
        {"x > 1": True, "p": False}, {}, {"x > 1": False, "p": True},
    ]  # fmt: skip
    assert [step.time for step in steps] == [0, 1_000_000, 2_000_000]
    assert "eventually [0, 2] p" in steps[0].residual


@pytest.mark.parametrize(
    ("formula", "values", "message"),
    [
        ("p", '"p": 1', "f:2:26: expected a boolean as 'p', found 1, a number"),
        ("p > 1", '"p": "fast"', "f:2:26: expected a number as 'p', found 'fast', a text"),
        ("p > 1", '"p": true', "f:2:26: expected a number as 'p', found true, a boolean"),
        ('p = "a"', '"p": 3', "f:2:26: expected a text as 'p', found 3, a number"),
        ("p > 1", '"q": 1', "f:2: expected a value in the state as 'p', found none"),
        (
            "1 / p > 1",
            '"p": 0',
            "f:2:26: expected a divisor other than 0 as 'p', found 0",
        ),
        (
            "p * p - p * p > 1",
            '"p": 1e300',
            "f:2: expected a number as 'p * p - p * p', found NaN",
        ),
        ("p * 1.5 > 1", '"p": 1' + "0" * 400, "f:2: expected a number of a size"),
    ],
)
def test_values_that_the_formula_cannot_take_have_their_place(formula, values, message):
    """A fault that only the formula sees is told with file, line and column."""
    fit = {"p": "true", 'p = "a"': '"b"'}.get(formula, "2")
    first = '{"t": 0, "values": {"p": ' + fit + "}}"
    text = first + '\n{"t": 1, "values": {' + values + "}}"

    with pytest.raises(LineError) as raised:
        answer_to(f"always [5, 9] ({formula})", text)

    assert message in str(raised.value)


def test_features_are_missed_at_the_first_state():
    """All of them at once, at their places in the formula."""
    with pytest.raises(SpecificationErrors) as raised:
        answer_to("speed(a) < 3 and braked", '{"t":0,"values":{"speed[b]":1,"brakes":true}}')

    assert [fault.report().split("\n")[0] for fault in raised.value.exceptions] == [
        "<formula>:1:1: the state at f:1 has no feature 'speed(a)'; did you mean 'speed(b)'?",
        "<formula>:1:18: the state at f:1 has no feature 'braked'; did you mean 'brakes'?",
    ]

"""Formulas that are progressed part by part."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.mtl.monitors import Monitor
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.products import taken_apart
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.quantifiers import expand
from dyknow.mtl.semantics import evaluate
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import milliseconds

CARS = {"Car": tuple(f"car{i}" for i in range(9)), "Lane": ("left", "right")}

SHAPES = [
    "forall c in Car always p(c)",
    "always forall c in Car (p(c) -> eventually [1 ns, 3 ns] p(c))",
    "exists c in Car (p(c) until [1 ns, 4 ns] q)",
    "not exists c in Car eventually [2 ns, oo] not p(c)",
    "(exists c in Car p(c)) -> always [0, 5 ns] q",
    "q -> forall c in Car eventually [0, 4 ns] p(c)",
    "forall c in Car always [1 ns, 2 ns] p(c) -> eventually q",
    "eventually [1 ns, 4 ns] exists c in Car (p(c) and q)",
    "forall c in Car forall l in Lane (eventually [0, 2 ns] on(c, l))",
]


def monitored(text):
    """The formula with its quantifiers written out."""
    return expand(parse_formula(text), CARS)


def traces(features):
    """Traces of a few states, in which most features hold."""
    truth = st.fixed_dictionaries({f: st.sampled_from([True, True, False]) for f in features})
    return st.lists(st.tuples(st.integers(1, 4), truth), min_size=1, max_size=6)


@settings(derandomize=True, deadline=None, max_examples=120)
@given(st.data(), st.sampled_from(SHAPES), st.sampled_from(TimeModel))
def test_a_formula_in_parts_is_decided_as_a_whole(data, text, time_model):
    """The verdict after each state is that of the meaning."""
    formula = monitored(text)
    table = ProgressionTable(formula, time_model=time_model)
    assert taken_apart(table) is not None
    steps = data.draw(traces(table.columns.features))
    monitor, now, trace = Monitor(table), 0, []
    for gap, state in steps:
        now += gap
        trace.append((now, state))
        assert monitor.step(now, state) is evaluate(formula, trace, time_model)


def test_parts_share_tables():
    """Cars are all alike: what is learnt of one is known of the others."""
    formula = monitored("always forall c in Car (p(c) -> eventually [0, 100] q(c))")
    monitor = Monitor(formula)
    for step in range(50):
        state = {f: (step + len(f)) % 7 < 4 for f in monitor.table.columns.features}
        monitor.step(milliseconds(10 * step), state)

    assert monitor.table.memory.rules == 0


def test_what_is_left_of_the_parts_is_printed():
    """Parts that are decided do not stand in the way."""
    monitor = Monitor(monitored("forall c in Car eventually [0, 100] p(c)"))
    assert text_from_formula(monitor.residual).startswith("eventually [0, 100] p(car0) and")
    monitor.step(milliseconds(0), {f"p(car{i})": i != 3 for i in range(9)})
    assert text_from_formula(monitor.residual) == "eventually [0, 100] p(car3)"

    assert (
        monitor.step(milliseconds(101), {f"p(car{i})": False for i in range(9)}) is Verdict.FALSE
    )
    assert text_from_formula(monitor.residual) == "false"
    assert monitor.step(milliseconds(102), {}) is Verdict.FALSE


@pytest.mark.parametrize(
    "text", ["always (a and b)", "always (" + " or ".join(f"p{i}" for i in range(12)) + ")"]
)
def test_few_atoms_and_single_pieces_are_left_whole(text):
    """There is nothing to gain where the atoms are few, or all in one part."""
    assert taken_apart(ProgressionTable(parse_formula(text))) is None

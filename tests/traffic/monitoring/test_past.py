"""The past is kept as far as a verdict can depend on it."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.mtl import syntax
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.syntax import ALWAYS_HENCEFORTH, TimeModel, Verdict
from dyknow.time import TimePoint
from tests.dyknow.mtl.formulas import small_formulas, traces
from traffic.monitoring.past import Past


def remembered(formula, trace, model=TimeModel.HOLD, most_kept=1_000):
    """Return what is kept of a trace when the formula is decided, or at its end."""
    monitor = Monitor(formula, model)
    past = Past(monitor, most_kept)
    for time, state in trace:
        bits = monitor.table.columns.of_state(state)
        verdict = monitor.step_bits(time, bits)
        past.add(time, bits, state, monitor.residual)
        if verdict is not Verdict.UNDECIDED:
            break
    return past


def replayed(past, states):
    """Return the verdict on some states alone."""
    monitor = Monitor(past.monitor.table.formula, past.monitor.table.time_model)
    for state in states:
        monitor.step(state.time, state.values)
    return monitor.verdict


@settings(derandomize=True, deadline=None, max_examples=100)
@given(small_formulas(), traces(most=12), st.sampled_from(TimeModel))
def test_what_is_kept_decides(body, trace, model):
    """The states that are kept of 'always f' bring the same verdict about by themselves."""
    past = remembered(syntax.Always(ALWAYS_HENCEFORTH, body), trace, model)

    if past.monitor.verdict is Verdict.FALSE:
        assert replayed(past, past.stretches()[0]) is Verdict.FALSE


def test_states_before_a_new_beginning_are_forgotten():
    """If nothing is owed from before, the monitor might have begun with this state."""
    trace = [(TimePoint(t), {"p": t % 4 == 0}) for t in range(9)]
    trace += [(TimePoint(9 + t), {"p": False}) for t in range(9)]

    past = remembered(parse_formula("always eventually [0, 5 ns] p"), trace)

    shortest, longest = past.stretches()
    assert [state.time for state in shortest] == list(range(9, 15))
    assert [state.time for state in longest] == list(range(15))


def test_other_formulas_need_all_states():
    """A formula about the first state is not forgotten."""
    trace = [(TimePoint(t), {"p": t < 5}) for t in range(9)]

    (stretch,) = remembered(parse_formula("p -> eventually [3 ns, oo] not p"), trace).stretches()

    assert [state.time for state in stretch] == list(range(6))


def test_memory_is_bounded():
    """Very long pasts are cut off; what begins anew does not mind."""
    trace = [(TimePoint(t), {"p": t < 9_999, "q": False}) for t in range(10_000)]

    lost = remembered(parse_formula("p until [0, oo] q"), trace, most_kept=100)
    kept = remembered(parse_formula("always p"), trace, most_kept=100)

    assert lost.is_lost
    assert lost.stretches() == []
    assert len(kept.stretches()[0]) == 1
    assert len(kept.stretches()[-1]) <= 3_000

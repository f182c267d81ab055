"""Progression against the definition of the meaning, and the table that makes it fast."""

import gc

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dyknow.errors import SpecificationErrors
from dyknow.mtl import syntax
from dyknow.mtl.monitors import Monitor, MonitorColumns
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.quantifiers import expand
from dyknow.mtl.semantics import deciding_state, evaluate
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import MILLISECOND, Duration
from tests.dyknow.mtl.formulas import (
    TWO_FEATURES,
    plain_formulas,
    quantified_formulas,
    small_formulas,
    traces,
    wide_traces,
)

check = settings(derandomize=True, deadline=None, max_examples=200)
few = settings(derandomize=True, deadline=None, max_examples=60)
WITH_CONSTANTS = TWO_FEATURES | st.sampled_from([syntax.TRUE, syntax.FALSE])
MODELS = st.sampled_from(TimeModel)
ALL = list(HealthCheck)


def progressed(table, trace):
    """The verdict after each state."""
    number, last, verdicts = table.initial, None, []
    for time, state in trace:
        elapsed = Duration(1 if last is None else time - last)
        number = table.successor(number, table.columns.of_state(state), elapsed)
        verdicts.append(table.verdict(number))
        last = time
    return verdicts


def monitored(table, trace):
    """The verdict of a monitor after each state."""
    monitor = Monitor(table)
    return [monitor.step(time, state) for time, state in trace]


def agrees(formula, trace, time_model=TimeModel.HOLD):
    """Verdicts never contradict the meaning and come no later."""
    table = ProgressionTable(formula, time_model=time_model)
    found = progressed(table, trace)
    verdict, state = deciding_state(formula, trace, time_model)
    right = verdict is Verdict.UNDECIDED or found[state] is verdict
    return right and monitored(table, trace) == found


def agrees_exactly(formula, trace, time_model):
    """The verdict after each state is that of the meaning."""
    table = ProgressionTable(formula, time_model=time_model)
    expected = [evaluate(formula, trace[: i + 1], time_model) for i in range(len(trace))]
    return progressed(table, trace) == expected == monitored(table, trace)


@check
@given(small_formulas(), traces(), MODELS)
def test_progression_decides_as_the_meaning_does_and_no_later(formula, trace, time_model):
    """At the state at which the definition decides a formula, progression has the verdict."""
    assert agrees(formula, trace, time_model)


@few
@given(plain_formulas(), wide_traces(), MODELS)
def test_progression_decides_at_the_very_state(formula, trace, time_model):
    """Where no two parts speak of the same, the deciding state is that of the definition."""
    assert agrees_exactly(formula, trace, time_model)


@few
@given(quantified_formulas(), wide_traces(("p(a)", "p(b)")), MODELS)
def test_quantifiers_are_progressed_over_their_domain(formula, trace, time_model):
    """Each object of the domain counts, and at the state at which the definition decides."""
    assert agrees(expand(formula, {"D": ("a", "b")}), trace, time_model)


@pytest.mark.exhaustive
@pytest.mark.parametrize("time_model", TimeModel)
def test_ten_thousand_random_formulas(time_model):
    """Verdict and deciding state agree with the naive meaning, for each time model."""
    many = settings(derandomize=True, deadline=None, max_examples=3500, suppress_health_check=ALL)

    @many
    @given(small_formulas(), traces())
    def nested(formula, trace):
        assert agrees(formula, trace, time_model)

    @many
    @given(plain_formulas(), wide_traces())
    def plain(formula, trace):
        assert agrees_exactly(formula, trace, time_model)

    @many
    @given(quantified_formulas(), wide_traces(("p(a)", "p(b)")))
    def quantified(formula, trace):
        assert agrees(expand(formula, {"D": ("a", "b")}), trace, time_model)

    nested()
    plain()
    quantified()


@check
@given(small_formulas(WITH_CONSTANTS), traces(), MODELS)
def test_progression_decides_formulas_with_constants_no_later(formula, trace, time_model):
    """Constants inside change nothing in that."""
    assert agrees(formula, trace, time_model)


@check
@given(small_formulas(longest=3, size=5), traces(most=6, longest=30), MODELS)
def test_long_times_between_states_are_no_different(formula, trace, time_model):
    """States that lie further apart than all bounds are progressed through exactly."""
    assert agrees(formula, trace, time_model)


@check
@given(small_formulas(), traces())
def test_a_verdict_is_never_taken_back(formula, trace):
    """True stays true and false stays false."""
    found = progressed(ProgressionTable(formula), trace)

    decided = [verdict for verdict in found if verdict is not Verdict.UNDECIDED]
    assert found == [Verdict.UNDECIDED] * (len(found) - len(decided)) + decided
    assert len(set(decided)) <= 1


@pytest.mark.parametrize(
    "text",
    [
        "always eventually [0, 10 ns] p",
        "always eventually [0, 10 ns] always [0, 2 ns] p",
        "eventually [0, oo] always [0, 3 ns] p",
        "eventually [5 ns, oo] true",
        "eventually [0, 5 ns] p",
        "p until [3 ns, 8 ns] q",
        "always (p -> eventually [2 ns, 5 ns] q)",
        "always (not p -> eventually [0, 5 ns] always [0, 4 ns] p)",
        "eventually [0, 4 ns] (always [0, 6 ns] p and eventually [3 ns, 5 ns] q)",
        "(eventually [0, 3 ns] p) until (always [1 ns, 4 ns] q)",
    ],
)
def test_progression_decides_exactly_when_the_meaning_does(text):
    """Where there is nothing to simplify, the deciding state is the same, on 60 traces."""
    formula = parse_formula(text)
    rng = np.random.default_rng(3)
    for _ in range(60):
        times = np.cumsum(rng.integers(1, 6, 8)).tolist()
        bits = rng.integers(0, 4, 8).tolist()
        trace = [(t, {"p": bool(b & 1), "q": b > 1}) for t, b in zip(times, bits, strict=True)]
        expected = [evaluate(formula, trace[: i + 1]) for i in range(len(trace))]
        assert progressed(ProgressionTable(formula), trace) == expected


@check
@given(small_formulas(), st.lists(traces(most=5), min_size=1, max_size=6), st.booleans(), MODELS)
def test_many_objects_are_progressed_as_each_alone(formula, many, together, time_model):
    """Columns give what the objects give one by one, with one elapsed time or several."""
    table = ProgressionTable(formula, time_model=time_model)
    steps = min(len(trace) for trace in many)
    residuals = np.full(len(many), table.initial)
    for i in range(steps):
        truth = np.array(
            [[bool(t[i][1][a.name]) for t in many] for a in table.atoms], dtype=bool
        ).reshape(len(table.atoms), len(many))
        gaps = [many[0] if together else t for t in many]
        elapsed = np.array([t[i][0] - (t[i - 1][0] if i else 0) for t in gaps])
        given_elapsed = Duration(int(elapsed[0])) if together else elapsed
        expected = [
            table.successor(
                int(r), sum(bool(b) << k for k, b in enumerate(bits)), Duration(int(e))
            )
            for r, bits, e in zip(residuals, truth.T, elapsed, strict=True)
        ]
        residuals = table.progress(residuals, truth, given_elapsed)
        assert residuals.tolist() == expected


def test_many_atoms_are_progressed_without_a_table():
    """A formula with twelve atoms gives what its objects give one by one."""
    names = [f"p{i}" for i in range(12)]
    table = ProgressionTable(parse_formula(f"always eventually [0, 3 ns] ({' and '.join(names)})"))
    rng = np.random.default_rng(5)
    residuals = np.full(50, table.initial)
    for _ in range(6):
        truth = rng.random((12, 50)) < 0.95
        bits = [sum(int(b) << k for k, b in enumerate(column)) for column in truth.T]
        expected = [
            table.successor(int(r), b, Duration(2)) for r, b in zip(residuals, bits, strict=True)
        ]
        residuals = table.progress(residuals, truth, Duration(2))
        assert residuals.tolist() == expected


@pytest.mark.parametrize(
    ("text", "most"),
    [
        ("always eventually [0, 1000] p", 14),
        ("always (not p -> eventually [0, 1000] always [0, 999] p)", 120),
        ("eventually [0, oo] always [0, 500] p", 10),
        ("always (q -> eventually p)", 10),
        ("always eventually [0, 10000] always [0, 1000] p", 2000),
    ],
)
def test_steady_sampling_needs_few_residuals(text, most):
    """However long the stream, there is a bounded number of different residuals."""
    table = ProgressionTable(parse_formula(text))
    rng = np.random.default_rng(7)
    number = table.initial
    for _ in range(20_000):
        bits = int(rng.random() < 0.8) | 2 * int(rng.random() < 0.1)
        number = table.successor(number, bits, Duration(100 * MILLISECOND))
        if number <= 1:
            number = table.initial
    assert len(table) <= most


def test_jitter_does_not_fill_the_memory():
    """With irregular sampling unused residuals are forgotten, and those in use are kept."""
    formula = parse_formula("always eventually [0, 1000] always [0, 200] p")
    table, calm = ProgressionTable(formula, limit=200), ProgressionTable(formula)
    many, reference = MonitorColumns(table), MonitorColumns(calm)
    many.add(20)
    reference.add(20)
    rng = np.random.default_rng(2)
    now = 0
    for _ in range(300):
        now += int(rng.integers(50, 150) * MILLISECOND + rng.integers(1000))
        truth = rng.random((1, 20)) < 0.9
        assert many.step(now, truth).tolist() == reference.step(now, truth).tolist()
        assert len(table) <= 2 * 200
    assert len(calm) > 3 * len(table)


def test_a_monitor_that_is_gone_holds_no_residuals():
    """What only a dropped monitor needed is forgotten when the table is next full."""
    table = ProgressionTable(parse_formula("always eventually [0, 1000] p"), limit=5)
    gone, left = MonitorColumns(table), MonitorColumns(table)
    left.add(1)
    for step in range(10):
        gone.add(1)
        gone.step(step * MILLISECOND, np.zeros((1, len(gone)), dtype=bool))
    many = len(table)
    del gone
    gc.collect()
    for step in range(100):
        left.step(step * step * MILLISECOND // 20 + step, np.array([[step % 5 == 0]]))
    assert many > 10
    assert len(table) <= 8


def after(text, *states):
    """The residual as text after states of p at times in milliseconds."""
    table = ProgressionTable(parse_formula(text))
    number, last = table.initial, -1
    for time, p in states:
        bits = table.columns.of_state({"p": p, "q": not p})
        number = table.successor(number, bits, Duration((time - last) * MILLISECOND))
        last = time
    return text_from_formula(table.residual(number))


@pytest.mark.parametrize(
    ("text", "states", "residual"),
    [
        ("always eventually [0, 1000] p", [], "always eventually [0, 1000] p"),
        ("always eventually [0, 1000] p", [(0, True)], "always eventually [0, 1000] p"),
        (
            "always eventually [0, 1000] p",
            [(0, False), (300, False)],
            "eventually [0, 700] p and always eventually [0, 1000] p",
        ),
        ("eventually [200, oo] true", [(0, True), (50, True)], "eventually [150, oo] true"),
        ("eventually [200, oo] true", [(0, True), (200, True)], "true"),
        ("always [0, 500] p", [(0, True), (100, True)], "always [0, 400] p"),
        (
            "eventually [0, 900] always [0, 500] p",
            [(0, False), (100, True), (200, True)],
            "always [0, 400] p or eventually [0, 700] always [0, 500] p",
        ),
        (
            "eventually [0, 900] always [0, 500] p",
            [(0, True), (950, False)],
            "true",
        ),
        (
            "always eventually [0, 900] always [0, 500] p",
            [(0, True), (200, True)],
            "always [-200, oo] eventually [0, 900] always [0, 500] p",
        ),
        ("p until [100, 400] q", [(0, True), (50, True)], "p until [50, 350] q"),
        (
            "(eventually [0, 300] q) until [500, 900] p",
            [(0, True), (200, True)],
            "always [-200, 0] eventually [0, 300] q and eventually [0, 300] q until [300, 700] p",
        ),
        ("p and q", [(0, True)], "false"),
        ("always p -> eventually q", [(0, True)], "eventually not p or eventually q"),
    ],
)
def test_residuals_print_as_formulas(text, states, residual):
    """What is left is said relative to the last state."""
    assert after(text, *states) == residual


def test_a_pair_that_never_comes_close_is_decided_by_the_clock():
    """`eventually [0, 200] close` is false at the first state more than 200 ms on, or at it."""
    table = ProgressionTable(parse_formula("eventually [0, 200] xydist(from, to) < 3"))
    far, close = np.array([[False]]), np.array([[True]])

    started = table.progress(np.array([table.initial]), far, Duration(1))
    waiting = table.progress(started, far, Duration(199 * MILLISECOND))
    assert table.verdicts(waiting).tolist() == [0]
    assert table.verdicts(table.progress(waiting, far, MILLISECOND)).tolist() == [-1]
    assert table.verdicts(table.progress(waiting, close, MILLISECOND)).tolist() == [1]
    assert table.verdicts(table.progress(waiting, close, Duration(2 * MILLISECOND))).tolist() == [
        -1
    ]


@pytest.mark.parametrize(("text", "verdict"), [("true", 1), ("false", -1)])
def test_constants_are_decided_at_the_first_state(text, verdict):
    """A constant needs no features."""
    table = ProgressionTable(parse_formula(text))

    start = np.full(3, table.initial)
    assert table.verdicts(start).tolist() == [0, 0, 0]
    after_one = table.progress(start, np.zeros((0, 3), dtype=bool), Duration(1))
    assert table.verdicts(after_one).tolist() == [verdict] * 3


def test_no_objects_are_no_trouble():
    """Nothing follows from nothing."""
    table = ProgressionTable(parse_formula("p"))
    nothing = np.empty(0, dtype=np.int64)
    assert len(table.progress(nothing, np.zeros((1, 0), dtype=bool), Duration(5))) == 0


def test_truth_of_another_shape_is_refused():
    """The truth of the atoms has one row for each atom and one column for each object."""
    table = ProgressionTable(parse_formula("p and q"))
    with pytest.raises(ValueError, match=r"expected truth of shape \(2, 1\), found \(1, 1\)"):
        table.progress(np.array([table.initial]), np.zeros((1, 1), dtype=bool), Duration(1))


def test_time_must_pass_between_states():
    """There is no second state at the same time."""
    table = ProgressionTable(parse_formula("true"))
    with pytest.raises(ValueError, match="expected a positive elapsed time, found 0"):
        table.progress(np.array([table.initial]), np.zeros((0, 1), dtype=bool), Duration(0))


def test_a_reversed_interval_is_refused():
    """A formula with a fault does not become a table."""
    with pytest.raises(SpecificationErrors):
        ProgressionTable(parse_formula("always [10, 0] p"))


def test_quantifiers_must_be_expanded_first():
    """The table knows no domains."""
    with pytest.raises(ValueError, match="use expand first"):
        ProgressionTable(parse_formula("forall x in Car (p(x))"))

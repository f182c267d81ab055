"""Rules that are learnt once and hold for any times."""

import numpy as np
import pytest

from dyknow.mtl.graph import FormulaGraph
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.rules import NEVER, RuleBook
from dyknow.mtl.syntax import TimeModel, Verdict
from dyknow.time import MILLISECOND


def jittered(rng, count, features=("p", "q"), holds=0.9):
    """States about 100 ms apart, give or take up to 50 ms."""
    times = np.cumsum(rng.integers(50 * MILLISECOND, 150 * MILLISECOND, count)).tolist()
    truths = rng.random((count, len(features))) < holds
    rows = [dict(zip(features, row.tolist(), strict=True)) for row in truths]
    return list(zip(times, rows, strict=True))


@pytest.mark.parametrize(
    ("text", "rules"),
    [
        ("always eventually [0, 1000] p", 15),
        ("always (not p -> eventually [0, 1000] always [0, 999] p)", 40),
        ("always eventually [0, 30000] always [0, 5000] p", 60),
        ("(eventually [0, 300] q) until [500, 900] p", 150),
    ],
)
def test_irregular_sampling_needs_few_rules(text, rules):
    """However the times come, there is a small number of things to learn."""
    table = ProgressionTable(parse_formula(text))
    monitor = Monitor(table)
    for time, state in jittered(np.random.default_rng(1), 5000):
        if monitor.step(time, state) is not Verdict.UNDECIDED:
            monitor = Monitor(table)

    assert table.memory.rules <= rules


@pytest.mark.parametrize("time_model", TimeModel)
def test_the_number_of_rules_is_limited(time_model):
    """Rules that have to be learnt again and again are the same each time."""
    text = "always (p -> eventually [200, 1000] q)"
    small = ProgressionTable(parse_formula(text), limit=12, time_model=time_model)
    calm = ProgressionTable(parse_formula(text), time_model=time_model)
    one, other = Monitor(small), Monitor(calm)
    for time, state in jittered(np.random.default_rng(3), 600, holds=0.6):
        verdict = one.step(time, state)
        assert verdict is other.step(time, state)
        assert one.residual == other.residual
        assert small.memory.rules <= small.limit == 12
        if verdict is not Verdict.UNDECIDED:
            one, other = Monitor(small), Monitor(calm)
    assert calm.memory.rules > 12


def test_what_is_never_used_again_is_not_learnt_for_long():
    """Where each step is a new case learning pauses, and what is left stays right."""
    names = [f"p{i}" for i in range(16)]
    formula = parse_formula(f"always eventually [0, 1 h] ({' and '.join(names)})")
    table = ProgressionTable(formula)
    monitor = Monitor(table)
    rng = np.random.default_rng(5)
    for step in range(500):
        bits = int(rng.integers((1 << 16) - 1))
        assert monitor.step_bits(step * MILLISECOND, bits) is Verdict.UNDECIDED

    assert table.memory.rules < 100
    left = text_from_formula(monitor.residual)
    assert left.startswith("eventually [0, 3599501] (p0 and p1")


@pytest.mark.parametrize("text", ["always p", "always (q -> eventually p)", "p until [50, oo] q"])
def test_operators_without_bounds_need_no_memory(text):
    """After many states there is as little to remember as after a few."""
    graph = FormulaGraph(parse_formula(text))
    book = RuleBook(graph, 1000)
    shape, past = book.initial, (NEVER,)
    rng = np.random.default_rng(2)
    for time, _ in jittered(rng, 3000):
        shape, past = book.follow(shape, past, 1, time)
        assert len(past) <= 3
    assert book.size <= 10


def test_a_residual_says_how_long_ago_its_times_are():
    """The same shape with other times is another formula."""
    monitor = Monitor(parse_formula("always eventually [0, 1000] p"))
    left = []
    for time in (0, 130, 400):
        monitor.step(time * MILLISECOND, {"p": False})
        left.append(text_from_formula(monitor.residual))

    assert left == [
        "eventually [0, 1000] p and always eventually [0, 1000] p",
        "eventually [0, 870] p and always eventually [0, 1000] p",
        "eventually [0, 600] p and always eventually [0, 1000] p",
    ]

"""Monitors of one stream and of many objects."""

import numpy as np
import pytest

from dyknow.errors import FeatureError, StateOrderError
from dyknow.mtl.columns import evaluate_atoms
from dyknow.mtl.monitors import Monitor, MonitorColumns
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.progression import ProgressionTable
from dyknow.mtl.syntax import Verdict
from dyknow.time import TimePoint, milliseconds

TRUE, FALSE, UNDECIDED = Verdict.TRUE, Verdict.FALSE, Verdict.UNDECIDED


def ms(amount):
    """A time point in milliseconds."""
    return TimePoint(milliseconds(amount))


def columns(text):
    """A monitor of many objects for a formula."""
    return MonitorColumns(ProgressionTable(parse_formula(text)))


def test_a_monitor_gives_the_verdict_at_the_earliest_state():
    """On the road for a second within ten: decided when the second is over."""
    monitor = Monitor(parse_formula("eventually [0, 10 s] always [0, 1 s] on_road(from)"))

    verdicts = [
        monitor.step(ms(t), {"on_road(from)": t not in {300, 900}}) for t in range(0, 2400, 100)
    ]

    assert verdicts == [UNDECIDED] * 20 + [TRUE] * 4
    assert monitor.verdict is TRUE


def test_a_monitor_says_what_is_left():
    """The residual is a formula about the time to come."""
    monitor = Monitor(parse_formula("eventually [0, 500] speed[car1] < 3"))
    assert text_from_formula(monitor.residual) == "eventually [0, 500] speed(car1) < 3"

    monitor.step(ms(1000), {"speed[car1]": 5.5})
    monitor.step(ms(1200), {"speed[car1]": 4})
    assert text_from_formula(monitor.residual) == "eventually [0, 300] speed(car1) < 3"
    assert monitor.verdict is UNDECIDED

    assert monitor.step(ms(1700), {"speed[car1]": 3}) is FALSE
    assert text_from_formula(monitor.residual) == "false"


def test_a_monitor_forgets_nothing_it_needs_when_its_table_is_full():
    """Two monitors share a small table under irregular sampling and keep their verdicts."""
    formula = parse_formula("always eventually [0, 900] p")
    table = ProgressionTable(formula, limit=6)
    shared, alone = [Monitor(table), Monitor(table)], [Monitor(formula), Monitor(formula)]
    rng = np.random.default_rng(4)
    now = 0
    for _ in range(200):
        now += int(rng.integers(10_000_000, 100_000_000))
        for one, other in zip(shared, alone, strict=True):
            state = {"p": bool(rng.random() < 0.2)}
            assert one.step(now, state) is other.step(now, state)
            assert one.residual == other.residual


def test_states_must_be_in_order_of_time():
    """A second state at one time, or an earlier one, is refused."""
    monitor, many = Monitor(parse_formula("true")), columns("true")
    many.add(1)
    nothing = np.zeros((0, 1), dtype=bool)
    monitor.step(ms(5), {})
    many.step(ms(5), nothing)

    with pytest.raises(ValueError, match="states must be in order of time: 5000000 ns after"):
        monitor.step(ms(5), {})
    with pytest.raises(ValueError, match="states must be in order of time: 4000000 ns after"):
        many.step(ms(4), nothing)


def test_a_missing_feature_is_an_error_and_changes_nothing():
    """A state without the feature is refused; the monitor goes on with the next."""
    monitor = Monitor(parse_formula("always p"))
    with pytest.raises(FeatureError, match="'p'"):
        monitor.step(ms(1), {"q": True})
    assert monitor.step(ms(1), {"p": True}) is UNDECIDED


def test_the_formula_of_a_row_begins_when_the_row_does():
    """`eventually [200, oo] true` waits 200 ms for each object, from its own first state."""
    monitors = columns("eventually [200, oo] true")
    nothing = {}
    verdicts = []
    for step in range(6):
        if step in {0, 2}:
            monitors.add(1)
        truth = evaluate_atoms(monitors.table, nothing, n=len(monitors))
        verdicts.append(monitors.step(ms(100 * step), truth).tolist())

    assert verdicts == [[0], [0], [1, 0], [1, 0], [1, 1], [1, 1]]


def test_rows_are_kept_restarted_and_renumbered():
    """Kept rows close up in order, and restarted ones wait for their first state again."""
    monitors = columns("always [0, 100] p")
    assert monitors.add(2).tolist() == [0, 1]
    assert monitors.add(1).tolist() == [2]

    assert monitors.step(ms(0), np.array([[True, False, True]])).tolist() == [0, -1, 0]
    monitors.keep(np.array([False, True, True]))
    assert monitors.verdicts.tolist() == [-1, 0]
    assert text_from_formula(monitors.residual(1)) == "always [0, 100] p"
    monitors.restart(np.array([0]))
    assert monitors.step(ms(60), np.array([[True, True]])).tolist() == [0, 0]
    assert monitors.step(ms(120), np.array([[True, True]])).tolist() == [0, 1]
    assert monitors.step(ms(160), np.array([[True, True]])).tolist() == [1, 1]


def test_link_conditions_over_pairs():
    """A pair is linked at once when it is close within 200 ms, and refused after that."""
    monitors = columns("eventually [0, 200] xydist(from, to) < 3")
    monitors.add(3)
    distances = [[5.0, 9.0, 9.0], [4.0, 2.0, 9.0], [2.0, 9.0, 9.0], [9.0, 9.0, 1.0]]
    verdicts = []
    for step, distance in enumerate(distances):
        truth = evaluate_atoms(monitors.table, {"xydist(from, to)": np.array(distance)})
        verdicts.append(monitors.step(ms(100 * step), truth).tolist())

    assert verdicts == [[0, 0, 0], [0, 1, 0], [1, 1, -1], [1, 1, -1]]


def test_a_maintain_condition_forgives_short_gaps():
    """A gap every 1.5 s leaves seconds on the road; one every 0.7 s is found out after 10 s.

    The last second that could have begun in time, at 10 s, ends with the gap at 10.5 s.
    """
    monitors = columns("always eventually [0, 10000] always [0, 1000] on_road(from)")
    monitors.add(2)
    decided = {}
    for step in range(300):
        on_road = np.array([[step % 15 != 0, step % 7 != 0]])
        verdicts = monitors.step(ms(100 * step), on_road)
        for row in np.flatnonzero(verdicts):
            decided.setdefault(int(row), (step, int(verdicts[row])))

    assert decided == {1: (105, -1)}


def test_a_monitor_has_a_time_model_by_name():
    """A gap between two states shows what holds: the state before it, or nothing."""
    formula = parse_formula("eventually [300, 400] p")
    states = [(0, False), (200, True), (500, False)]
    found = {}
    for name in ("hold", "points"):
        monitor = Monitor(formula, time_model=name)
        found[name] = [monitor.step(ms(t), {"p": p}) for t, p in states]

    assert found["hold"] == [UNDECIDED, UNDECIDED, TRUE]
    assert found["points"] == [UNDECIDED, UNDECIDED, FALSE]
    with pytest.raises(ValueError, match="'sampled' is not a valid TimeModel"):
        Monitor(formula, time_model="sampled")


def test_a_decided_monitor_asks_for_nothing():
    """The verdict stays whatever comes; only the order of time is looked at."""
    monitor = Monitor(parse_formula("eventually p"))
    monitor.step(ms(0), {"p": True})

    assert monitor.step(ms(1), {}) is TRUE
    assert text_from_formula(monitor.residual) == "true"
    with pytest.raises(StateOrderError):
        monitor.step(ms(1), {})

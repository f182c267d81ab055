"""The sequences of states of the thesis, at regular times and at others."""

import numpy as np
import pytest

from dyknow.mtl.monitors import Monitor
from dyknow.mtl.syntax import Verdict
from traffic.benchmarks.sequences import FORMULAS, JITTERS, PERIOD, Alternation, times, truth

CASES = [
    pytest.param(under_test, alternation, id=f"{under_test.name}, {alternation}")
    for under_test in FORMULAS
    for alternation in under_test.alternations
]


@pytest.mark.parametrize(("_", "alternation"), CASES)
def test_regular_sequences_are_those_of_the_thesis(_, alternation):
    """At a regular period, so many states are false and so many true, over and over."""
    cycle = [False] * alternation.n_false + [True] * alternation.n_true

    values = truth(alternation, times(100, 0.0), n_before=3)

    assert values[3:95].tolist() == (cycle * 100)[:92]
    assert values[:3].all()


@pytest.mark.parametrize("jitter", JITTERS)
@pytest.mark.parametrize(("under_test", "alternation"), CASES)
def test_no_formula_is_violated(under_test, alternation, jitter):
    """Progression goes on to the end of a sequence, at all periods."""
    monitor = Monitor(under_test.formula)
    at = times(1_000, jitter)

    for now, value in zip(at, truth(alternation, at).tolist(), strict=True):
        assert monitor.step(now, {"p": value}) is Verdict.UNDECIDED


@pytest.mark.parametrize("jitter", JITTERS)
def test_times_vary_as_much_as_is_said(jitter):
    """Gaps are around the period, and all different."""
    gaps = np.diff(times(1_000, jitter)) / PERIOD

    assert gaps.mean() == pytest.approx(1, abs=0.01)
    assert np.abs(gaps - 1).max() == pytest.approx(jitter, rel=0.01)
    assert len(np.unique(gaps)) == (1 if jitter == 0 else 999)


@pytest.mark.parametrize("jitter", JITTERS)
def test_the_worst_case_stays_the_worst(jitter):
    """With every jitter about as many states are false as with none."""
    values = truth(Alternation(10, 1), times(1_000, jitter))

    assert 0.85 < 1 - values.mean() < 0.95

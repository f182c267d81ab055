"""Truths that turn when the evidence is enough."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, Duration, TimePoint
from traffic.features.decisions import Decisions
from traffic.features.stability import UNKNOWN

PERIOD = 100 * MILLISECOND
EVIDENCE = st.lists(st.integers(-4, 4), max_size=25)


def decided(evidence: list[float], *, n_periods: int = 3, certainty: float = 2.0) -> list[int]:
    """Decide on one truth about one object, evidence every 100 ms; as far as it is decided."""
    decisions = Decisions(1, certainty=certainty, within=Duration(n_periods * PERIOD))
    found = []
    for i, each in enumerate(evidence):
        time = TimePoint(i * PERIOD)
        table = Table("car", [7], {})
        for at, _, codes in decisions.push(time, table, np.array([[each]], dtype=np.float64)):
            assert at == time - n_periods * PERIOD
            found.append(int(codes[0, 0]))
    return found


def decided_by_definition(evidence: list[int], n_periods: int, certainty: float) -> list[int]:
    """Say for each time what the definition says, naively."""
    state, found = UNKNOWN, []
    for i in range(len(evidence) - n_periods):
        for sign, truth in ((1, 1), (-1, 0)):
            for end in range(i, i + n_periods + 1):
                run = [sign * each for each in evidence[i : end + 1]]
                if min(run) > 0 and run[-1] >= certainty:
                    state = truth
        found.append(state)
    return found


def test_a_truth_is_dated_back_to_when_the_evidence_changed_its_sign():
    """Weak evidence counts as soon as strong evidence follows it without a break."""
    assert decided([-3, -3, 1, 1, 3, 3, 3, 3]) == [0, 0, 1, 1, 1]


def test_weak_evidence_alone_turns_nothing():
    """An estimate that wavers within its uncertainty leaves all as it is, also the unknown."""
    assert decided([1, 1, -1, 1, 1, 1, 1]) == [UNKNOWN] * 4
    assert decided([3, 1, -1, -1, 1, -1, 1, 1]) == [1] * 5


def test_what_takes_long_turns_late():
    """If the evidence is weak for longer than one may wait, the truth turns that much before."""
    assert decided([-3, 1, 1, 1, 1, 1, 3, 3, 3, 3, 3]) == [0, 0, 0, 1, 1, 1, 1, 1]


@settings(derandomize=True, deadline=None, max_examples=300)
@given(EVIDENCE, st.integers(0, 5), st.integers(1, 4))
def test_decisions_agree_with_their_definition(evidence, n_periods, certainty):
    """For every sequence each time gets what trying all intervals gives."""
    expected = decided_by_definition(evidence, n_periods, certainty)

    assert decided(evidence, n_periods=n_periods, certainty=certainty) == expected


def test_objects_come_and_go():
    """Each object is decided on from its own evidence, whatever rows it has; one may be gone."""
    decisions = Decisions(1, certainty=2, within=Duration(PERIOD))
    frames = [([1, 2], [3, -1]), ([3, 2], [1, -3]), ([2, 1], [1, 1])]
    found = [
        (list(table.ids), codes[:, 0].tolist())
        for i, (ids, evidence) in enumerate(frames)
        for _, table, codes in decisions.push(
            TimePoint(i * PERIOD),
            Table("car", ids, {}),
            np.array(evidence, dtype=np.float64)[:, None],
        )
    ]

    assert found == [([1, 2], [1, 0]), ([3, 2], [UNKNOWN, 0])]


def test_a_negative_certainty_is_refused():
    """It would let evidence against a truth count for it."""
    with pytest.raises(ValueError, match="certainty of at least 0"):
        Decisions(1, certainty=-1, within=Duration(0))

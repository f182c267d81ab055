"""Measures: what is asked of the runs of a cell."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from traffic.experiments.measures import Counts, Measure, share

runs_of_counts = st.lists(
    st.tuples(st.integers(0, 5), st.integers(0, 5)).flatmap(
        lambda pair: st.integers(0, min(pair)).map(lambda right: Counts(*pair, right))
    ),
    max_size=8,
)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(runs_of_counts)
def test_every_measure_is_what_it_says(runs: list[Counts]) -> None:
    """Recall, precision, detection and false alarms, each by its own words."""
    detected = [run for run in runs if run.truth > 0]

    assert share("x.recall", runs) == (sum(r.correct for r in runs), sum(r.truth for r in runs))
    assert share("x.precision", runs) == (
        sum(r.correct for r in runs),
        sum(r.recognised for r in runs),
    )
    assert share("x.detection", runs) == (
        len([run for run in detected if run.correct == run.truth]),
        len(detected),
    )
    assert share("x.false_alarms", runs) == (
        len([run for run in runs if run.recognised - run.correct > 0]),
        len(runs),
    )
    assert share("x.faultless", runs) == (
        len([run for run in runs if run.correct == run.truth and run.correct == run.recognised]),
        len(runs),
    )


def test_a_share_of_nothing_has_no_value() -> None:
    """Of no runs there is no share, and its interval is all there is."""
    nothing = share("x.recall", [])

    assert nothing.value is None
    assert nothing.interval == (0.0, 1.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("overtake", "such as 'overtake.recall'"),
        ("overtake.recal", "did you mean 'recall'"),
        (3, "such as 'overtake.recall', found 3"),
    ],
)
def test_a_measure_that_is_none_is_refused(text: object, said: str) -> None:
    """Its form and its second part are checked, with the nearest one that there is."""
    with pytest.raises(ValidationError, match=said):
        TypeAdapter(Measure).validate_python(text)

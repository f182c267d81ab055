"""Scores as they are shown."""

from hypothesis import given, settings
from hypothesis import strategies as st

from traffic.experiments.intervals import wilson
from traffic.reporting.scores import score_rows
from traffic.results import Score

COUNTS = st.tuples(st.integers(0, 500), st.integers(0, 500), st.integers(0, 500))


@settings(derandomize=True, deadline=None, max_examples=60)
@given(COUNTS)
def test_shares_and_intervals_are_those_of_the_counts(counts):
    """Precision of what was recognised, recall of what was true, each inside of its interval."""
    correct, others, unseen = counts
    score = Score.of(
        truth=correct + unseen, recognised=correct + others, correct=correct, left_out=0
    )

    (row,) = score_rows({"turn_left": score})

    assert row.kind == "turn left"
    for shown, share, trials in (
        (row.precision, score.precision, score.recognised),
        (row.recall, score.recall, score.truth),
    ):
        assert shown.share == share
        if trials:
            assert (shown.low, shown.high) == tuple(wilson(correct, trials))
            low, high = (float(end.strip(" %")) / 100 for end in shown.interval.split("–"))
            assert low - 1e-9 <= shown.low <= shown.high <= high + 1e-9
            assert shown.counts == f"{correct} of {trials}"


def test_nothing_to_count_has_no_share():
    """A dash, not 0 % or 100 %."""
    (row,) = score_rows({"overtake": Score.of(0, 0, 0, 3)})

    assert row.is_idle
    assert (row.recall.text, row.recall.share) == ("–", None)

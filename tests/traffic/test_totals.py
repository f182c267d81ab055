"""The scores of several runs together."""

from traffic.results import RunResult, Score, Timing
from traffic.totals import total_score


def run(**counts: tuple[int, int, int]) -> RunResult:
    """A run with (truth, recognised, correct) of each kind."""
    score = {
        kind: Score(
            truth=truth,
            recognised=recognised,
            correct=correct,
            precision=None,
            recall=None,
            left_out=1,
        )
        for kind, (truth, recognised, correct) in counts.items()
    }
    timing = Timing(simulated_s=1, wall_s=1, real_time_factor=1, stages={})
    return RunResult(
        scenario="s", settings={}, recognitions=[], missed=[], score=score, timing=timing
    )


def test_counts_are_added_before_precision_and_recall_are_taken():
    """A run with many manoeuvres weighs more than one with few."""
    total = total_score([run(turn=(1, 1, 0)), run(turn=(3, 4, 3))])["turn"]

    assert (total.truth, total.recognised, total.correct, total.left_out) == (4, 5, 3, 2)
    assert (total.precision, total.recall) == (3 / 5, 3 / 4)


def test_nothing_recognised_has_no_precision():
    """Shares of nothing are not numbers."""
    total = total_score([run(overtake=(0, 0, 0)), run(turn=(1, 1, 1))])["overtake"]

    assert total.precision is None
    assert total.recall is None

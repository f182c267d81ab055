"""The scores of several runs together."""

from collections.abc import Sequence

from traffic.results import RunResult, Score

__all__ = ["total_score"]


def total_score(results: Sequence[RunResult]) -> dict[str, Score]:
    """Add up the counts of all runs, by kind of manoeuvre, and take precision and recall anew."""
    kinds = dict.fromkeys(kind for result in results for kind in result.score)
    return {kind: _total([r.score[kind] for r in results if kind in r.score]) for kind in kinds}


def _total(scores: Sequence[Score]) -> Score:
    return Score.of(
        truth=sum(score.truth for score in scores),
        recognised=sum(score.recognised for score in scores),
        correct=sum(score.correct for score in scores),
        left_out=sum(score.left_out for score in scores),
    )

"""Scores as rows of a page: counts, and shares with the intervals of Wilson."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from traffic.experiments.intervals import wilson
from traffic.results import Score

__all__ = ["ScoreRow", "ShownShare", "score_rows"]


@dataclass(frozen=True, slots=True)
class ShownShare:
    """A share of some cases, as it is shown.

    Attributes:
        text: In percent; a dash without cases.
        counts: Such as `29 of 30`.
        share: From 0 to 1; None without cases.
        low: The lower end of its interval.
        high: The upper end.
    """

    text: str
    counts: str
    share: float | None
    low: float
    high: float

    @property
    def interval(self) -> str:
        """The interval in percent, rounded outwards."""
        return f"{math.floor(100 * self.low)}–{math.ceil(100 * self.high)} %"


@dataclass(frozen=True, slots=True)
class ScoreRow:
    """How the recognitions of one kind compare with the truth.

    Attributes:
        kind: In words.
        score: The counts.
        precision: correct / recognised.
        recall: correct / truth.
    """

    kind: str
    score: Score
    precision: ShownShare
    recall: ShownShare

    @property
    def is_idle(self) -> bool:
        """Whether there was nothing to count."""
        return not self.score.truth and not self.score.recognised


def score_rows(score_by_kind: Mapping[str, Score]) -> list[ScoreRow]:
    """Return a row for each kind, in the order in which they are given."""
    return [
        ScoreRow(
            kind=kind.replace("_", " "),
            score=score,
            precision=_share(score.correct, score.recognised),
            recall=_share(score.correct, score.truth),
        )
        for kind, score in score_by_kind.items()
    ]


def _share(successes: int, trials: int) -> ShownShare:
    if not trials:
        return ShownShare("–", "none", None, 0.0, 1.0)
    share = successes / trials
    low, high = wilson(successes, trials)
    digits = 0 if successes == trials or not successes else 1
    return ShownShare(f"{100 * share:.{digits}f} %", f"{successes} of {trials}", share, low, high)

"""What is asked of the runs of a cell: shares of counts, such as the recall of overtakes.

A measure is written KIND.WHAT, where KIND is a kind of manoeuvre that runs score (`turn`,
`overtake`, `tailgating`, ...) and WHAT is one of

* `recall`: true manoeuvres that were recognised, of all true ones in view;
* `precision`: recognitions that the truth confirms, of all recognitions;
* `detection`: runs in which every true manoeuvre was recognised, of the runs that had any;
* `false_alarms`: runs with a recognition that is false, of all runs;
* `faultless`: runs in which every true manoeuvre was recognised and nothing false, of all runs.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, NamedTuple

from pydantic import BeforeValidator

from dyknow.source_text import did_you_mean, nearest_name
from traffic.experiments.intervals import Interval, wilson

__all__ = [
    "MEANINGS",
    "MEASURES",
    "Counts",
    "Measure",
    "Share",
    "is_less_better",
    "kind_of",
    "share",
]

_FORM = re.compile(r"([a-z][a-z0-9_]*)\.([a-z_]+)")


class Counts(NamedTuple):
    """What one run counted of one kind.

    Attributes:
        truth: True manoeuvres in view.
        recognised: Recognitions, without those of manoeuvres not wholly in view.
        correct: Recognitions that the truth confirms.
    """

    truth: int
    recognised: int
    correct: int


class Share(NamedTuple):
    """Successes among trials."""

    successes: int
    trials: int

    @property
    def value(self) -> float | None:
        """The share, or None of no trials."""
        return self.successes / self.trials if self.trials else None

    @property
    def interval(self) -> Interval:
        """Where the probability behind it lies, with a confidence of 95 %."""
        return wilson(self.successes, self.trials)


def _recall(runs: Iterable[Counts]) -> Iterable[tuple[int, int]]:
    return ((run.correct, run.truth) for run in runs)


def _precision(runs: Iterable[Counts]) -> Iterable[tuple[int, int]]:
    return ((run.correct, run.recognised) for run in runs)


def _detection(runs: Iterable[Counts]) -> Iterable[tuple[int, int]]:
    return ((int(run.correct == run.truth), 1) for run in runs if run.truth)


def _false_alarms(runs: Iterable[Counts]) -> Iterable[tuple[int, int]]:
    return ((int(run.recognised > run.correct), 1) for run in runs)


def _faultless(runs: Iterable[Counts]) -> Iterable[tuple[int, int]]:
    return ((int(run.truth == run.correct == run.recognised), 1) for run in runs)


MEASURES: Mapping[str, Callable[[Iterable[Counts]], Iterable[tuple[int, int]]]] = {
    "recall": _recall,
    "precision": _precision,
    "detection": _detection,
    "false_alarms": _false_alarms,
    "faultless": _faultless,
}
"""Gives the successes and trials of each run, by what is asked."""


MEANINGS: Mapping[str, str] = {
    "recall": "true manoeuvres in view that were recognised",
    "precision": "recognitions that the truth confirms",
    "detection": "runs, of those with anything true in view, in which all of it was recognised",
    "false_alarms": "runs with a recognition that is false",
    "faultless": "runs in which everything true was recognised and nothing false",
}
"""Says of what a measure is the share, by what is asked."""


def is_less_better(measure: str) -> bool:
    """Return whether a measure counts what should not be."""
    return measure.endswith(".false_alarms")


def _checked(value: object) -> object:
    if not isinstance(value, str):
        raise ValueError(f"expected a measure such as 'overtake.recall', found {value!r}")  # noqa: TRY004, pydantic wants it
    form = _FORM.fullmatch(value)
    if form is None:
        raise ValueError(f"expected a measure such as 'overtake.recall', found '{value}'")
    if form[2] not in MEASURES:
        hint = did_you_mean(nearest_name(form[2], MEASURES))
        known = ", ".join(MEASURES)
        raise ValueError(f"no measure called '{form[2]}'{hint} (there are {known})")
    return value


Measure = Annotated[str, BeforeValidator(_checked)]
"""A measure as it is written: KIND.WHAT."""


def kind_of(measure: str) -> str:
    """Return the kind of manoeuvre that a measure is about."""
    return measure.partition(".")[0]


def share(measure: str, runs: Iterable[Counts]) -> Share:
    """Return what a measure says of the runs of a cell, given what they counted of its kind."""
    pairs = list(MEASURES[measure.partition(".")[2]](runs))
    return Share(sum(pair[0] for pair in pairs), sum(pair[1] for pair in pairs))

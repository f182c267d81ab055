"""Violations of policies as samples of a stream of their own.

The value of such a sample is plain: who, what and why, and the times of the sample that was left
out. The violation itself is put together again from it.
"""

from collections.abc import Callable
from typing import Any

from dyknow.recordings.layout import EMPTY, Layout, grown
from dyknow.runtime.generators import Label
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Constraint, Violation
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["VIOLATIONS", "layout_of_violations", "sample_from_violation", "violation_from_sample"]

VIOLATIONS = "violations"
"""The topic of the violations of all streams."""

FindSample = Callable[[str, TimePoint], Sample[Any] | None]
"""Returns the sample of a topic that became available at a time, if it was recorded."""


def sample_from_violation(violation: StreamViolation) -> Sample[dict[str, Any]]:
    """Return what is written of a violation, available when it was noticed."""
    what = violation.violation
    fields = {
        "provider": str(violation.provider),
        "receiver": str(violation.receiver),
        "number": violation.number,
        "constraint": what.constraint.value,
        "reason": what.reason,
        "definition": what.definition,
        "sample_available_time": None if what.sample is None else int(what.sample.available_time),
    }
    return Sample(fields, what.valid_time, what.noticed_at)


def violation_from_sample(sample: Sample[Any], find: FindSample) -> StreamViolation:
    """Return the violation of which *sample* was written; *find* finds the sample left out.

    Raises:
        KeyError, TypeError, ValueError: The sample is something else.
    """
    fields = sample.value
    key = fields["sample_available_time"]
    provider = Label(fields["provider"])
    violation = Violation(
        Constraint(fields["constraint"]),
        sample.valid_time,
        sample.available_time,
        fields["reason"],
        None if key is None else find(provider, TimePoint(key)),
        definition=fields["definition"],
    )
    return StreamViolation(provider, Label(fields["receiver"]), violation, fields["number"])


def layout_of_violations() -> Layout:
    """Return the layout of all violations, with and without a sample that was left out."""
    layout = EMPTY
    for sample in (None, Sample(None, TimePoint(0), TimePoint(0))):
        violation = Violation(Constraint.DELAY, TimePoint(0), TimePoint(0), "", sample)
        example = StreamViolation(Label(""), Label(""), violation)
        layout = grown(layout, sample_from_violation(example).value)
    return layout

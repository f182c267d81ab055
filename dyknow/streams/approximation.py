"""The stream that a policy is applied to: with approximated samples, if it asks for them.

This is `extend` of Heintz (2009), definition 4.5.10, except for when samples are available;
`dyknow.streams.conformance` says why.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from dyknow.streams.history import History
from dyknow.streams.policy import Approximation, Policy
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.streams.stream import FluentStream, available
from dyknow.time import TimePoint

__all__ = ["ExtendedSample", "extend", "extended_samples"]


@dataclass(frozen=True, slots=True)
class ExtendedSample:
    """A sample that a stream may have, and since when it must have it.

    Attributes:
        sample: The sample, available as soon as it can be known.
        due: When it is certain that nothing better comes.
    """

    sample: Sample[Any]
    due: TimePoint


def extend(stream: FluentStream, policy: Policy, until: TimePoint) -> list[Sample[Any]]:
    """Return the samples that a stream under *policy* may have, as far as is known at *until*.

    With `use most recent`, for each time of the grid, that is the first sample of exactly this
    valid time, if it comes within the maximal delay; if none comes, the value that is the most
    recent then. A time at which there is no value yet gives no sample.
    """
    return [extended.sample for extended in extended_samples(stream, policy, until)]


def extended_samples(
    stream: FluentStream, policy: Policy, until: TimePoint
) -> list[ExtendedSample]:
    """Return the samples of `extend`, and when each of them is due."""
    known = available(stream, until)
    if policy.approximation is Approximation.NONE:
        return [ExtendedSample(sample, sample.available_time) for sample in known]
    return list(_on_grid(known, policy, until))


def _on_grid(known: FluentStream, policy: Policy, until: TimePoint) -> Iterator[ExtendedSample]:
    assert policy.period is not None  # the policy says so itself
    assert policy.max_delay is not None
    first_of: dict[TimePoint, Sample[Any]] = {}
    for sample in known:
        first_of.setdefault(sample.valid_time, sample)
    history = History(known)
    due = TimePoint(-1)
    for time in range(policy.first, _end(known, policy, until) + 1, policy.period):
        deadline = TimePoint(time + policy.max_delay)
        exact = first_of.get(TimePoint(time), NO_SAMPLE)
        if exact is not NO_SAMPLE and exact.available_time <= deadline:
            due = max(due, exact.available_time)
            yield ExtendedSample(exact, due)
            continue
        due = max(due, deadline)
        recent = history.most_recent_at(TimePoint(time), min(deadline, until))
        if recent is not NO_SAMPLE and time <= until:
            since = max(TimePoint(time), recent.available_time)
            yield ExtendedSample(Sample(recent.value, TimePoint(time), since), due)


def _end(known: FluentStream, policy: Policy, until: TimePoint) -> TimePoint:
    last = max((sample.valid_time for sample in known), default=until)
    return max(until, last) if policy.end is None else min(max(until, last), policy.end)

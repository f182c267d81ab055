"""Does a finished stream keep a policy?

This is the meaning of policies as definitions 4.5.9 to 4.5.11 of Heintz (2009) give it, against
which the adapters that work online are tested.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Constraint,
    Order,
    Policy,
    SampleEvery,
    Violation,
)
from dyknow.streams.sample import Sample
from dyknow.streams.stream import FluentStream, most_recent_at
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint, text_from_duration

__all__ = ["extend", "is_substream", "keeps", "violations"]


def keeps(stream: FluentStream, policy: Policy) -> bool:
    """Return whether *stream* satisfies *policy* (definition 4.5.11)."""
    return not violations(stream, policy)


def violations(stream: FluentStream, policy: Policy) -> list[Violation]:
    """Return every place where *stream* breaks *policy*, in order of available time."""
    found: list[Violation] = []
    for sample in stream[:1]:
        found.extend(_alone(sample, policy))
    for before, sample in pairwise(stream):
        found.extend(_alone(sample, policy))
        found.extend(_together(before, sample, policy))
    return found


def is_substream(part: FluentStream, whole: FluentStream) -> bool:
    """Return whether *part* could be made from *whole* by delay and omission (def. 4.5.9)."""
    return all(any(_is_source_of(other, sample) for other in whole) for sample in part)


def extend(stream: FluentStream, policy: Policy, until: TimePoint) -> FluentStream:
    """Return the stream with approximated samples, as far as *until* (definition 4.5.10).

    The definition's stream may be endless, hence *until*. A time-point at which nothing has
    been available yet gives no sample.
    """
    if policy.approximation is Approximation.NONE:
        return stream
    assert policy.period is not None  # the policy says so itself
    assert policy.max_delay is not None
    end = until if policy.end is None else min(until, policy.end)
    extended = []
    for time in range(policy.first, end + 1, policy.period):
        query_time = TimePoint(time + policy.max_delay)
        value = most_recent_at(stream, TimePoint(time), query_time)
        if value.valid_time >= 0:
            extended.append(Sample(value.value, TimePoint(time), query_time))
    return extended


def _is_source_of(other: Sample[Any], sample: Sample[Any]) -> bool:
    return (
        other.available_time <= sample.available_time
        and other.valid_time == sample.valid_time
        and are_equal(other.value, sample.value)
    )


def _alone(sample: Sample[Any], policy: Policy) -> Iterator[Violation]:
    if not policy.covers(sample.valid_time):
        yield _violation(Constraint.DURATION, sample, "the valid time lies outside the duration")
    if not policy.allows_delay(sample.delay):
        found = text_from_duration(sample.delay)
        allowed = text_from_duration(policy.max_delay or 0)
        yield _violation(
            Constraint.DELAY, sample, f"expected a delay of at most {allowed}, found {found}"
        )


def _together(before: Sample[Any], sample: Sample[Any], policy: Policy) -> Iterator[Violation]:
    step = sample.valid_time - before.valid_time
    if (policy.order is Order.STRICT and step <= 0) or (
        policy.order is Order.MONOTONE and step < 0
    ):
        then = text_from_duration(before.valid_time)
        yield _violation(
            Constraint.ORDER,
            sample,
            f"the valid time does not follow {then} in {policy.order.value}",
        )
    if isinstance(policy.change, SampleEvery) and step != policy.change.period:
        expected = text_from_duration(before.valid_time + policy.change.period)
        yield _violation(
            Constraint.CHANGE, sample, f"expected the sample with valid time {expected}"
        )
    if policy.change is ANY_CHANGE and step == 0 and are_equal(before.value, sample.value):
        yield _violation(Constraint.CHANGE, sample, "neither value nor valid time has changed")


def _violation(constraint: Constraint, sample: Sample[Any], reason: str) -> Violation:
    return Violation(constraint, sample.valid_time, sample.available_time, reason)

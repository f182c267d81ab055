"""Is a finished stream one that its term allows?

This is the meaning of policies as definitions 4.5.9 to 4.5.11 of Heintz (2009) give it, against
which the adapters that work online are tested. In three places we depart from the letter.

- Each sample of a generator is handed on at most once. By the letter a sample could be repeated
  without end, later and later, and a stream that is not sampled would never be maximal.
- Under `any change` samples keep their order. By the letter a repetition that was left out could
  come back after another value, where it would be a change.
- With `use most recent`, a sample of exactly the valid time wanted may be handed on when it
  arrives, and it is the first of them that counts; by the letter it is the last that comes
  before the end of the maximal delay, which must always be waited for. An approximation may be
  handed on as soon as the value that it repeats is there: whoever has heard a heartbeat knows
  that none will come that is better.

Where a stream may be given a longer period under load, what a shorter period would have asked for
besides is not missed.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from dyknow.streams.approximation import extend
from dyknow.streams.content import Contents
from dyknow.streams.maximality import omissions
from dyknow.streams.policy import (
    ANY_CHANGE,
    Constraint,
    Order,
    Policy,
    SampleEvery,
    Violation,
)
from dyknow.streams.sample import Sample
from dyknow.streams.stream import FluentStream
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint, text_from_duration

__all__ = [
    "is_maximal",
    "is_substream",
    "satisfies",
    "term_violations",
    "violations",
]


def satisfies(stream: FluentStream, policy: Policy) -> bool:
    """Return whether *stream* satisfies *policy* (definition 4.5.11)."""
    return not violations(stream, policy)


def is_substream(part: FluentStream, whole: FluentStream) -> bool:
    """Return whether *part* could be made from *whole* by delay and omission (def. 4.5.9)."""
    return not _strangers(part, whole)


def is_maximal(part: FluentStream, whole: FluentStream, policy: Policy, until: TimePoint) -> bool:
    """Return whether *part* has all that *policy* lets through of *whole* (definition 4.5.10).

    *part* satisfies the policy and is a substream of the extended stream. *until* is the time up
    to which both are known.
    """
    return not omissions(part, whole, policy, until)


def violations(stream: FluentStream, policy: Policy) -> list[Violation]:
    """Return every place where *stream* breaks *policy*, in order of available time."""
    found: list[Violation] = []
    for sample in stream[:1]:
        found.extend(_alone(sample, policy))
    for before, sample in pairwise(stream):
        found.extend(_alone(sample, policy))
        found.extend(_together(before, sample, policy))
    return found


def term_violations(
    part: FluentStream, whole: FluentStream, policy: Policy, until: TimePoint
) -> list[Violation]:
    """Return why *part* is not a stream that `whole with policy` allows, and where.

    Each violation names its definition: 4.3.5 for available times out of order, 4.5.9 for a
    sample that the generator has not produced, 4.5.10 for one that is left out, and 4.5.11 for a
    constraint that is broken. They are in order of the time at which they could be noticed. What
    is left out is only looked for in streams whose other samples are as they should be; gaps of a
    sampled stream are no hindrance.
    """
    found = [*_unordered(part), *_strangers(part, extend(whole, policy, until))]
    found += violations(part, policy)
    if all(one.constraint is Constraint.CHANGE and policy.period for one in found):
        found += [_omission(sample) for sample in omissions(part, whole, policy, until)]
    return sorted(found, key=lambda violation: violation.noticed_at)


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
    if isinstance(policy.change, SampleEvery) and not policy.change.allows_step(step):
        reason = f"expected the sample with valid time {_expected(before, policy.change)}"
        yield _violation(Constraint.CHANGE, sample, reason)
    if policy.change is ANY_CHANGE and step == 0 and are_equal(before.value, sample.value):
        yield _violation(Constraint.CHANGE, sample, "neither value nor valid time has changed")


def _expected(before: Sample[Any], change: SampleEvery) -> str:
    times = [text_from_duration(before.valid_time + period) for period in change.periods()]
    deviation = text_from_duration(change.deviation)
    within = f", give or take {deviation}" if change.deviation else ""
    return f"{' or '.join(times)}{within}"


def _unordered(stream: FluentStream) -> list[Violation]:
    return [
        Violation(
            Constraint.AVAILABILITY,
            sample.valid_time,
            sample.available_time,
            "the available time is not later than "
            f"{text_from_duration(before.available_time)} of the sample before it",
            sample,
            definition="4.3.5",
        )
        for before, sample in pairwise(stream)
        if sample.available_time <= before.available_time
    ]


def _strangers(part: FluentStream, whole: FluentStream) -> list[Violation]:
    """Return the samples of *part* that *whole* has not got, or not got in time."""
    earliest: dict[int, TimePoint] = {}
    contents = Contents()
    for sample in whole:
        earliest.setdefault(contents.number(sample), sample.available_time)
    found = []
    for sample in part:
        since = earliest.get(contents.number(sample))
        if since is None:
            reason = "the generator has no sample of this valid time and value"
        elif since > sample.available_time:
            reason = f"the generator has this sample no earlier than {text_from_duration(since)}"
        else:
            continue
        found.append(_violation(Constraint.ORIGIN, sample, reason, definition="4.5.9"))
    return found


def _omission(sample: Sample[Any]) -> Violation:
    reason = "the policy would let this sample through"
    return _violation(Constraint.OMISSION, sample, reason, definition="4.5.10")


def _violation(
    constraint: Constraint, sample: Sample[Any], reason: str, *, definition: str = "4.5.11"
) -> Violation:
    times = (sample.valid_time, sample.available_time)
    return Violation(constraint, *times, reason, sample, definition=definition)

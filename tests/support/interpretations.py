"""Every stream that a term allows, found by trying everything; for very small streams.

The semantics is that of Heintz (2009), definitions 4.5.9 to 4.5.11, with the departures that
`dyknow.streams.conformance` names, written down as directly as possible.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Order,
    Policy,
    SampleEvery,
)
from dyknow.streams.sample import Sample
from dyknow.streams.stream import FluentStream, most_recent_at
from dyknow.time import TimePoint

__all__ = ["Content", "content", "interpretations", "naive_extend", "satisfying", "substreams"]

Content = frozenset[tuple[TimePoint, TimePoint, Any]]
"""A stream as the set of its samples: available time, valid time, value."""


def content(stream: FluentStream) -> Content:
    """Return the set that a stream is."""
    return frozenset((s.available_time, s.valid_time, s.value) for s in stream)


def interpretations(whole: FluentStream, policy: Policy, horizon: int) -> set[Content]:
    """Return all maximal streams that *whole* under *policy* allows (definition 4.5.10).

    *whole* is the extended stream; available times up to *horizon* are tried.
    """
    allowed = satisfying(whole, policy, horizon)
    return {one for one in allowed if not any(one < other for other in allowed)}


def satisfying(whole: FluentStream, policy: Policy, horizon: int) -> set[Content]:
    """Return all substreams of *whole* that satisfy *policy* (definition 4.5.10)."""
    return {
        content(part)
        for part in substreams(whole, horizon, ordered=policy.change is ANY_CHANGE)
        if _satisfies(part, policy)
    }


def substreams(
    whole: FluentStream, horizon: int, *, ordered: bool = False
) -> Iterator[list[Sample[Any]]]:
    """Yield *whole* with every choice of omissions and delays (definition 4.5.9)."""
    for times in _delays(whole, horizon):
        delayed = [
            Sample(sample.value, sample.valid_time, time)
            for sample, time in zip(whole, times, strict=True)
            if time is not None
        ]
        in_order = sorted(delayed, key=lambda sample: sample.available_time)
        if not ordered or in_order == delayed:
            yield in_order


def _delays(whole: FluentStream, horizon: int) -> Iterator[tuple[TimePoint | None, ...]]:
    if not whole:
        yield ()
        return
    for times in _delays(whole[:-1], horizon):
        yield (*times, None)
        for time in range(whole[-1].available_time, horizon + 1):
            if time not in times:
                yield (*times, TimePoint(time))


def _satisfies(part: Sequence[Sample[Any]], policy: Policy) -> bool:
    alone = all(policy.covers(s.valid_time) and policy.allows_delay(s.delay) for s in part)
    return alone and all(_follows(before, sample, policy) for before, sample in pairwise(part))


def _follows(before: Sample[Any], sample: Sample[Any], policy: Policy) -> bool:
    step = sample.valid_time - before.valid_time
    if policy.order is Order.MONOTONE and step < 0:
        return False
    if policy.order is Order.STRICT and step <= 0:
        return False
    match policy.change:
        case SampleEvery(period, deviation, longest):
            multiples = range(period, (longest or period) + 1, period)
            return any(abs(step - multiple) <= deviation for multiple in multiples)
        case change if change is ANY_CHANGE:
            return step != 0 or before.value != sample.value
        case _:
            return True


def naive_extend(stream: FluentStream, policy: Policy, until: TimePoint) -> list[Sample[Any]]:
    """Return the extended stream as the definition says, exact samples apart (def. 4.5.10)."""
    if policy.approximation is Approximation.NONE:
        return [sample for sample in stream if sample.available_time <= until]
    assert policy.period is not None
    assert policy.max_delay is not None
    extended = []
    end = until if policy.end is None else min(until, policy.end)
    for time in range(policy.first, end + 1, policy.period):
        deadline = min(until, TimePoint(time + policy.max_delay))
        exact = [s for s in stream if s.valid_time == time and s.available_time <= deadline]
        if exact:
            extended.append(exact[0])
            continue
        recent = most_recent_at(stream, TimePoint(time), deadline)
        if recent.valid_time >= 0:
            since = max(TimePoint(time), recent.available_time)
            extended.append(Sample(recent.value, TimePoint(time), since))
    return extended

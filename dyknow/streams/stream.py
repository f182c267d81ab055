"""Fluent streams, and the questions that can be asked of them.

A fluent stream is a sequence of samples in order of available time, which is unique. Each
function here is one definition of Heintz (2009), *DyKnow: A Stream-Based Knowledge Processing
Middleware Framework*, section 4.3, on a stream that is held as a whole. `NO_SAMPLE` stands for
the absence of an answer. That samples are in order of available time is made use of; whoever
asks many questions of one long stream asks them of a `dyknow.streams.history.History`.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from heapq import merge
from itertools import count, pairwise
from operator import itemgetter
from typing import Any

from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.time import TimePoint

__all__ = [
    "FluentStream",
    "available",
    "available_times",
    "is_fluent_stream",
    "join",
    "last_available",
    "last_valid_before",
    "most_recent_at",
    "previous",
    "valid_before",
]

FluentStream = Sequence[Sample[Any]]
"""Samples in order of available time (definition 4.3.5)."""


def is_fluent_stream(samples: FluentStream) -> bool:
    """Return whether available times are unique and in order (definition 4.3.5)."""
    return all(
        one.available_time < other.available_time for one, other in pairwise(samples)
    ) and not any(sample is NO_SAMPLE for sample in samples)


def available(stream: FluentStream, time: TimePoint) -> FluentStream:
    """Return the samples that are available at *time* (definition 4.3.7)."""
    return stream[: bisect_right(stream, time, key=_available_time)]


def last_available(stream: FluentStream, time: TimePoint) -> Sample[Any]:
    """Return the sample that became available last, up to *time* (definition 4.3.8)."""
    number = bisect_right(stream, time, key=_available_time)
    return stream[number - 1] if number else NO_SAMPLE


def valid_before(stream: FluentStream, time: TimePoint, query_time: TimePoint) -> FluentStream:
    """Return what is available at *query_time* and valid at or before *time* (def. 4.3.9)."""
    return [sample for sample in available(stream, query_time) if sample.valid_time <= time]


def last_valid_before(
    stream: FluentStream, time: TimePoint, query_time: TimePoint
) -> FluentStream:
    """Return those of `valid_before` with the highest valid time (definition 4.3.10)."""
    candidates = valid_before(stream, time, query_time)
    newest = max((sample.valid_time for sample in candidates), default=None)
    return [sample for sample in candidates if sample.valid_time == newest]


def most_recent_at(stream: FluentStream, time: TimePoint, query_time: TimePoint) -> Sample[Any]:
    """Return the one of `last_valid_before` that became available last (definition 4.3.11)."""
    return last_available(last_valid_before(stream, time, query_time), query_time)


def previous(stream: FluentStream, sample: Sample[Any]) -> Sample[Any]:
    """Return the sample that became available before *sample* (definition 4.3.12)."""
    if sample is NO_SAMPLE:
        return NO_SAMPLE
    number = bisect_left(stream, sample.available_time, key=_available_time)
    return stream[number - 1] if number else NO_SAMPLE


def available_times(*streams: FluentStream) -> set[TimePoint]:
    """Return when a sample of any of *streams* became available (definition 4.3.13)."""
    return {sample.available_time for stream in streams for sample in stream}


def join(*streams: FluentStream) -> FluentStream:
    """Return, for each time with something new, the last of each stream (definition 4.3.16)."""
    last = [NO_SAMPLE] * len(streams)
    joined: list[Sample[Any]] = []
    for time, at, sample in merge(*map(_numbered, count(), streams), key=itemgetter(0)):
        last[at] = sample
        if joined and joined[-1].available_time == time:
            joined[-1].value = tuple(last)
        else:
            joined.append(Sample(tuple(last), time, time))
    return joined


def _numbered(at: int, stream: FluentStream) -> Iterable[tuple[TimePoint, int, Sample[Any]]]:
    return ((sample.available_time, at, sample) for sample in stream)


def _available_time(sample: Sample[Any]) -> TimePoint:
    return sample.available_time

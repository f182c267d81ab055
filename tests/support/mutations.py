"""Ways of spoiling a recorded stream."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["MUTATIONS", "Mutation"]

Samples = list[Sample[Any]]
Mutation = Callable[[Samples, int], Samples]
"""Returns a stream that is spoilt at a place."""


def drop(samples: Samples, at: int) -> Samples:
    """Leave a sample out."""
    return [*samples[:at], *samples[at + 1 :]]


def delay(samples: Samples, at: int) -> Samples:
    """Make a sample available a nanosecond later."""
    return _shifted(samples, at, 1)


def hasten(samples: Samples, at: int) -> Samples:
    """Make a sample available a nanosecond earlier."""
    return _shifted(samples, at, -1)


def date_back(samples: Samples, at: int) -> Samples:
    """Alter a valid time."""
    sample = samples[at]
    valid_time = TimePoint(sample.valid_time - 1)
    return [*samples[:at], replace(sample, valid_time=valid_time), *samples[at + 1 :]]


def alter(samples: Samples, at: int) -> Samples:
    """Alter a value."""
    return [*samples[:at], replace(samples[at], value="altered"), *samples[at + 1 :]]


def repeat(samples: Samples, at: int) -> Samples:
    """Give a sample twice, at one available time."""
    return [*samples[: at + 1], *samples[at:]]


def repeat_later(samples: Samples, at: int) -> Samples:
    """Give a sample again, a nanosecond later."""
    sample = samples[at]
    later = replace(sample, available_time=TimePoint(sample.available_time + 1))
    return [*samples[: at + 1], later, *samples[at + 1 :]]


def insert(samples: Samples, at: int) -> Samples:
    """Put in a sample that nobody has made."""
    sample = samples[at]
    before = Sample("inserted", sample.valid_time, TimePoint(sample.available_time - 1))
    return [*samples[:at], before, *samples[at:]]


def disorder(samples: Samples, at: int) -> Samples:
    """Exchange a sample with the one before it in the stream; their times stay as they are."""
    other = (at or 1) - 1
    return [*samples[:other], samples[at], samples[other], *samples[at + 1 :]] if at else samples


def exchange(samples: Samples, at: int) -> Samples:
    """Exchange the available times of a sample and the one before it."""
    if at == 0:
        return samples
    one, other = samples[at - 1], samples[at]
    later = replace(one, available_time=other.available_time)
    sooner = replace(other, available_time=one.available_time)
    return [*samples[: at - 1], sooner, later, *samples[at + 1 :]]


MUTATIONS: Sequence[Mutation] = (
    drop,
    delay,
    hasten,
    date_back,
    alter,
    repeat,
    repeat_later,
    insert,
    disorder,
    exchange,
)
"""All of them."""


def _shifted(samples: Samples, at: int, by: int) -> Samples:
    sample = samples[at]
    shifted = replace(sample, available_time=TimePoint(sample.available_time + by))
    return [*samples[:at], shifted, *samples[at + 1 :]]

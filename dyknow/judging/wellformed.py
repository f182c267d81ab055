"""What every stream must be, whoever makes it: in order, of its sort, true to its heartbeats."""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

from dyknow.judging.judgement import Breach, Definition
from dyknow.judging.wording import short
from dyknow.streams.sample import BEGINNING_OF_TIME, Heartbeat, Sample
from dyknow.time import text_from_duration

__all__ = ["heartbeat_breaches", "order_breaches", "sort_breaches"]


def order_breaches(topic: str, samples: Sequence[Sample[Any]]) -> Iterator[Breach]:
    """Yield where available times are not unique or not in order (definition 4.3.5)."""
    for before, sample in pairwise(samples):
        if sample.available_time > before.available_time:
            continue
        found = "the same one again"
        if sample.available_time < before.available_time:
            found = text_from_duration(sample.available_time)
        after = text_from_duration(before.available_time)
        wanted = f"an available time after {after}"
        yield Breach.at(topic, Definition.FLUENT_STREAM, sample, wanted, found)


def sort_breaches(
    topic: str, samples: Sequence[Sample[Any]], fault_of: Callable[[Any], str | None], sort: str
) -> Iterator[Breach]:
    """Yield the samples whose values are not of their sort (definition 4.5.4)."""
    for sample in samples:
        if fault := fault_of(sample.value):
            wanted = f"a value of sort '{sort}'"
            found = f"{short(sample.value)}: {fault}"
            yield Breach.at(topic, Definition.SORT, sample, wanted, found)


def heartbeat_breaches(
    topic: str, samples: Sequence[Sample[Any]], heartbeats: Sequence[Heartbeat]
) -> Iterator[Breach]:
    """Yield the samples that an earlier heartbeat has ruled out."""
    at, until = 0, BEGINNING_OF_TIME
    for sample in samples:
        while at < len(heartbeats) and heartbeats[at].available_time < sample.available_time:
            until = max(until, heartbeats[at].until)
            at += 1
        if sample.valid_time <= until:
            wanted = f"a valid time after {text_from_duration(until)}, as a heartbeat has promised"
            found = text_from_duration(sample.valid_time)
            yield Breach.at(topic, Definition.HEARTBEAT, sample, wanted, found)

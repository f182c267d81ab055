"""Strategies for streams and policies, and what an adapter makes of a stream."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from hypothesis import strategies as st

from dyknow.streams.adapter import Adapter, VariesPeriod, adapter_for
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import (
    ANY_CHANGE,
    ANY_UPDATE,
    Approximation,
    Order,
    Policy,
    SampleEvery,
    Violation,
)
from dyknow.streams.process import Element
from dyknow.streams.sample import END_OF_TIME, Heartbeat, Sample
from dyknow.time import Duration, TimePoint
from tests.support.streams import ms

__all__ = [
    "adapted",
    "adapted_elements",
    "approximating_policies",
    "heartbeats",
    "lengthened",
    "policies",
    "samplings",
    "streams",
]

_TIMES = st.integers(0, 12).map(lambda n: ms(10 * n))
_PERIODS = st.sampled_from([10, 20, 30]).map(ms)


@st.composite
def streams(draw: st.DrawFn, size: int = 12) -> list[Sample[Any]]:
    """Draw streams in any order of valid time, with repetitions and delays."""
    available = draw(st.lists(st.integers(0, 20), max_size=size, unique=True).map(sorted))
    valid = [draw(st.integers(0, min(12, at))) for at in available]
    values = [draw(st.sampled_from("ab")) for _ in available]
    samples = zip(values, valid, available, strict=True)
    return [Sample(value, ms(10 * v), ms(10 * a)) for value, v, a in samples]


@st.composite
def samplings(draw: st.DrawFn) -> SampleEvery:
    """Draw `sample every`, with and without deviation and a longest period."""
    period = draw(_PERIODS)
    deviation = draw(st.sampled_from([0, 0, 3, 8]).map(ms).filter(lambda one: one < period))
    longest = draw(st.sampled_from([None, None, 2, 3]))
    return SampleEvery(
        Duration(period), Duration(deviation), longest and Duration(longest * period)
    )


@st.composite
def lengthened(draw: st.DrawFn, policy: Policy) -> dict[TimePoint, Duration]:
    """Draw times at which a stream is given another of the periods that its policy allows."""
    if not isinstance(policy.change, SampleEvery):
        return {}
    periods = list(map(Duration, policy.change.periods()))
    return draw(
        st.dictionaries(
            st.integers(0, 20).map(lambda n: ms(10 * n)), st.sampled_from(periods), max_size=4
        )
    )


@st.composite
def policies(draw: st.DrawFn) -> Policy:
    """Draw policies without approximation."""
    start = draw(st.none() | _TIMES)
    length = draw(st.none() | _TIMES)
    return Policy(
        change=draw(st.sampled_from([ANY_UPDATE, ANY_CHANGE]) | samplings()),
        max_delay=draw(st.none() | _TIMES),
        start=start,
        end=None if length is None else TimePoint((start or 0) + length),
        order=draw(st.sampled_from(Order)),
    )


@st.composite
def approximating_policies(draw: st.DrawFn) -> Policy:
    """Draw policies with `use most recent`."""
    start = draw(_TIMES)
    return Policy(
        approximation=Approximation.MOST_RECENT,
        change=draw(samplings().map(lambda one: replace(one, deviation=Duration(0)))),
        max_delay=draw(_TIMES),
        start=start,
        end=draw(st.none() | _TIMES.map(lambda length: TimePoint(start + length))),
    )


@st.composite
def heartbeats(draw: st.DrawFn, samples: list[Sample[Any]]) -> list[Heartbeat]:
    """Draw heartbeats that the samples of a stream do not give the lie."""
    found = []
    for time in draw(st.lists(st.integers(0, 22), max_size=4, unique=True).map(sorted)):
        now = ms(10 * time)
        to_come = [sample.valid_time for sample in samples if sample.available_time > now]
        limit = min(to_come, default=TimePoint(END_OF_TIME + 1)) - 1
        until = draw(st.just(limit) | _TIMES)
        if until <= limit:
            found.append(Heartbeat(TimePoint(until), now))
    return found


def adapted(
    elements: Sequence[Element],
    policy: Policy,
    until: TimePoint,
    periods: Mapping[TimePoint, Duration] = MappingProxyType({}),
) -> tuple[list[Sample[Any]], list[Violation]]:
    """Return what an adapter makes of a stream, and the violations it publishes.

    With *periods*, the adapter is given another period at each of the times.
    """
    made, published = adapted_elements(elements, policy, until, periods)
    return [one for one in made if isinstance(one, Sample)], published


def adapted_elements(
    elements: Sequence[Element],
    policy: Policy,
    until: TimePoint,
    periods: Mapping[TimePoint, Duration] = MappingProxyType({}),
) -> tuple[list[Element], list[Violation]]:
    """Return the samples and heartbeats that an adapter makes, and the violations."""
    happenings = _happenings(elements, periods)
    adapter = adapter_for(policy) or Filter(policy)
    made: list[Element] = []
    pending = sorted(time for time in happenings if time <= until)
    while True:
        due = adapter.due()
        times = [*pending[:1], *([due] if due is not None and due <= until else [])]
        if not times:
            return made, list(adapter.take_violations())
        now = min(times)
        if pending[:1] == [now]:
            for happening in happenings[pending.pop(0)]:
                made.extend(_tell(adapter, happening, now))
        due = adapter.due()
        if due is not None and due <= now:
            made.extend(adapter.advance(now))


def _happenings(
    elements: Sequence[Element], periods: Mapping[TimePoint, Duration]
) -> dict[TimePoint, list[Element | Duration]]:
    """Return what an adapter is told at each time: samples, then heartbeats, then periods."""
    samples = [one for one in elements if isinstance(one, Sample)]
    beats = [one for one in elements if isinstance(one, Heartbeat)]
    told: dict[TimePoint, list[Element | Duration]] = {}
    for element in (*samples, *beats):
        told.setdefault(element.available_time, []).append(element)
    for time, period in periods.items():
        told.setdefault(time, []).append(period)
    return told


def _tell(adapter: Adapter, happening: Element | Duration, now: TimePoint) -> Iterable[Element]:
    if isinstance(happening, Heartbeat):
        return adapter.beat(happening)
    if isinstance(happening, Sample):
        return adapter.push(happening)
    assert isinstance(adapter, VariesPeriod)
    return adapter.set_period(happening, now)

"""Strategies for streams and policies, and what an adapter makes of a stream."""

from typing import Any

from hypothesis import strategies as st

from dyknow.streams.adapter import adapter_for
from dyknow.streams.policy import (
    ANY_CHANGE,
    ANY_UPDATE,
    Approximation,
    Order,
    Policy,
    SampleEvery,
    Violation,
)
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from tests.support.streams import ms

__all__ = ["adapted", "approximating_policies", "policies", "streams"]

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
def policies(draw: st.DrawFn) -> Policy:
    """Draw policies without approximation."""
    start = draw(st.none() | _TIMES)
    length = draw(st.none() | _TIMES)
    return Policy(
        change=draw(st.sampled_from([ANY_UPDATE, ANY_CHANGE]) | _PERIODS.map(SampleEvery)),
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
        change=SampleEvery(draw(_PERIODS)),
        max_delay=draw(_TIMES),
        start=start,
        end=draw(st.none() | _TIMES.map(lambda length: TimePoint(start + length))),
    )


def adapted(
    samples: list[Sample[Any]], policy: Policy, until: TimePoint
) -> tuple[list[Sample[Any]], list[Violation]]:
    """Return what an adapter makes of a stream, and the violations it publishes."""
    adapter = adapter_for(policy)
    if adapter is None:
        return samples, []
    made: list[Sample[Any]] = []
    arrivals = {sample.available_time: sample for sample in samples}
    pending = sorted(time for time in arrivals if time <= until)
    while True:
        due = adapter.due()
        times = [*pending[:1], *([due] if due is not None and due <= until else [])]
        if not times:
            return made, adapter.take_violations()
        now = min(times)
        if pending and pending[0] == now:
            made.extend(adapter.push(arrivals[pending.pop(0)]))
        due = adapter.due()
        if due is not None and due <= now:
            made.extend(adapter.advance(now))

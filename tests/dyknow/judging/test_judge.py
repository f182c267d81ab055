"""Judging executions of small networks."""

from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.judging.judge import judge
from dyknow.streams.merging import Merge
from dyknow.streams.policy import Policy
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import TimePoint
from tests.dyknow.judging.units import Counting, Hearing, Late, Pairs, Ticking
from tests.support.networks import SmallNetwork
from tests.support.policies import approximating_policies, heartbeats, policies, streams
from tests.support.streams import ms

_UNITS = {
    "pairs": (Pairs, 2),
    "counting": (Counting, 2),
    "hearing": (Hearing, 2),
    "late": (Late, 1),
    "ticking": (Ticking, 1),
    "merge": (lambda: Merge(2), 2),
}


@st.composite
def sources_of(
    draw: st.DrawFn, streams: st.SearchStrategy[list[Sample[Any]]]
) -> list[Sample[Any] | Heartbeat]:
    """Draw streams with heartbeats between the samples."""
    samples = draw(streams)
    return sorted([*samples, *draw(heartbeats(samples))], key=_moment)


def _moment(element: Sample[Any] | Heartbeat) -> tuple[TimePoint, bool]:
    return element.available_time, isinstance(element, Heartbeat)


@st.composite
def networks(draw: st.DrawFn) -> SmallNetwork:
    """Draw networks of small units with random policies."""
    sources = {f"source{n}": draw(sources_of(streams())) for n in range(draw(st.integers(1, 2)))}
    labels = list(sources)
    units = {}
    for at in range(draw(st.integers(1, 4))):
        kind = draw(st.sampled_from(sorted(_UNITS)))
        make, n_inputs = _UNITS[kind]
        terms = [
            (draw(st.sampled_from(labels)), draw(policies() | approximating_policies()))
            for _ in range(n_inputs)
        ]
        units[f"{kind}{at}"] = (make, terms)
        labels.append(f"{kind}{at}")
    policy = draw(policies() | approximating_policies() | st.just(Policy()))
    outputs = {"all": (labels[-1], policy)}
    return SmallNetwork(sources, units, outputs)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(networks(), st.integers(0, 25))
def test_what_the_kernel_does_is_correct(network: SmallNetwork, end: int) -> None:
    """Whatever network the kernel runs, the execution satisfies what was declared."""
    judgement = judge(network.declared(), network.run(ms(10 * end)))

    assert judgement.breaches == ()

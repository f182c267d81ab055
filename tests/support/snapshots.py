"""Snapshots of networks, made up for tests."""

from hypothesis import strategies as st

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.time import Duration, TimePoint

__all__ = ["small_network", "snapshots"]

_TEXTS = st.text(alphabet='abc[]<>&"\\\n→{}|', min_size=1, max_size=8)
_COUNTS = st.integers(min_value=0, max_value=10**12)


def small_network() -> Snapshot:
    """Return a camera, what it sees, and what becomes of it, after two seconds."""
    return Snapshot(
        now=TimePoint(2_000_000_000),
        processes=(
            ProcessFigures(
                label="images", kind=Kind.SOURCE, text="camera", samples=50, seconds=1.0
            ),
            ProcessFigures(
                label="percepts[vision]",
                kind=Kind.UNIT,
                text="Vision(images)",
                depth=1,
                calls=50,
                samples=50,
                seconds=3.0,
                cached=8,
                cache_limit=16,
            ),
            ProcessFigures(label="cars", kind=Kind.LINK, depth=2, samples=20, violations=2),
        ),
        streams=(
            StreamFigures(
                provider="images",
                receiver="percepts[vision]",
                samples=50,
                rate=25.0,
                mean_delay=Duration(0),
            ),
            StreamFigures(
                provider="percepts[vision]",
                receiver="cars",
                policy="sample every 100",
                samples=20,
                rate=10.0,
                mean_delay=Duration(40_000_000),
                delay_99=Duration(80_000_000),
                violations=2,
                late=1,
            ),
            StreamFigures(provider="cars", receiver="cars", number=0, is_output=True),
        ),
        outputs=("cars",),
    )


@st.composite
def snapshots(draw) -> Snapshot:
    """Draw a network in which processes use only earlier ones."""
    labels = draw(st.lists(_TEXTS, min_size=1, max_size=8, unique=True))
    processes, streams = [], []
    for at, label in enumerate(labels):
        inputs = draw(st.lists(st.sampled_from(labels[:at]), max_size=3)) if at else []
        depths = {process.label: process.depth for process in processes}
        depth = 1 + max((depths[provider] for provider in inputs), default=-1)
        processes.append(draw(_process(label, depth)))
        for number, provider in enumerate(inputs, start=1):
            streams.append(draw(_stream(provider, label, number)))
    shown = draw(st.lists(st.sampled_from(labels), max_size=3, unique=True))
    streams += [draw(_stream(provider, f"out {provider}", 0)) for provider in shown]
    return Snapshot(
        now=TimePoint(draw(_COUNTS)), processes=tuple(processes), streams=tuple(streams)
    )


def _process(label: str, depth: int) -> st.SearchStrategy[ProcessFigures]:
    return st.builds(
        ProcessFigures,
        label=st.just(label),
        kind=st.sampled_from(Kind),
        text=_TEXTS,
        depth=st.just(depth),
        policy=_TEXTS,
        calls=_COUNTS,
        seconds=st.floats(min_value=0, max_value=1e6),
        samples=_COUNTS,
        violations=_COUNTS,
        failures=st.integers(min_value=0, max_value=1),
        cached=_COUNTS,
        cache_limit=st.none() | _COUNTS,
    )


def _stream(provider: str, receiver: str, number: int) -> st.SearchStrategy[StreamFigures]:
    return st.builds(
        StreamFigures,
        provider=st.just(provider),
        receiver=st.just(receiver),
        number=st.just(number),
        policy=_TEXTS,
        is_output=st.just(number == 0),
        samples=_COUNTS,
        rate=st.none() | st.floats(min_value=0, max_value=1e6),
        mean_delay=st.none() | _COUNTS,
        delay_99=st.none() | _COUNTS,
        violations=_COUNTS,
        late=_COUNTS,
    )

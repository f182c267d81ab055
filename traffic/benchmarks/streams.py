"""Delivery of samples: the three experiments of Heintz (2009), section 5.5.

The thesis varies the number of streams from one source (figure 5.7), of sources (figure 5.9) and
of computational units (figure 5.11), repeats everything ten times with 600 samples, and tells the
mean delay of the stream that is served last. So does this benchmark; it then goes on to ten
thousand streams. The published curves are drawn from the figures that the text gives for them.
"""

import time
import tracemalloc
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from traffic.benchmarks.measuring import (
    Benchmark,
    OnProgress,
    Plan,
    line_through,
    measure,
    series,
    undisturbed,
)
from traffic.benchmarks.peers import PEERS, Peer, installed_peers, missing_peers, ratio_to
from traffic.benchmarks.results import (
    Experiment,
    Figure,
    Findings,
    Measurement,
    Point,
    Published,
    Ratio,
)
from traffic.benchmarks.workloads import (
    PERIOD,
    Steady,
    Workload,
    ignore,
    many_deadlines,
    many_policies,
    many_sources,
    many_streams,
    many_units,
)

__all__ = ["BENCHMARK"]

_MICROSECONDS = 1e6
_N_SAMPLES = 600
_REPETITIONS = 10
_N_STREAMS = range(5, 51, 5)
_MANY_STREAMS = (100, 200, 500, 1_000, 2_000, 5_000, 10_000)
_N_SOURCES = range(1, 20, 2)
_N_UNITS = range(1, 16, 2)
_STREAMS_OF_SOURCES = 19
_STREAMS_OF_UNITS = 30
_N_FOR_MEMORY = 1_000
_N_FOR_PEERS = 50

_MACHINE = "CORBA event channel, on a Pentium-M at 1.4 GHz"
_BY_STREAMS = Published(
    source="Heintz (2009), figure 5.7",
    unit="ms",
    points=[(n, 2.0 * n) for n in _N_STREAMS],
    remark=f"drawn from the text: about 2 ms per stream; {_MACHINE}",
)
_SLOPES = {
    "streams": "2000 µs (Heintz 2009, figure 5.7)",
    "sources": "1000 µs (Heintz 2009, figure 5.9)",
    "units": "linear (Heintz 2009, figure 5.11)",
}
_BY_SOURCES = Published(
    source="Heintz (2009), figure 5.9",
    unit="ms",
    points=[(n, 40.0 + n) for n in _N_SOURCES],
    remark=f"drawn from the text: 40 ms for 19 streams, 1 ms per source; {_MACHINE}",
)


_SHARED = "one policy for all"
_OWN = "a policy of its own for each"
_DEADLINES = "and a deadline of its own"
_STREAMS: Mapping[str, Callable[[int], Workload]] = {
    _SHARED: lambda n: Workload(many_streams(n)),
    _OWN: lambda n: Workload(many_policies(n)),
    _DEADLINES: lambda n: Workload(many_deadlines(n)),
}
"""The thesis has the first; streams under equal policies share an adapter, others cannot.

With a maximal delay a stream also has an alarm for each sample, for it must notice missing ones.
"""


@dataclass(frozen=True, slots=True)
class _Sweep:
    """One experiment: a network that grows."""

    name: str
    what: str
    x: str
    numbers: Sequence[int]
    workloads: Mapping[str, Callable[[int], Workload]]
    n_samples: int
    one_more: str
    published: Published | None = None
    logarithmic: bool = False


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Repeat the three experiments, go on to many streams, and measure the memory of a stream."""
    repetitions = 2 if plan.quick else _REPETITIONS
    sweeps = _sweeps(quick=plan.quick)
    experiments, figures = [], []
    for at, sweep in enumerate(sweeps):
        within = (0.9 * at / len(sweeps), 0.9 * (at + 1) / len(sweeps))
        experiment, slopes = _measured(sweep, repetitions, on_progress, within)
        experiments.append(experiment)
        figures += slopes
    n_for_memory = 100 if plan.quick else _N_FOR_MEMORY
    figures += [_memory(name, make(n_for_memory), n_for_memory) for name, make in _STREAMS.items()]
    n_samples = 10 if plan.quick else _N_SAMPLES
    ratios = [
        _fan_out(peer, n_samples, repetitions, shared=shared)
        for peer in installed_peers()
        for shared in (False, True)
    ]
    return Findings(experiments=experiments, figures=figures, ratios=ratios, notes=missing_peers())


BENCHMARK = Benchmark("Delay of a sample by number of streams, sources and units.", run, PEERS)


def _sweeps(*, quick: bool) -> list[_Sweep]:
    step = 4 if quick else 1
    n_samples = 10 if quick else _N_SAMPLES
    sampled = "each 'sample every 100'"
    return [
        _Sweep(
            "streams",
            f"n streams from one source, {sampled}",
            "streams",
            _N_STREAMS[::step],
            _STREAMS,
            n_samples,
            "delay for one more stream",
            _BY_STREAMS,
        ),
        _Sweep(
            "sources",
            f"{_STREAMS_OF_SOURCES} streams from n sources that speak at once, {sampled}",
            "sources",
            _N_SOURCES[::step],
            {"DyKnow": lambda n: Workload(many_sources(n, _STREAMS_OF_SOURCES), n)},
            n_samples,
            "delay for one more source",
            _BY_SOURCES,
        ),
        _Sweep(
            "units",
            f"{_STREAMS_OF_UNITS} streams, of which n feed units that copy, {sampled}",
            "computational units",
            _N_UNITS[::step],
            {"DyKnow": lambda n: Workload(many_units(n, _STREAMS_OF_UNITS))},
            n_samples,
            "delay for one more computational unit",
        ),
        _Sweep(
            "many_streams",
            f"n streams from one source, {sampled}",
            "streams",
            (100, 200) if quick else _MANY_STREAMS,
            _STREAMS,
            n_samples // 10,
            "delay for one more stream, of many",
            logarithmic=True,
        ),
    ]


def _measured(
    sweep: _Sweep, repetitions: int, on_progress: OnProgress, within: tuple[float, float]
) -> tuple[Experiment, list[Figure]]:
    """Return an experiment, and what one more of what it varies costs."""
    begin, end = within
    curves, slopes = [], []
    for at, (name, make) in enumerate(sweep.workloads.items()):
        share = (end - begin) / len(sweep.workloads)
        part = (begin + at * share, begin + (at + 1) * share)
        trials = {n: _trial(make(n), sweep.n_samples) for n in sweep.numbers}
        found = measure(trials, repetitions, on_progress, part, sweep.x)
        curves.append(series(name, found, fitted=True))
        slopes.append(_slope(sweep, name, found))
    experiment = Experiment(
        name=sweep.name,
        what=f"{sweep.what}, {sweep.n_samples} samples",
        x=sweep.x,
        y="delay of the stream served last",
        unit="µs",
        series=curves,
        published=sweep.published,
        logarithmic=sweep.logarithmic,
    )
    return experiment, slopes


def _trial(workload: Workload, n_samples: int) -> Callable[[], float]:
    return lambda: workload.delay(n_samples) * _MICROSECONDS


def _slope(sweep: _Sweep, name: str, found: Mapping[int, Sequence[float]]) -> Figure:
    """Return the slope of a curve, fitted to each repetition by itself."""
    slopes = [
        line_through(
            [Point(x=n, y=Measurement.of([y])) for n, y in zip(found, values, strict=True)]
        ).slope
        for values in zip(*found.values(), strict=True)
    ]
    return Figure(
        name=f"{sweep.one_more}, {name}" if len(sweep.workloads) > 1 else sweep.one_more,
        unit="µs",
        value=Measurement.of(slopes),
        published=_SLOPES.get(sweep.name),
    )


def _memory(name: str, workload: Workload, n: int) -> Figure:
    """Return the bytes that each of *n* streams takes when it has been running."""
    network = workload.build([Steady(10)])
    with undisturbed():
        tracemalloc.start()
        for output in network.outputs:
            network.subscribe(output, ignore)
        network.kernel.run()
        size, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    value = Measurement.of([size / n])
    return Figure(name=f"memory of one more stream, {name}", unit="bytes", value=value)


def _fan_out(peer: Peer, n_samples: int, rounds: int, *, shared: bool) -> Ratio:
    workload = _STREAMS[_SHARED if shared else _OWN](_N_FOR_PEERS)
    filters = "one sampling filter for all" if shared else "a sampling filter for each"
    return ratio_to(
        peer,
        f"hand a sample to {_N_FOR_PEERS} receivers through {filters}",
        lambda: workload.delay(n_samples),
        lambda: _delay_of_peer(peer, n_samples, shared=shared),
        rounds,
    )


def _delay_of_peer(peer: Peer, n_samples: int, *, shared: bool) -> float:
    emit = (peer.fan_out_shared if shared else peer.fan_out)(_N_FOR_PEERS, ignore)
    with undisturbed():
        began = time.perf_counter()
        for number in range(n_samples):
            now = TimePoint(number * PERIOD)
            emit(Sample(0, now, now))
        return (time.perf_counter() - began) / n_samples

"""Chronicle recognition: events per second, memory, latency, and whether everything is found.

The work is the overtake pattern among so many pairs of cars (`chronicles_events`), with its
`noevent` and, as a pathological chronicle that keeps every choice of events, without. What is
recognised is compared with what loops over each pair find. Times are those of the processor, but
latency, which is that of the clock: how long the call takes that recognises something, and at
most by the processor, which knows no other programs. The example of partial instances is that of
Heintz (2009), section 8.4.
"""

import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice
from statistics import mean

import numpy as np
import psutil

from chronicles import Recogniser, Recognition, models_from_chronicles, parse_chronicles
from chronicles.events import Event
from dyknow.time import MILLISECOND, TimePoint
from traffic.benchmarks.chronicles_events import (
    OVERTAKE,
    OVERTAKE_WITH_REPEATS,
    Instants,
    changes,
    endless_changes,
    overtakes,
    together,
)
from traffic.benchmarks.chronicles_peers import (
    PEERS,
    ChroniclePeer,
    installed_peers,
    missing_peers,
)
from traffic.benchmarks.measuring import (
    Benchmark,
    OnProgress,
    Plan,
    measure,
    series,
    undisturbed,
)
from traffic.benchmarks.results import (
    Experiment,
    Figure,
    Findings,
    Measurement,
    Point,
    Published,
    Ratio,
    Series,
)

__all__ = ["BENCHMARK"]

_MEGABYTE, _MILLION, _THOUSAND, _MICROSECONDS = 1e6, 1e6, 1e3, 1e6
_OURS = "DyKnow"


@dataclass(frozen=True, slots=True)
class _Sizes:
    """How much is measured.

    Attributes:
        n_pairs: Numbers of pairs of cars.
        n_events: How many changes there are.
        n_pathological: How many of them the chronicle without its `noevent` gets.
        n_long: How many changes there are while memory is watched.
        rounds: How often everything is measured.
        pairs_of_peers: For which numbers of pairs the other engines do the same.
        rounds_of_peers: How often they do.
    """

    n_pairs: Sequence[int]
    n_events: int
    n_pathological: int
    n_long: int
    rounds: int
    pairs_of_peers: Sequence[int]
    rounds_of_peers: int


_FULL = _Sizes((10, 100, 1_000), 100_000, 50_000, 10_000_000, 5, (10, 100, 1_000), 5)
_QUICK = _Sizes((10, 100), 1_000, 1_000, 20_000, 2, (100,), 1)
_N_READINGS = 100
_WARM = 10
_SLOW_BELOW = 100
"""Pairs below which an engine that keeps every choice of events takes too long."""

_EXAMPLE = "chronicle example { event(A, a) event(B, b) event(C, c) c - b in [0, 5] }"
_STEPS = (("A", 4), ("B", 5), ("B", 8), (None, 11), ("C", 12))
_PUBLISHED = ((4, 1), (5, 3), (8, 5), (11, 3), (12, 6))


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Measure ours, and the other engines with the same changes."""
    sizes = _QUICK if plan.quick else _FULL
    bench = _Bench(sizes)
    throughput = bench.throughput(on_progress)
    on_progress(0.3, "latency")
    latency, figures_of_latency = bench.latency()
    on_progress(0.4, "the pathological chronicle")
    figures = [*bench.figures(), *figures_of_latency, *bench.pathological()]
    on_progress(0.5, "memory")
    memory, growth = _memory(sizes, on_progress)
    peers = installed_peers()
    ratios, curves = bench.peers(peers, on_progress)
    on_progress(1.0, "")
    return Findings(
        experiments=[
            throughput.model_copy(update={"series": [*throughput.series, *curves]}),
            latency,
            memory,
            _partial_instances(),
        ],
        figures=[*figures, *growth],
        ratios=ratios,
        notes=[*bench.notes(), *missing_peers()],
    )


BENCHMARK = Benchmark("Recognition of chronicles: speed, latency, memory.", run, PEERS)


class _Bench:
    """The measurements of the overtake pattern."""

    def __init__(self, sizes: _Sizes) -> None:
        self._sizes = sizes
        self._events = {n: changes(n, sizes.n_events) for n in sizes.n_pairs}
        self._truth = {n: overtakes(events) for n, events in self._events.items()}
        self._seconds: dict[int, list[float]] = {}

    def throughput(self, on_progress: OnProgress) -> Experiment:
        """Measure events per second of processor time."""
        trials = {n: lambda n=n: _seconds(OVERTAKE, self._events[n]) for n in self._events}
        self._seconds = measure(trials, self._sizes.rounds, on_progress, (0, 0.3), "pairs")
        rates = {n: self._rates(seconds) for n, seconds in self._seconds.items()}
        return Experiment(
            name="chronicle-throughput",
            what="the overtake pattern of so many pairs of cars",
            x="pairs of cars",
            y="events per second of processor time",
            unit="thousands",
            series=[series(_OURS, rates)],
            logarithmic=True,
        )

    def latency(self) -> tuple[Experiment, list[Figure]]:
        """Measure how long the calls take that recognise something."""
        found = {n: _latencies(events, time.perf_counter) for n, events in self._events.items()}
        curves = {
            "median": {n: [float(np.median(each))] for n, each in found.items()},
            "99 %": {n: [float(np.percentile(each, 99))] for n, each in found.items()},
        }
        experiment = Experiment(
            name="chronicle-latency",
            what="from the last event of an overtake until it is reported",
            x="pairs of cars",
            y="time of the call that recognises",
            unit="µs",
            series=[series(name, curve) for name, curve in curves.items()],
            logarithmic=True,
        )
        n = max(found)
        named = {
            "mean": mean(found[n]),
            "longest": max(found[n]),
            "longest by the processor": max(_latencies(self._events[n], time.thread_time)),
        }
        figures = [
            Figure(
                name=f"time of a call that recognises, {n} pairs, {name}",
                unit="µs",
                value=Measurement.of([value]),
            )
            for name, value in named.items()
        ]
        return experiment, figures

    def figures(self) -> list[Figure]:
        """Return how much the recogniser keeps at most."""
        return [
            Figure(
                name=f"memory of the recogniser at its peak, {n} pairs",
                unit="MB",
                value=Measurement.of([_peak(OVERTAKE, events) / _MEGABYTE]),
            )
            for n, events in self._events.items()
        ]

    def pathological(self) -> list[Figure]:
        """Measure the chronicle without its `noevent`, which has very many matches."""
        n = sorted(self._events)[1]
        events = self._events[n][: self._sizes.n_pathological]
        seconds = [_seconds(OVERTAKE_WITH_REPEATS, events) for _ in range(2)]
        found = _recognised(OVERTAKE_WITH_REPEATS, events)
        figures: dict[str, tuple[str, list[float]]] = {
            "events per second": ("thousands", [len(events) / s / _THOUSAND for s in seconds]),
            "matches per second": ("thousands", [len(found) / s / _THOUSAND for s in seconds]),
            "matches": ("", [len(found)]),
            "matches missed or invented": (
                "",
                [len(_instants(found) ^ overtakes(events, repeats=True))],
            ),
            "memory of the recogniser at its peak": (
                "MB",
                [_peak(OVERTAKE_WITH_REPEATS, events) / _MEGABYTE],
            ),
        }
        return [
            Figure(
                name=f"without noevent, {n} pairs, {len(events)} events: {name}",
                unit=unit,
                value=Measurement.of(values),
            )
            for name, (unit, values) in figures.items()
        ]

    def notes(self) -> list[str]:
        """Return for each number of pairs whether all was found, and nothing else."""
        notes = []
        for n, truth in self._truth.items():
            found = _instants(_recognised(OVERTAKE, self._events[n]))
            missed, invented = len(truth - found), len(found - truth)
            notes.append(
                f"{n} pairs: {len(truth)} overtakes, {missed} missed, {invented} invented."
            )
        return notes

    def peers(
        self, peers: Sequence[ChroniclePeer], on_progress: OnProgress
    ) -> tuple[list[Ratio], list[Series]]:
        """Let the other engines do the same; return how long they take, and their curves."""
        ratios, curves = [], []
        for at, peer in enumerate(peers):
            rates = {}
            for n in self._sizes.pairs_of_peers:
                on_progress(0.8 + 0.2 * at / len(peers), f"{peer.name}, {n} pairs")
                if peer.keeps_every_choice and n < _SLOW_BELOW:
                    continue
                found = peer.recognise(self._events[n], self._sizes.rounds_of_peers)
                rates[n] = self._rates(found.seconds)
                ratios.append(self._ratio(peer, n, found.overtakes, found.seconds))
            if len(rates) == len(self._events):
                curves.append(series(peer.name, rates))
        return ratios, curves

    def _rates(self, seconds: Sequence[float]) -> list[float]:
        return [self._sizes.n_events / each / _THOUSAND for each in seconds]

    def _ratio(
        self, peer: ChroniclePeer, n: int, found: set[Instants], seconds: Sequence[float]
    ) -> Ratio:
        truth = self._truth[n]
        invented = len(found - truth)
        also = f" and {invented} that are none" if invented else ""
        ours = float(np.median(self._seconds[n]))
        return Ratio(
            peer=peer.name,
            version=peer.version,
            what=f"overtakes of {n} pairs; it finds {len(found & truth)} of {len(truth)}{also}",
            times_as_long=Measurement.of([each / ours for each in seconds]),
        )


def _recogniser(text: str) -> Recogniser:
    return Recogniser(models_from_chronicles(parse_chronicles(text)))


def _recognised(text: str, events: Sequence[Event]) -> list[Recognition]:
    push = _recogniser(text).push
    return [one for now, group in together(events) for one in push(now, group)]


def _instants(found: Sequence[Recognition]) -> set[Instants]:
    return {
        Instants(
            "+".join(one.arguments.values()),
            *(one.instants[name] // MILLISECOND for name in ("t1", "t2", "t3")),
        )
        for one in found
    }


def _seconds(text: str, events: Sequence[Event]) -> float:
    """Return how much processor time it takes to recognise *text* in *events*."""
    given = list(together(events))
    push = _recogniser(text).push
    with undisturbed():
        began = time.process_time()
        for now, group in given:
            push(now, group)
        return time.process_time() - began


def _latencies(events: Sequence[Event], clock: Callable[[], float]) -> list[float]:
    """Return the microseconds on *clock* of each call that recognises something."""
    given = list(together(events))
    push = _recogniser(OVERTAKE).push
    found = []
    with undisturbed():
        for now, group in given:
            began = clock()
            recognised = push(now, group)
            elapsed = clock() - began
            if recognised:
                found.append(elapsed * _MICROSECONDS)
    return found


def _peak(text: str, events: Sequence[Event]) -> int:
    """Return how many bytes the recogniser takes at most, without events and recognitions."""
    given = list(together(events))
    push = _recogniser(text).push
    tracemalloc.start()
    for now, group in given:
        push(now, group)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak


def _memory(sizes: _Sizes, on_progress: OnProgress) -> tuple[Experiment, list[Figure]]:
    """Read the memory of this program over very many events."""
    process = psutil.Process()
    push = _recogniser(OVERTAKE).push
    events = endless_changes(sizes.n_pairs[1])
    step = sizes.n_long // _N_READINGS
    readings = []
    n_found = 0
    for done in range(1, _N_READINGS + 1):
        n_found += sum(len(push(now, group)) for now, group in together(islice(events, step)))
        readings.append((done * step / _MILLION, process.memory_info().rss / _MEGABYTE))
        on_progress(0.5 + 0.3 * done / _N_READINGS, f"{readings[-1][0]:.1f} million events")
    warm = np.array(readings[_N_READINGS // _WARM :])
    growth = float(np.polyfit(warm[:, 0], warm[:, 1], 1)[0])
    experiment = Experiment(
        name="chronicle-memory",
        what=f"resident memory of the whole program, {sizes.n_pairs[1]} pairs",
        x="millions of events",
        y="resident memory",
        unit="MB",
        series=[
            Series(
                name=_OURS, points=[Point(x=x, y=Measurement.of([size])) for x, size in readings]
            )
        ],
    )
    figures = {
        "growth": ("MB per million events", growth),
        "memory when warm": ("MB", warm[0, 1]),
        "memory at the end": ("MB", warm[-1, 1]),
        "overtakes meanwhile": ("", n_found),
    }
    return experiment, [
        Figure(name=name, unit=unit, value=Measurement.of([float(value)]))
        for name, (unit, value) in figures.items()
    ]


def _partial_instances() -> Experiment:
    """Count the partial instances of the thesis' example, step by step."""
    recogniser = _recogniser(_EXAMPLE)
    points = []
    for name, at in _STEPS:
        now = TimePoint(at * MILLISECOND)
        recogniser.push(now, [Event(name, (), None, None, now)] if name else [])
        n = len(recogniser.partial_instances())
        points.append(Point(x=at, y=Measurement.of([n])))
    return Experiment(
        name="chronicle-partial-instances",
        what="A at 4, B at 5, B at 8, the clock at 11, C at 12; C is at most 5 after B",
        x="time",
        y="partial instances",
        unit="number",
        series=[Series(name=_OURS, points=points)],
        published=Published(
            source="Heintz (2009), section 8.4",
            unit="number",
            points=[(float(at), float(n)) for at, n in _PUBLISHED],
            remark="from the text, without the empty instance and the complete one",
        ),
    )

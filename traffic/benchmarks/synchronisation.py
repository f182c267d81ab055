"""Synchronisation: what it costs to make states of many streams.

The streams have samples at the same valid times; a state is made for each of those. What is told
is the time from when the first source offers its sample until the state is there, sources and
policies included, divided by the number of streams. Heintz (2013), *Semantically grounded stream
reasoning integrated with ROS*, section VIII, has 50 to 100 µs for each stream.
"""

import time
from collections.abc import Callable

from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from traffic.benchmarks.measuring import (
    Benchmark,
    OnProgress,
    Plan,
    measure,
    series,
    undisturbed,
)
from traffic.benchmarks.peers import PEERS, Peer, installed_peers, missing_peers, ratio_to
from traffic.benchmarks.results import Experiment, Findings, Published, Ratio
from traffic.benchmarks.workloads import PERIOD, Workload, ignore

__all__ = ["BENCHMARK"]

_MICROSECONDS = 1e6
_N_STREAMS = (2, 5, 10, 20, 30, 40, 50)
_N_FOR_PEERS = 20
_BY_STREAMS = Published(
    source="Heintz (2013), section VIII",
    unit="µs",
    points=[(n, 75.0) for n in _N_STREAMS],
    remark="the middle of 50 to 100 µs for each stream; ROS, on a Core i7 with 8 cores",
)


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Measure the synchronisation of more and more streams."""
    n_samples, repetitions = (10, 2) if plan.quick else (600, 10)
    numbers = _N_STREAMS[:3] if plan.quick else _N_STREAMS
    trials = {n: _trial(Workload(_states(n), n), n, n_samples) for n in numbers}
    found = measure(trials, repetitions, on_progress, (0.0, 0.9), "streams")
    experiment = Experiment(
        name="synchronisation",
        what=f"states of n streams that are all 'sample every 100', {n_samples} states",
        x="streams",
        y="time for one stream and state",
        unit="µs",
        series=[series("DyKnow", found)],
        published=_BY_STREAMS,
    )
    ratios = [_join(peer, n_samples, repetitions) for peer in installed_peers()]
    return Findings(experiments=[experiment], ratios=ratios, notes=missing_peers())


BENCHMARK = Benchmark("Time of a synchronised state, by number of streams.", run, PEERS)


def _states(n: int) -> str:
    """Return a network in which *n* sources make one stream of states."""
    sources = [f"source int src{i}\nstrmgen gen{i} = src{i}" for i in range(1, n + 1)]
    inputs = ", ".join(f"gen{i} with sample every 100" for i in range(1, n + 1))
    return "\n".join([*sources, f"stream states = sync({inputs})"]) + "\n"


def _trial(workload: Workload, n: int, n_samples: int) -> Callable[[], float]:
    return lambda: workload.delay(n_samples) / n * _MICROSECONDS


def _join(peer: Peer, n_samples: int, rounds: int) -> Ratio:
    n = _N_FOR_PEERS
    workload = Workload(_states(n), n)
    return ratio_to(
        peer,
        f"make a state of {n} streams ('zip', which pairs by position)",
        lambda: workload.delay(n_samples),
        lambda: _delay_of_peer(peer, n, n_samples),
        rounds,
    )


def _delay_of_peer(peer: Peer, n: int, n_samples: int) -> float:
    emitters = peer.join(n, ignore)
    with undisturbed():
        began = time.perf_counter()
        for number in range(n_samples):
            now = TimePoint(number * PERIOD)
            for emit in emitters:
                emit(Sample(0, now, now))
        return (time.perf_counter() - began) / n_samples

"""Synchronisation: what it costs to make states of many streams.

The streams have samples at the same valid times; a state is made for each of those. What is told
is the time from when the first source offers its sample until the state is there, sources and
policies included, divided by the number of streams; and the same of the unit alone, which gets
the samples of a state together or one by one. Heintz (2013), *Semantically grounded stream
reasoning integrated with ROS*, section VIII, has 50 to 100 µs for each stream.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from dyknow.streams.policy import Policy, SampleEvery
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.streams.synchronisation import Synchronisation
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
_N_STREAMS = (2, 5, 10, 20, 50, 100)
_N_FOR_PEERS = 20
_BY_STREAMS = Published(
    source="Heintz (2013), section VIII",
    unit="µs",
    points=[(n, 75.0) for n in _N_STREAMS],
    remark="the middle of 50 to 100 µs for each stream; ROS, on a Core i7 with 8 cores",
)


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Measure the synchronisation of more and more streams, in a network and by itself."""
    n_samples, repetitions = (10, 2) if plan.quick else (600, 10)
    numbers = _N_STREAMS[:3] if plan.quick else _N_STREAMS
    curves = []
    for at, (name, trial) in enumerate(_TRIALS.items()):
        within = (0.3 * at, 0.3 * (at + 1))
        trials = {n: trial(n, n_samples) for n in numbers}
        curves.append(series(name, measure(trials, repetitions, on_progress, within, "streams")))
    experiment = Experiment(
        name="synchronisation",
        what=f"states of n streams that are all 'sample every 100', {n_samples} states",
        x="streams",
        y="time for one stream and state",
        unit="µs",
        series=curves,
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


def _in_a_network(n: int, n_samples: int) -> Callable[[], float]:
    workload = Workload(_states(n), n)
    return lambda: workload.delay(n_samples) / n * _MICROSECONDS


def _together(n: int, n_samples: int) -> Callable[[], float]:
    return lambda: _alone(n, [_joined(n, number) for number in range(n_samples)]) * _MICROSECONDS


def _one_by_one(n: int, n_samples: int) -> Callable[[], float]:
    return lambda: _alone(n, _single(n, n_samples)) * _MICROSECONDS


_TRIALS: Mapping[str, Callable[[int, int], Callable[[], float]]] = {
    "in a network": _in_a_network,
    "alone, samples together": _together,
    "alone, one by one": _one_by_one,
}
"""In a network, the time of sources, policies and delivery is counted as well."""

Inputs = tuple[TimePoint, tuple[Sample[Any], ...]]
"""What a unit is given at one instant."""


def _alone(n: int, given: Sequence[Inputs]) -> float:
    """Return the seconds for one stream and state when only the unit works."""
    unit = Synchronisation(
        [f"gen{number}" for number in range(n)], inputs=[Policy(change=SampleEvery(PERIOD))] * n
    )
    states = 0
    with undisturbed():
        began = time.perf_counter()
        for now, inputs in given:
            states += len(unit.push(now, inputs))
        elapsed = time.perf_counter() - began
    return elapsed / n / states


def _joined(n: int, number: int) -> Inputs:
    now = TimePoint(number * PERIOD)
    return now, tuple(Sample(0, now, now) for _ in range(n))


def _single(n: int, n_samples: int) -> list[Inputs]:
    """Return samples of the same valid times that become available one after another."""
    last: list[Sample[Any]] = [NO_SAMPLE] * n
    given: list[Inputs] = []
    for number in range(n_samples):
        valid_time = TimePoint(number * PERIOD)
        for at in range(n):
            now = TimePoint(valid_time + at)
            last[at] = Sample(0, valid_time, now)
            given.append((now, tuple(last)))
    return given


def _join(peer: Peer, n_samples: int, rounds: int) -> Ratio:
    n = _N_FOR_PEERS
    given = _single(n, n_samples)
    return ratio_to(
        peer,
        f"make a state of {n} samples that come one by one ('zip', which pairs by position)",
        lambda: _alone(n, given) * n,
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

"""Memory over a long time: a network that runs for hours keeps no more than one that runs briefly.

A synthetic source gives 100 samples a second, of which every thousandth is missing and every
777th comes late, so that policies have something to complain about. Its samples go through
policies of every kind, caches, a computational unit, and a synchronised state.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import psutil

from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, Network, build_network
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.time import MILLISECOND, MINUTE, Duration, TimePoint, seconds
from traffic.benchmarks.measuring import Benchmark, OnProgress, Plan
from traffic.benchmarks.results import Experiment, Figure, Findings, Measurement, Point, Series
from traffic.benchmarks.workloads import ignore

__all__ = ["BENCHMARK"]

_HOUR = Duration(60 * MINUTE)
_USUAL = Duration(8 * _HOUR)
_QUICK = seconds(20)
_PERIOD = 10 * MILLISECOND
_MISSING = 1_000
_LATE = 777
_LATENESS = 300 * MILLISECOND
_MEGABYTE = 1e6
_N_READINGS = 480
_WARM = 8

_NETWORK = """
source number src
compunit number Smooth(number)
compunit number Sum(state(number, number))
strmgen raw = src
strmgen smooth = Smooth(
    raw with sample every 10, use most recent, max delay 100, from 0 to oo)
strmgen total = Sum(
    sync(smooth with sample every 100, raw with sample every 100, max delay 200))
stream raw = raw
stream ordered = raw with max delay 100, strict order
stream changes = smooth with any change, monotone order
stream totals = total with sample every 1 s, use most recent, max delay 1 s, from 0 to oo
"""


def run(plan: Plan, on_progress: OnProgress) -> Findings:
    """Run the network for a long simulated time and read the memory of this program meanwhile."""
    duration = plan.duration or (_QUICK if plan.quick else _USUAL)
    network = _network()
    watch = _Watch(duration, on_progress)
    network.kernel.run(TimePoint(duration), watch.look)
    begin = watch.readings[len(watch.readings) // _WARM]
    growth = watch.growth_per_hour()
    samples = sum(account.samples for account in network.kernel.accounts.values())
    violations = sum(account.violations for account in network.kernel.accounts.values())
    return Findings(
        experiments=[watch.experiment()],
        figures=[
            Figure(name="growth", unit="MB per simulated hour", value=Measurement.of([growth])),
            Figure(name="memory when warm", unit="MB", value=Measurement.of([begin[1]])),
            Figure(
                name="memory at the end", unit="MB", value=Measurement.of([watch.readings[-1][1]])
            ),
            Figure(name="samples produced", unit="", value=Measurement.of([samples])),
            Figure(name="violations published", unit="", value=Measurement.of([violations])),
        ],
    )


BENCHMARK = Benchmark("Memory over hours of simulated time.", run, has_duration=True)


class _Signal:
    """A source of 100 samples a second, some of which are missing or late."""

    def samples(self) -> Iterator[Sample[float]]:
        """Yield samples without end, in order of available time."""
        late: Sample[float] | None = None
        number = 0
        while True:
            now = TimePoint(number * _PERIOD)
            if late is not None and late.available_time <= now:
                yield late
                late = None
            if number % _LATE == _LATE - 1:
                late = Sample(float(number % 100), now, TimePoint(now + _LATENESS))
            elif number % _MISSING != _MISSING - 1:
                yield Sample(float(number % 100), now, now)
            number += 1


class _Smooth(Reactive):
    """Emits a mean in which every sample counts a tenth."""

    def __init__(self) -> None:
        self._mean = 0.0

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[float]]:
        """Emit the mean, with the valid time of the input."""
        self._mean += 0.1 * (inputs[0].value - self._mean)
        return [Sample(self._mean, inputs[0].valid_time, now)]


class _Sum(Reactive):
    """Emits the sum of the values of a state."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[float]]:
        """Emit the sum, with the valid time of the state."""
        return [Sample(sum(inputs[0].value), inputs[0].valid_time, now)]


class _Watch:
    """Reads the memory of this program now and then."""

    def __init__(self, duration: Duration, on_progress: OnProgress) -> None:
        self.readings: list[tuple[float, float]] = []
        self._duration = duration
        self._on_progress = on_progress
        self._step = duration // _N_READINGS
        self._next = 0
        self._process = psutil.Process()

    def look(self, now: TimePoint) -> None:
        """Note the memory, if it is time to."""
        if now < self._next:
            return
        self._next += self._step
        self.readings.append((now / _HOUR, self._process.memory_info().rss / _MEGABYTE))
        done = f"{now / _HOUR:.1f} of {self._duration / _HOUR:.1f} hours"
        self._on_progress(now / self._duration, done)

    def growth_per_hour(self) -> float:
        """Return the slope of the memory after the first eighth of the time."""
        warm = np.array(self.readings[len(self.readings) // _WARM :])
        return float(np.polyfit(warm[:, 0], warm[:, 1], 1)[0])

    def experiment(self) -> Experiment:
        """Return the memory over time."""
        return Experiment(
            name="memory",
            what="resident memory of the whole program, 100 samples per simulated second",
            x="simulated hours",
            y="resident memory",
            unit="MB",
            series=[Series(name="DyKnow", points=_points(self.readings))],
        )


def _points(readings: Sequence[tuple[float, float]]) -> list[Point]:
    return [Point(x=hours, y=Measurement.of([size])) for hours, size in readings]


def _network() -> Network:
    implementations = Implementations(
        sources={"src": _Signal}, units={"Smooth": _Smooth, "Sum": _Sum}
    )
    network = build_network(parse_specification(_NETWORK), implementations)
    for output in network.outputs:
        network.subscribe(output, ignore)
    return network

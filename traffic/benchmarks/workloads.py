"""The networks of the benchmarks, and how long they take for a sample.

The three networks of Heintz (2009), section 5.5, are written in KPL as they are there. The delay
of a sample is taken on the clock of the machine, from the moment in which the first source
offers the samples of an instant until the stream that is served last has its own; the order of
delivery is defined, so that this is always the same stream.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import Implementations, Network, build_network
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.time import MILLISECOND, Duration, TimePoint
from traffic.benchmarks.measuring import undisturbed

__all__ = [
    "PERIOD",
    "Copy",
    "Steady",
    "Workload",
    "ignore",
    "many_deadlines",
    "many_policies",
    "many_sources",
    "many_streams",
    "many_units",
]

PERIOD = Duration(100 * MILLISECOND)


class Steady:
    """A source of one value, a sample each period, that notes when it offers the last one."""

    def __init__(self, n_samples: int, value: object = 0) -> None:
        self.offered = 0.0
        self._n_samples = n_samples
        self._value = value

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield the samples, available at once."""
        for number in range(self._n_samples):
            now = TimePoint(number * PERIOD)
            self.offered = time.perf_counter()
            yield Sample(self._value, now, now)


class Copy(Reactive):
    """A computational unit that emits a copy of each sample of its input."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Emit the input, with its valid time."""
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]


def many_streams(n: int) -> str:
    """Return the network of figure 5.6: *n* streams from one source."""
    return _each(n, lambda _: "sample every 100")


def many_policies(n: int) -> str:
    """Return the network of figure 5.6 with a different policy for each stream."""
    return _each(n, lambda i: f"sample every 100, to {1_000_000 + i}")


def many_deadlines(n: int) -> str:
    """Return the network of figure 5.6 with a different delay for each stream."""
    return _each(n, lambda i: f"sample every 100, max delay {1_000 + i}")


def many_sources(n: int, m: int) -> str:
    """Return the network of figure 5.8: *m* streams from *n* sources."""
    sources = [f"source int src{i}\nstrmgen gen{i} = src{i}" for i in range(1, n + 1)]
    return "\n".join([*sources, *_streams(m, n)]) + "\n"


def many_units(n: int, m: int) -> str:
    """Return the network of figure 5.10: *m* streams, of which *n* feed computational units."""
    head = ["source int src1", "compunit int CU(int)", "strmgen gen = src1"]
    units = [f"strmgen gen{i} = CU(gen with sample every 100)" for i in range(1, n + 1)]
    return "\n".join([*head, *units, *_streams(m - n, n)]) + "\n"


class Workload:
    """A network that can be run again and again, each time with new processes.

    Args:
        text: The network in KPL, with the sources `src1`, `src2`, … and the unit `CU`.
        n_sources: How many sources it has.
    """

    def __init__(self, text: str, n_sources: int = 1) -> None:
        self._specification = parse_specification(text)
        self._n_sources = n_sources
        self._last = self._served_last()

    def build(self, sources: Sequence[Steady]) -> Network:
        """Return the network with *sources* for `src1`, `src2` and so on."""
        named = {f"src{at}": _always(source) for at, source in enumerate(sources, start=1)}
        implementations = Implementations(sources=named, units={"CU": Copy})
        return build_network(self._specification, implementations)

    def delay(self, n_samples: int, value: object = 0) -> float:
        """Return the mean delay of the stream that is served last, in seconds on the clock."""
        sources = [Steady(n_samples, value) for _ in range(self._n_sources)]
        network = self.build(sources)
        first = sources[0]
        delays: list[float] = []

        def note(_sample: Sample[Any]) -> None:
            delays.append(time.perf_counter() - first.offered)

        for output in network.outputs:
            network.subscribe(output, note if output == self._last else ignore)
        with undisturbed():
            network.kernel.run()
        return sum(delays) / len(delays)

    def _served_last(self) -> str:
        """Return the name of the stream that is served last, found out with a single sample."""
        network = self.build([Steady(1) for _ in range(self._n_sources)])
        served: list[str] = []
        for output in network.outputs:
            network.subscribe(output, _noting(output, served))
        network.kernel.run()
        return served[-1]


def ignore(_sample: Sample[Any]) -> None:
    """Take a sample, as a client does that has nothing to do with it."""


def _each(n: int, policy_of: Callable[[int], str]) -> str:
    """Return *n* streams from one source, under the policies that *policy_of* gives."""
    streams = [f"stream strm{i} = gen with {policy_of(i)}" for i in range(1, n + 1)]
    return "\n".join(["source int src1", "strmgen gen = src1", *streams]) + "\n"


def _streams(m: int, n: int) -> list[str]:
    """Return *m* streams that take turns with *n* generators."""
    return [f"stream strm{i + 1} = gen{i % n + 1} with sample every 100" for i in range(m)]


def _noting(output: str, served: list[str]) -> Callable[[Sample[Any]], None]:
    return lambda _sample: served.append(output)


def _always(source: Steady) -> Callable[[], Steady]:
    return lambda: source

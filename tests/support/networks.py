"""Networks of KPL texts, fed by given streams, for tests of what comes out of them."""

from collections.abc import Mapping
from typing import Any

from dyknow.kpl.implementations import Implementations
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.plan import build_network
from dyknow.streams.process import Reactive
from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.time import TimePoint
from tests.support.streams import GivenSource, ms, text

__all__ = ["Collector", "Distance", "Echo", "network_of", "samples_at"]


class Echo(Reactive):
    """Says what its first input says."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Repeat the new sample."""
        return [Sample(inputs[0].value, inputs[0].valid_time, now)]


class Distance(Reactive):
    """The difference between the values of two inputs, at each sample of the first."""

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Subtract the second from the first."""
        one, other = inputs
        if other is NO_SAMPLE or one.available_time != now:
            return []
        return [Sample(int(one.value) - int(other.value), one.valid_time, now)]


class Collector:
    """Collects the samples of all outputs, also of those that come while the network runs.

    Attributes:
        samples: By the name of the output.
        changes: What was changed, with the instant in milliseconds.
    """

    def __init__(self, network: Network) -> None:
        self.network = network
        self.samples: dict[str, list[Sample[Any]]] = {}
        self.changes: list[tuple[float, Any]] = []
        for name in network.outputs:
            self._subscribe(name)
        network.subscribe_changes(self._note)

    def run(self, until: TimePoint | None = None) -> dict[str, str]:
        """Run the network; return what has come out of it so far, as text."""
        self.network.kernel.run(until)
        return {name: text(samples) for name, samples in self.samples.items()}

    def _note(self, change: Any) -> None:
        self.changes.append((self.network.kernel.now / 1_000_000, change))
        for name in change.opened:
            self._subscribe(name)

    def _subscribe(self, name: str) -> None:
        self.network.subscribe(name, self.samples.setdefault(name, []).append)


def network_of(
    specification: str, sources: Mapping[str, str | list[Sample[Any]]], **options: Any
) -> Network:
    """Return a network whose sources say given streams; there are units `Echo` and `Distance`."""
    made = {name: _maker(given) for name, given in sources.items()}
    implementations = Implementations(made, {"Echo": Echo, "Distance": Distance})
    return build_network(parse_specification(specification), implementations, **options)


def samples_at(values: Mapping[float, Any]) -> list[Sample[Any]]:
    """Return a stream of values by their times in milliseconds, available at once."""
    return [Sample(value, ms(time), ms(time)) for time, value in values.items()]


def _maker(given: str | list[Sample[Any]]) -> Any:
    return lambda: GivenSource(given)

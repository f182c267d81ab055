"""From a network that can be made again and again to what a judge looks at.

Processes keep a state, so that each can be used once. Whoever judges has to be able to make the
whole network as often as it takes; chance begins anew each time.
"""

from collections.abc import Callable, Collection
from functools import partial
from types import MappingProxyType
from typing import Any, cast

from dyknow.judging.declared import DeclaredNetwork, DeclaredProcess, DeclaredStream
from dyknow.judging.sorts import Sorts, sort_test
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.syntax import Sort, SourceDeclaration
from dyknow.runtime.generators import Label
from dyknow.runtime.processes import Kind
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.streams.sample import Sample

__all__ = ["MakeNetwork", "declared_network"]

MakeNetwork = Callable[[], Network]
"""Makes the network of a specification, which has not run yet."""

NO_SORTS: Sorts = MappingProxyType({})
"""Nothing is known about any sort."""


def declared_network(
    make: MakeNetwork, sorts: Sorts = NO_SORTS, again: Collection[str] = ()
) -> DeclaredNetwork:
    """Return what is declared of a network.

    Args:
        make: Makes the network; its outputs are those that were asked for.
        sorts: What is wrong with values that are not of a sort, by the name of the sort.
        again: The symbols of sources that say the same whenever they are asked.
    """
    workshop = _Workshop(make)
    network = workshop.network
    described = {each["label"]: each for each in network.description["generators"]}
    processes = {}
    for label, running in network.kernel.processes.items():
        sort = described[label]["sort"]
        is_source = running.kind is Kind.SOURCE
        is_said_again = is_source and described[label]["process"] in again
        processes[label] = DeclaredProcess(
            label,
            _inputs(network, label),
            make_source=partial(workshop.source, label) if is_said_again else None,
            make_unit=None if is_source else partial(workshop.unit, label),
            sort=sort,
            sort_test=sort_test(_sort(sort), sorts),
            promise=running.output_policy,
        )
    outputs = tuple(_output(network, name) for name in network.outputs)
    return DeclaredNetwork(processes, outputs)


class _Workshop:
    """Makes sources and units, each a new one, together with the network that they belong to.

    Attributes:
        network: The network that was made last.
    """

    def __init__(self, make: MakeNetwork) -> None:
        self._make = make
        self._renew()

    def source(self, label: Label) -> Source:
        """Return a source that nobody has used."""
        return cast(Source, self._take(label))  # its kind has been looked at

    def unit(self, label: Label) -> ComputationalUnit:
        """Return a unit that nobody has used."""
        return cast(ComputationalUnit, self._take(label))  # its kind has been looked at

    def _take(self, label: Label) -> Source | ComputationalUnit:
        if label not in self._unused:
            self._renew()
        return self._unused.pop(label)

    def _renew(self) -> None:
        self.network = self._make()
        processes = self.network.kernel.processes
        self._unused = {label: running.process for label, running in processes.items()}


def _inputs(network: Network, label: Label) -> tuple[DeclaredStream, ...]:
    return tuple(
        DeclaredStream.input(label, proxy.number, proxy.provider, proxy.policy)
        for proxy in network.kernel.streams
        if proxy.receiver == label and proxy.number
    )


def _output(network: Network, name: str) -> DeclaredStream:
    proxy = network.subscribe(name, _ignore)
    proxy.end()
    return DeclaredStream.output(name, proxy.provider, proxy.policy)


def _ignore(_: Sample[Any]) -> None:
    """Take no sample: nothing flows."""


def _sort(text: str) -> Sort:
    """Return the sort that is written as *text*."""
    (declaration,) = parse_specification(f"source {text} samples").declarations
    assert isinstance(declaration, SourceDeclaration)
    return declaration.sort

"""From a network that can be made again and again to what a judge looks at.

Processes keep a state, so that each can be used once. Whoever judges has to be able to make the
whole network as often as it takes; chance begins anew each time.
"""

from collections.abc import Collection
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import Any, cast

from dyknow.judging.changing import Changing, MakeNetwork
from dyknow.judging.declared import DeclaredNetwork, DeclaredProcess, DeclaredStream
from dyknow.judging.sorts import Sorts, sort_test
from dyknow.kpl.names import descendants
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_specification
from dyknow.kpl.syntax import Configuration, Mediation, Sort, SourceDeclaration
from dyknow.runtime.generators import Label
from dyknow.runtime.processes import Kind
from dyknow.streams.process import ComputationalUnit, Source
from dyknow.streams.sample import Sample

__all__ = ["declared_network"]

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
        is_mediation = described[label]["kind"] == "mediation"
        can_be_used = not is_source and not is_mediation
        processes[label] = DeclaredProcess(
            label,
            _inputs(network, label),
            make_source=partial(workshop.source, label) if is_said_again else None,
            make_unit=partial(workshop.unit, label) if can_be_used else None,
            is_mediation=is_mediation,
            sort=sort,
            sort_test=sort_test(_sort(sort), sorts),
            promise=running.output_policy,
            on_failure=running.on_failure,
        )
    outputs = tuple(_output(network, name) for name in network.outputs)
    declared = DeclaredNetwork(processes, outputs)
    return replace(declared, changing=_changing(make, network, declared))


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


def _changing(make: MakeNetwork, network: Network, declared: DeclaredNetwork) -> Changing | None:
    """Return what changes by itself in a network, if anything does."""
    kinds = (Configuration, Mediation)
    if not any(isinstance(each, kinds) for each in descendants(network.specification)):
        return None
    promises = {label: process.promise for label, process in declared.processes.items()}
    return Changing(make, network.specification, promises, declared.static_topics)


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

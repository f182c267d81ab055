"""The part of a network that changes by itself: configuration blocks and mediations.

Which processes there are follows from streams of sets (Heintz 2009, definitions 3.3.4 and 3.3.5),
so that they cannot be looked at one by one beforehand. The whole part is run again, fed with
the recorded streams of the generators that are declared outside of it.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol

from dyknow.judging.recomputing import Recorded
from dyknow.judging.streams import KnownStreams
from dyknow.kpl.names import descendants
from dyknow.kpl.network import Network
from dyknow.kpl.parser import parse_policy
from dyknow.kpl.policies import text_from_policy
from dyknow.kpl.syntax import (
    ANY_SORT,
    Configuration,
    Declaration,
    GeneratorDeclaration,
    Label,
    Mediation,
    Name,
    Sort,
    SourceDeclaration,
    SourceInstance,
    Specification,
    StreamDeclaration,
    StreamTerm,
)
from dyknow.runtime import names
from dyknow.runtime.names import OUTPUT, input_name, output_name
from dyknow.runtime.subscriptions import StreamProxy, StreamViolation
from dyknow.streams.policy import Policy
from dyknow.streams.process import Element, Source

__all__ = ["Changing", "MakeNetwork"]

Sources = Mapping[str, Callable[[], Source]]
"""What makes the source of a symbol."""

Receive = Callable[[str, Element], None]
"""Takes the samples and heartbeats of streams, with their topics."""


class MakeNetwork(Protocol):
    """Makes the network of an execution again; nobody has run it yet, and chance begins anew."""

    def __call__(
        self,
        specification: Specification | None = None,
        sources: Sources | None = None,
        outputs: Collection[str] = (),
    ) -> Network:
        """Return a network.

        Args:
            specification: What is declared, if not the same as in the execution.
            sources: What else symbols of sources stand for.
            outputs: Output streams that are wanted besides those of the execution.
        """


@dataclass(frozen=True)
class Changing:
    """What changes by itself in a network.

    Attributes:
        make: Makes the network.
        specification: What is declared there.
        promises: The output policies of the generators outside of this part.
        static: The topics that do not belong to this part.
    """

    make: MakeNetwork
    specification: Specification
    promises: Mapping[names.Label, Policy]
    static: Collection[str]

    @property
    def sources_within(self) -> list[str]:
        """The labels of generators in blocks that are made of sources, as they are written."""
        blocks = [each for each in self.specification.declarations if _is_block(each)]
        return [
            each.label.text
            for each in descendants(tuple(blocks))
            if isinstance(each, GeneratorDeclaration) and isinstance(each.process, SourceInstance)
        ]

    def run(self, streams: KnownStreams, receive: Receive) -> list[StreamViolation]:
        """Hand to *receive* what the streams of this part should be; return its violations.

        Raises:
            ProcessError: A process fails on what was recorded.
        """
        violations: list[StreamViolation] = []
        specification, sources, added = self._fed(streams)
        network = self.make(specification, sources, added)
        network.kernel.subscribe_violations(violations.append)
        others = set(map(output_name, added))
        watch = _Watch(network, others.union(self.static), receive)
        watch.refresh()
        network.subscribe_changes(lambda _: watch.refresh())
        network.kernel.run(streams.until)
        return [each for each in violations if not self._is_static(each)]

    def _is_static(self, violation: StreamViolation) -> bool:
        if violation.receiver == OUTPUT:
            return False  # other outputs have no receivers here
        if violation.provider == violation.receiver:
            return violation.provider in self.static
        return input_name(violation.receiver, violation.number) in self.static

    def _fed(self, streams: KnownStreams) -> tuple[Specification, Sources, list[str]]:
        """Return the specification with recorded streams in place of what lies outside.

        What has a mediation in it is kept, and made an output, so that it is built.
        """
        declarations: list[Declaration] = []
        sources: dict[str, Callable[[], Source]] = {}
        outputs: list[str] = []
        for each in self.specification.declarations:
            if not isinstance(each, GeneratorDeclaration) or each.label.text not in self.promises:
                declarations.append(each)
                continue
            label = names.Label(each.label.text)
            if label in streams and not _is_mediated(each):
                symbol = Name(f"recorded {label}")
                declarations.append(SourceDeclaration(Sort(ANY_SORT), symbol))
                declarations.append(_sourced(each, symbol, self.promises[label]))
                sources[symbol.text] = partial(Recorded, streams, label)
            else:
                name = Label(Name(f"judged {label}"))
                declarations += [each, StreamDeclaration(name, StreamTerm(each.label))]
                outputs.append(name.text)
        return Specification(tuple(declarations)), sources, outputs


class _Watch:
    """Shows what flows in the changing part of a network, and in what comes while it runs."""

    def __init__(self, network: Network, others: Collection[str], receive: Receive) -> None:
        self._network = network
        self._others = others
        self._receive = receive
        self._known: dict[str, object] = {}

    def refresh(self) -> None:
        """Watch what is new."""
        kernel = self._network.kernel
        for label in kernel.labels:
            if self._is_new(label, generator := kernel.generator(label)):
                take = partial(self._receive, label)
                generator.connect(self, take, take)
        for proxy in kernel.streams:
            topic = input_name(proxy.receiver, proxy.number)
            if proxy.number and self._is_new(topic, proxy):
                take = partial(self._receive, topic)
                proxy.tap(take, take)
        for name in self._network.outputs:
            self._watch_output(name)

    def _watch_output(self, name: str) -> None:
        topic = output_name(name)
        known = self._known.get(topic)
        has_ended = isinstance(known, StreamProxy) and known.has_ended
        if topic not in self._others and (known is None or has_ended):
            self._known[topic] = self._network.subscribe(name, partial(self._receive, topic))

    def _is_new(self, topic: str, what: object) -> bool:
        if topic in self._others or self._known.get(topic) is what:
            return False
        self._known[topic] = what
        return True


def _is_block(declaration: Declaration) -> bool:
    return isinstance(declaration, Configuration)


def _is_mediated(declaration: GeneratorDeclaration) -> bool:
    return any(isinstance(each, Mediation) for each in descendants(declaration.process))


def _sourced(
    declaration: GeneratorDeclaration, symbol: Name, promise: Policy
) -> GeneratorDeclaration:
    """Return the declaration of a generator of the same promise that is made of a source."""
    constraints = parse_policy(text_from_policy(promise))
    return replace(declaration, process=SourceInstance(symbol), constraints=constraints)

"""Small networks that are run by the kernel and remembered as a whole, for judging."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from dyknow.judging.declared import DeclaredNetwork, DeclaredProcess, DeclaredStream
from dyknow.judging.execution import Interpretation
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Policy
from dyknow.streams.process import ComputationalUnit, Element
from dyknow.time import TimePoint
from tests.support.streams import GivenSource

__all__ = ["SmallNetwork"]

Term = tuple[str, Policy]


@dataclass
class SmallNetwork:
    """Sources with given samples, units, and outputs, in the order of their declaration.

    Attributes:
        sources: Label to samples and heartbeats.
        units: Label to what makes the unit, and its inputs.
        outputs: Name to the stream.
    """

    sources: Mapping[str, Sequence[Element]] = field(default_factory=dict)
    units: Mapping[str, tuple[Callable[[], ComputationalUnit], Sequence[Term]]] = field(
        default_factory=dict
    )
    outputs: Mapping[str, Term] = field(default_factory=dict)

    def declared(self) -> DeclaredNetwork:
        """Return what is declared; the sources cannot be asked again."""
        processes = {Label(label): DeclaredProcess(Label(label)) for label in self.sources}
        for name, (make, terms) in self.units.items():
            inputs = tuple(
                DeclaredStream.input(Label(name), number, Label(provider), policy)
                for number, (provider, policy) in enumerate(terms, start=1)
            )
            processes[Label(name)] = DeclaredProcess(Label(name), inputs, make_unit=make)
        outputs = tuple(
            DeclaredStream.output(name, Label(provider), policy)
            for name, (provider, policy) in self.outputs.items()
        )
        return DeclaredNetwork(processes, outputs)

    def run(self, until: TimePoint) -> Interpretation:
        """Run the network and return all its streams."""
        kernel, violations = Kernel(), list[StreamViolation]()
        streams: dict[str, list[Element]] = {}
        kernel.subscribe_violations(violations.append)
        for name, elements in self.sources.items():
            kernel.add_source(Label(name), GivenSource(elements))
        for name, (make, terms) in self.units.items():
            inputs = [(Label(provider), policy) for provider, policy in terms]
            kernel.add_unit(Label(name), make(), inputs)
        for label in kernel.labels:
            kept = streams.setdefault(label, []).append
            kernel.subscribe(label, kept, beat=kept)
        for proxy in kernel.streams:
            if proxy.number:
                kept = streams.setdefault(f"{proxy.receiver}/{proxy.number}", []).append
                proxy.tap(kept, kept)
        for name, (provider, policy) in self.outputs.items():
            kept = streams.setdefault(f"output/{name}", []).append
            kernel.subscribe(Label(provider), kept, policy, beat=kept)
        kernel.run(until)
        return Interpretation(kernel.now, streams, violations)

"""Small networks that are run by the kernel and remembered as a whole, for judging."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from dyknow.judging.declared import DeclaredNetwork, DeclaredProcess, DeclaredStream
from dyknow.judging.execution import Interpretation
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.streams.policy import Policy, Violation
from dyknow.streams.process import ComputationalUnit, Element
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from tests.support.streams import GivenSource

__all__ = ["SmallNetwork"]

Term = tuple[str, Policy]


@dataclass
class SmallNetwork:
    """Sources with given samples, units, and outputs, in the order of their declaration.

    Attributes:
        sources: Label to samples.
        units: Label to what makes the unit, and its inputs.
        outputs: Name to the stream.
    """

    sources: Mapping[str, Sequence[Sample[Any]]] = field(default_factory=dict)
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
        kernel, streams, violations = Kernel(), {}, []
        kernel.subscribe_violations(violations.append)
        for name, samples in self.sources.items():
            kernel.add_source(Label(name), GivenSource(list(samples)))
        for name, (make, terms) in self.units.items():
            received: list[list[Sample[Any]]] = [[] for _ in terms]
            inputs = [(Label(provider), policy) for provider, policy in terms]
            kernel.add_unit(Label(name), _Watched(make(), received), inputs)
            for number, samples in enumerate(received, start=1):
                streams[f"{name}/{number}"] = samples
        for label in (*self.sources, *self.units):
            streams[label] = []
            kernel.subscribe(Label(label), streams[label].append)
        for name, (provider, policy) in self.outputs.items():
            streams[f"output/{name}"] = []
            kernel.subscribe(Label(provider), streams[f"output/{name}"].append, policy)
        kernel.run(until)
        return Interpretation(kernel.now, streams, tuple(self.outputs), violations)


class _Watched:
    """A unit whose inputs are remembered."""

    def __init__(self, unit: ComputationalUnit, received: list[list[Sample[Any]]]) -> None:
        self._unit = unit
        self._received = received

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Element]:
        """Remember the new samples and let the unit have them."""
        for samples, sample in zip(self._received, inputs, strict=True):
            if sample.available_time == now:
                samples.append(sample)
        return self._unit.push(now, inputs)

    def advance(self, now: TimePoint) -> Iterable[Element]:
        """Let the unit know the time."""
        return self._unit.advance(now)

    def due(self) -> TimePoint | None:
        """Return when the unit is due."""
        return self._unit.due()

    def take_violations(self) -> list[Violation]:
        """Return what the unit has noticed."""
        take = getattr(self._unit, "take_violations", list)
        return take()

"""From a KPL specification to a network that runs."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

from dyknow.errors import SpecificationError, UnknownNameError
from dyknow.kpl.check import check, raise_faults
from dyknow.kpl.names import Declarations, streams_of
from dyknow.kpl.parser import parse_value
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.printer import text_from
from dyknow.kpl.settings import arguments_from, plain_value
from dyknow.kpl.syntax import (
    Label,
    Link,
    Name,
    Number,
    ParameterDeclaration,
    Process,
    SourceInstance,
    Specification,
    StreamTerm,
    Synchronisation,
    Truth,
    UnitInstance,
    Value,
)
from dyknow.mtl.syntax import Formula
from dyknow.runtime import generators
from dyknow.runtime.generators import Receive
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamProxy
from dyknow.source_text import MADE_IN_PYTHON, Span, nearest_name
from dyknow.streams import synchronisation
from dyknow.streams.policy import Policy
from dyknow.streams.process import ComputationalUnit, Source

__all__ = ["Implementations", "LinkFactory", "Network", "build_network"]

T = TypeVar("T")


class LinkFactory(Protocol):
    """Makes the process that a `link(...)` generator declares."""

    def __call__(
        self,
        unit: str,
        establish: Formula,
        reestablish: Formula,
        maintain: Formula,
        settings: Mapping[str, Any],
    ) -> ComputationalUnit:
        """Return a link process with one input, the objects to be linked.

        *unit* is the symbol of the computational unit that computes the upper objects;
        *settings* has what the declaration sets by name. Times with a unit are nanoseconds
        there, and numbers are as written. A ValueError is reported with the declaration's place.
        """


@dataclass(frozen=True)
class Implementations:
    """What the symbols of a specification stand for (Heintz 2009, definition 4.5.2).

    Attributes:
        sources: Source symbol to a function without arguments that makes the source.
        units: Computational unit symbol to a function that takes the settings as keyword
            arguments and makes the unit. Settings are checked against its signature. A setting
            annotated `Duration` may be written as a bare number of milliseconds. A ValueError
            is reported with the place of the symbol.
        link: Makes link processes, if the specification has any.
    """

    sources: Mapping[str, Callable[[], Source]] = field(default_factory=dict)
    units: Mapping[str, Callable[..., ComputationalUnit]] = field(default_factory=dict)
    link: LinkFactory | None = None


class Network:
    """A kernel with the processes of a specification, and the outputs it declares.

    Attributes:
        kernel: Runs the network: `kernel.run(until, on_time)`; keeps `kernel.accounts`.
        outputs: The names of the `stream` declarations that were built.
    """

    def __init__(
        self, kernel: Kernel, streams: Mapping[str, tuple[generators.Label, Policy]]
    ) -> None:
        self.kernel = kernel
        self._streams = dict(streams)

    @property
    def outputs(self) -> tuple[str, ...]:
        """The names of the output streams, in the order of their declarations."""
        return tuple(self._streams)

    def subscribe(self, output: str, receive: Receive) -> StreamProxy:
        """Hand the samples of an output stream to *receive*, under its declared policy.

        Raises:
            ValueError: There is no output of this name.
        """
        if output not in self._streams:
            raise ValueError(f"no output stream called '{output}'")
        label, policy = self._streams[output]
        return self.kernel.subscribe(label, receive, policy)


def build_network(
    specification: Specification,
    implementations: Implementations,
    parameters: Mapping[str, object] | None = None,
    outputs: Collection[str] | None = None,
) -> Network:
    """Return a network of what the wanted *outputs* need; of all outputs when None.

    *parameters* gives values to `parameter` declarations, in place of their defaults: numbers
    as KPL writes them (a bare one is milliseconds where a time is meant), True, False, or
    strings (`"truth"`, `"100 ms"`). A source is made once for each generator that is made of it.

    Raises:
        SpecificationErrors: Every fault of the specification, of the parameters, and of the
            settings and implementations of what is built.
    """
    values = {name: _value(given) for name, given in (parameters or {}).items()}
    raise_faults(_unknown_parameters(specification, values))
    bound = check(specification, values, implementations.units)
    declared = Declarations(bound)
    wanted = list(declared.streams) if outputs is None else list(outputs)
    raise_faults(
        [
            UnknownNameError("output stream", name, MADE_IN_PYTHON, _nearest(name, declared))
            for name in wanted
            if name not in declared.streams
        ]
    )
    builder = _Builder(declared, implementations)
    streams = {name: builder.stream(declared.streams[name].stream) for name in wanted}
    raise_faults(sorted(builder.faults, key=lambda fault: fault.span.start))
    return Network(builder.kernel, streams)


def _nearest(name: str, declared: Declarations) -> str | None:
    return nearest_name(name, declared.streams)


def _unknown_parameters(
    specification: Specification, values: Mapping[str, Value]
) -> list[SpecificationError]:
    declared = specification.declarations
    known = [each.name.text for each in declared if isinstance(each, ParameterDeclaration)]
    return [
        UnknownNameError("parameter", name, MADE_IN_PYTHON, nearest_name(name, known))
        for name in values
        if name not in known
    ]


def _value(given: object) -> Value:
    match given:
        case bool():
            return Truth(given)
        case int() | float():
            return Number(given)
        case str():
            return parse_value(given)
        case _:
            raise TypeError(f"a parameter is a number, a truth value or a string, not {given!r}")


class _Builder:
    """Adds to a kernel what is asked for, and what that needs, each thing once."""

    def __init__(self, declared: Declarations, implementations: Implementations) -> None:
        self.kernel = Kernel()
        self.faults: list[SpecificationError] = []
        self._declared = declared
        self._implementations = implementations
        self._built: set[str] = set()

    def stream(self, term: StreamTerm) -> tuple[generators.Label, Policy]:
        """Build what a stream term needs; return the label and the policy it stands for."""
        name = text_from(term.provider)
        if name not in self._built:
            self._built.add(name)
            self._build(generators.Label(name), self._process(term.provider))
        return generators.Label(name), policy_from_constraints(term.constraints)

    def _process(self, provider: Label | Synchronisation) -> Process:
        if isinstance(provider, Synchronisation):
            return provider
        return self._declared.generators[text_from(provider)].process

    def _build(self, label: generators.Label, process: Process) -> None:
        inputs = [self.stream(term) for term in streams_of(process)]
        if isinstance(process, SourceInstance):
            source = self._source(process.source)
            if source is not None:
                self.kernel.add_source(label, source)
            return
        unit = self._unit(process)
        if unit is not None and not self.faults:
            self.kernel.add_unit(label, unit, inputs)

    def _source(self, name: Name) -> Source | None:
        make = self._find("source", name, self._implementations.sources)
        return None if make is None else self._make(name.span, make)

    def _unit(self, process: UnitInstance | Link | Synchronisation) -> ComputationalUnit | None:
        match process:
            case UnitInstance(unit, _, settings):
                make = self._find("computational unit", unit, self._implementations.units)
                if make is None:
                    return None
                arguments = arguments_from(settings, make)
                return self._make(unit.span, lambda: make(**arguments))
            case Link():
                return self._link(process)
            case Synchronisation(streams):
                return synchronisation.Synchronisation([text_from(each) for each in streams])

    def _link(self, link: Link) -> ComputationalUnit | None:
        make = self._implementations.link
        if make is None:
            message = "nothing is there to make link processes"
            self.faults.append(SpecificationError(message, link.span))
            return None
        settings = {each.name: plain_value(each.value) for each in link.settings}
        conditions = link.establish, link.reestablish, link.maintain
        return self._make(link.unit.span, lambda: make(link.unit.text, *conditions, settings))

    def _find(self, kind: str, name: Name, known: Mapping[str, T]) -> T | None:
        if name.text not in known:
            nearest = nearest_name(name.text, known)
            what = f"implementation of a {kind}"
            self.faults.append(UnknownNameError(what, name.text, name.span, nearest))
        return known.get(name.text)

    def _make(self, span: Span, make: Callable[[], T]) -> T | None:
        try:
            return make()
        except ValueError as fault:
            self.faults.append(SpecificationError(str(fault), span))
            return None

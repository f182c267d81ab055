"""Putting the values of parameters in their places.

A parameter may stand for an object symbol, a time in a policy, or a value of a setting.
"""

from collections.abc import Mapping
from dataclasses import replace

from dyknow.errors import SortMismatchError, SpecificationError, UnknownNameError
from dyknow.kpl.syntax import (
    Constraint,
    Declaration,
    FromTo,
    GeneratorDeclaration,
    Label,
    Link,
    MaxDelay,
    Name,
    Number,
    ParameterDeclaration,
    Process,
    SampleEvery,
    Setting,
    Specification,
    StreamDeclaration,
    StreamTerm,
    Synchronisation,
    Text,
    Time,
    To,
    Truth,
    UnitInstance,
    Value,
    Values,
)
from dyknow.source_text import nearest_name
from dyknow.time import milliseconds

__all__ = ["bind_parameters", "kind_of"]


def bind_parameters(
    specification: Specification, values: Mapping[str, Value]
) -> tuple[Specification, list[SpecificationError]]:
    """Return the specification with every use of a parameter replaced by its value.

    *values* take the place of the declared defaults. Uses that are at fault stay as they are.
    """
    parameters = [d for d in specification.declarations if isinstance(d, ParameterDeclaration)]
    binder = _Binder({d.name.text: values.get(d.name.text, d.default) for d in parameters})
    declarations = tuple(binder.declaration(each) for each in specification.declarations)
    return replace(specification, declarations=declarations), binder.faults


def kind_of(value: Value) -> str:
    """Return what people call a value of this kind."""
    match value:
        case Number():
            return "number"
        case Time():
            return "time"
        case Text() | Name():
            return "name"
        case Truth():
            return "truth value"
        case Values():
            return "list"


class _Binder:
    """Replaces names of parameters, and collects the uses that are at fault."""

    def __init__(self, values: Mapping[str, Value]) -> None:
        self._values = values
        self.faults: list[SpecificationError] = []

    def declaration(self, node: Declaration) -> Declaration:
        match node:
            case GeneratorDeclaration(label, process):
                return replace(node, label=self._label(label), process=self._process(process))
            case StreamDeclaration(_, stream):
                return replace(node, stream=self._term(stream))
            case ParameterDeclaration(name):
                return replace(node, default=self._values[name.text])
            case _:
                return node

    def _process(self, node: Process) -> Process:
        match node:
            case UnitInstance(_, streams, settings):
                return replace(node, streams=self._terms(streams), settings=self._all(settings))
            case Link():
                settings = self._all(node.settings)
                return replace(node, stream=self._term(node.stream), settings=settings)
            case Synchronisation(streams):
                return replace(node, streams=self._terms(streams))
            case _:
                return node

    def _terms(self, nodes: tuple[StreamTerm, ...]) -> tuple[StreamTerm, ...]:
        return tuple(self._term(node) for node in nodes)

    def _term(self, node: StreamTerm) -> StreamTerm:
        constraints = tuple(self._constraint(each) for each in node.constraints)
        if isinstance(node.provider, Label):
            return replace(node, provider=self._label(node.provider), constraints=constraints)
        streams = self._terms(node.provider.streams)
        provider = replace(node.provider, streams=streams)
        return replace(node, provider=provider, constraints=constraints)

    def _label(self, node: Label) -> Label:
        return replace(node, objects=tuple(self._object(each) for each in node.objects))

    def _object(self, node: Name) -> Name:
        match self._values.get(node.text):
            case None:
                return node
            case Name(text) | Text(text):
                return replace(node, text=text)
            case value:
                self._report_sort(node, "an object", kind_of(value))
                return node

    def _all(self, nodes: tuple[Setting, ...]) -> tuple[Setting, ...]:
        return tuple(replace(node, value=self._value(node.value)) for node in nodes)

    def _value(self, node: Value) -> Value:
        match node:
            case Name(name) if name in self._values:
                return replace(self._values[name], span=node.span)
            case Values(values):
                return replace(node, values=tuple(self._value(each) for each in values))
            case _:
                return node

    def _constraint(self, node: Constraint) -> Constraint:
        match node:
            case SampleEvery(Name() as name):
                return replace(node, period=self._time(name))
            case MaxDelay(Name() as name):
                return replace(node, delay=self._time(name))
            case FromTo(start, end):
                start = self._time(start) if isinstance(start, Name) else start
                end = self._time(end) if isinstance(end, Name) else end
                return replace(node, start=start, end=end)
            case To(Name() as name):
                return replace(node, end=self._time(name))
            case _:
                return node

    def _time(self, node: Name) -> Time | Name:
        match self._values.get(node.text):
            case None:
                nearest = nearest_name(node.text, self._values)
                self.faults.append(UnknownNameError("parameter", node.text, node.span, nearest))
                return node
            case Time(time):
                return Time(time, span=node.span)
            case Number(number):
                return Time(milliseconds(number), span=node.span)
            case value:
                self._report_sort(node, "time", kind_of(value))
                return node

    def _report_sort(self, node: Name, expected: str, found: str) -> None:
        what = f"the parameter '{node.text}'"
        self.faults.append(SortMismatchError(what, expected, found, node.span))

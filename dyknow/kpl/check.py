"""Every static fault of a KPL specification, in reading order.

Names, arities, sorts, cycles, policies and settings are checked under the values that the
parameters have; who passes other values checks again, as `dyknow.kpl.plan` does. Sources and
computational units share one set of names; labels, streams and parameters have each their own.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from dyknow.errors import (
    ArityError,
    CircularDefinitionError,
    PolicyError,
    SortMismatchError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.kpl.names import Declarations, labels_in, streams_of
from dyknow.kpl.parameters import bind_parameters
from dyknow.kpl.policies import policy_from_constraints
from dyknow.kpl.printer import text_from
from dyknow.kpl.settings import repeated_settings, setting_faults
from dyknow.kpl.syntax import (
    ANY_SORT,
    GeneratorDeclaration,
    Label,
    Link,
    Name,
    Process,
    Setting,
    Sort,
    SourceInstance,
    Specification,
    StreamDeclaration,
    StreamTerm,
    Synchronisation,
    UnitInstance,
    Value,
)
from dyknow.source_text import nearest_name

__all__ = ["check", "faults", "raise_faults"]

Faults = Iterator[SpecificationError]
Units = Mapping[str, Callable[..., Any]]
"""What makes computational units, by symbol, as far as it is known."""


def check(
    specification: Specification,
    values: Mapping[str, Value] | None = None,
    units: Units | None = None,
) -> Specification:
    """Return the specification with its parameters bound, or raise all its faults.

    Raises:
        SpecificationErrors: There are faults; see `faults`.
    """
    raise_faults(faults(specification, values, units))
    return bind_parameters(specification, values or {})[0]


def raise_faults(found: list[SpecificationError]) -> None:
    """Raise *found* as one error, unless it is empty.

    Raises:
        SpecificationErrors: It is not.
    """
    if found:
        raise SpecificationErrors(f"{len(found)} fault(s)", found)


def faults(
    specification: Specification,
    values: Mapping[str, Value] | None = None,
    units: Units | None = None,
) -> list[SpecificationError]:
    """Return every fault of a specification.

    Args:
        specification: As parsed.
        values: Of parameters, in place of their defaults.
        units: What makes the computational units, as far as it is known; settings are checked
            against the signatures.
    """
    bound, found = bind_parameters(specification, values or {})
    declared = Declarations(bound)
    found.extend(declared.duplicates())
    found.extend(_Checker(declared, units or {}).faults())
    found.extend(_cycles(declared))
    return sorted(found, key=lambda fault: fault.span.start)


class _Checker:
    """Looks at each declaration in turn."""

    def __init__(self, declared: Declarations, factories: Units) -> None:
        self._declared = declared
        self._factories = factories

    def faults(self) -> Faults:
        for declaration in self._declared.all:
            match declaration:
                case GeneratorDeclaration(label, process):
                    yield from self._arity(label)
                    yield from self._process(process)
                case StreamDeclaration(_, stream):
                    yield from self._stream(stream)
                case _:
                    pass

    def _process(self, process: Process) -> Faults:
        match process:
            case SourceInstance(source):
                yield from self._source(source)
            case UnitInstance(unit, streams, settings):
                yield from self._application(unit, streams)
                yield from self._settings(unit, settings)
            case Link():
                yield from self._application(process.unit, (process.stream,))
                yield from repeated_settings(process.settings)
            case Synchronisation(streams):
                yield from self._streams(streams)

    def _source(self, source: Name) -> Faults:
        known = self._declared.sources
        if source.text in known:
            return
        if source.text in self._declared.units:
            unit = self._declared.units[source.text]
            yield ArityError(source.text, len(unit.inputs), 0, source.span)
        else:
            nearest = nearest_name(source.text, known)
            yield UnknownNameError("source", source.text, source.span, nearest)

    def _application(self, unit: Name, streams: tuple[StreamTerm, ...]) -> Faults:
        known = self._declared.units
        if unit.text not in known:
            nearest = nearest_name(unit.text, known)
            yield UnknownNameError("computational unit", unit.text, unit.span, nearest)
        else:
            yield from self._arguments(unit, known[unit.text].sorts_for(len(streams)), streams)
        yield from self._streams(streams)

    def _arguments(
        self, unit: Name, expected: tuple[Sort, ...], streams: tuple[StreamTerm, ...]
    ) -> Faults:
        if len(expected) != len(streams):
            yield ArityError(unit.text, len(expected), len(streams), unit.span)
            return
        for number, (sort, stream) in enumerate(zip(expected, streams, strict=True), start=1):
            yield from self._sort(f"argument {number} of '{unit.text}'", sort, stream)

    def _sort(self, what: str, expected: Sort, stream: StreamTerm) -> Faults:
        found = self._declared.sort_of(stream.provider)
        if found is not None and not _accepts(expected, found):
            yield SortMismatchError(what, text_from(expected), text_from(found), stream.span)

    def _settings(self, unit: Name, settings: tuple[Setting, ...]) -> Faults:
        yield from repeated_settings(settings)
        if unit.text in self._factories:
            yield from setting_faults(unit, settings, self._factories[unit.text])

    def _streams(self, streams: tuple[StreamTerm, ...]) -> Faults:
        for stream in streams:
            yield from self._stream(stream)

    def _stream(self, stream: StreamTerm) -> Faults:
        yield from _policy(stream)
        if isinstance(stream.provider, Synchronisation):
            yield from self._streams(stream.provider.streams)
        else:
            yield from self._label(stream.provider)

    def _label(self, label: Label) -> Faults:
        name = text_from(label)
        is_unbound = any(each.text in self._declared.parameters for each in label.objects)
        if name in self._declared.generators or is_unbound:
            return
        if label.feature.text in self._declared.arities and any(self._arity(label)):
            yield from self._arity(label)
        else:
            nearest = nearest_name(name, self._declared.generators)
            yield UnknownNameError("stream generator", name, label.span, nearest)

    def _arity(self, label: Label) -> Faults:
        feature, found = label.feature.text, len(label.objects)
        expected = self._declared.arities.get(feature, found)
        if expected != found:
            yield ArityError(feature, expected, found, label.span)


def _policy(stream: StreamTerm) -> Faults:
    try:
        policy_from_constraints(stream.constraints)
    except ValueError as fault:
        yield PolicyError(str(fault), stream.span)
    except TypeError:  # a parameter is not bound, which is reported already
        return


def _accepts(expected: Sort, found: Sort) -> bool:
    if ANY_SORT in (expected.name, found.name):
        return True
    if expected.name != found.name:
        return False
    if not expected.parts or not found.parts:
        return True
    return len(expected.parts) == len(found.parts) and all(
        map(_accepts, expected.parts, found.parts)
    )


def _cycles(declared: Declarations) -> Faults:
    """Yield one fault for each place where following the inputs leads back."""
    done: set[str] = set()
    for start in declared.generators:
        yield from _cycles_from(start, [], done, declared)


def _cycles_from(name: str, path: list[str], done: set[str], declared: Declarations) -> Faults:
    if name in path:
        circle = [*path[path.index(name) :], name]
        yield CircularDefinitionError(circle, declared.generators[name].label.span)
    elif name not in done and name in declared.generators:
        path.append(name)
        for label in labels_in(streams_of(declared.generators[name].process)):
            yield from _cycles_from(text_from(label), path, done, declared)
        path.pop()
        done.add(name)

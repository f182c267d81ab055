"""Every static fault of a KPL specification, in reading order.

Names, arities, sorts, cycles, policies and settings are checked under the values that the
parameters have; who passes other values checks again, as `dyknow.kpl.plan` does.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from dyknow.errors import (
    ArityError,
    SortMismatchError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.kpl.cycles import cycles
from dyknow.kpl.duplicates import duplicates, unfit_member
from dyknow.kpl.names import Declarations, Placed, Scope, streams_of
from dyknow.kpl.parameters import bind_parameters
from dyknow.kpl.parser import Reading, read_specification
from dyknow.kpl.printer import text_from
from dyknow.kpl.promises import Promises
from dyknow.kpl.settings import repeated_settings, setting_faults
from dyknow.kpl.sorts import Sorts, accepts
from dyknow.kpl.states import field_names_of_states
from dyknow.kpl.syntax import (
    ANY_SORT,
    Configuration,
    GeneratorDeclaration,
    Label,
    Link,
    Mediation,
    Merging,
    Name,
    Process,
    Provider,
    Selection,
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

__all__ = ["check", "faults", "faults_of_text", "raise_faults"]

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
    found.extend(duplicates(declared))
    found.extend(_Checker(declared, units or {}).faults())
    found.extend(cycles(declared))
    return sorted(found, key=lambda fault: fault.span.start)


def faults_of_text(
    text: str,
    name: str = "<specification>",
    values: Mapping[str, Value] | None = None,
    units: Units | None = None,
) -> list[SpecificationError]:
    """Return every fault of a text: where it does not follow the grammar, and of all the rest.

    What may be a fault only because a declaration could not be read is left out.
    """
    reading = read_specification(text, name)
    found = faults(reading.specification, values, units)
    certain = [fault for fault in found if not _may_follow(fault, reading)]
    return sorted([*reading.faults, *certain], key=lambda fault: fault.span.start)


def _may_follow(fault: SpecificationError, reading: Reading) -> bool:
    """Return whether a fault may be there only for the sake of what could not be read."""
    if isinstance(fault, UnknownNameError) and fault.name.split("[")[0] in reading.lost:
        return True
    spans = [(each.span.start, each.span.end) for each in reading.faults]
    return any(fault.span.start <= end and start <= fault.span.end for start, end in spans)


class _Checker:
    """Looks at each declaration in turn."""

    def __init__(self, declared: Declarations, factories: Units) -> None:
        self._declared = declared
        self._factories = factories
        self._sorts = Sorts(declared)
        self._promises = Promises(declared)

    def faults(self) -> Faults:
        for declaration, scope in self._declared.scoped():
            match declaration:
                case GeneratorDeclaration(label, process):
                    yield from self._arity(label)
                    yield from _unbound_members(label, scope)
                    yield from self._process(process, scope)
                    yield from self._promises.faults_of_generator(Placed(declaration, scope))
                case StreamDeclaration(name, stream):
                    yield from _unbound_members(name, scope)
                    yield from self._stream(stream, scope)
                case Configuration(_, members):
                    yield from self._stream(members, scope)
                case _:
                    pass

    def _process(self, process: Process | Provider, scope: Scope) -> Faults:
        match process:
            case Label():
                yield from self._label(process, scope)
            case SourceInstance(source):
                yield from self._source(source)
            case UnitInstance(unit, streams, settings):
                yield from self._application(unit, streams, scope)
                yield from self._settings(unit, settings)
            case Link():
                yield from self._application(process.unit, (process.stream,), scope)
                yield from repeated_settings(process.settings)
            case _:
                yield from self._operation(process, scope)

    def _operation(
        self, process: Synchronisation | Merging | Mediation | Selection, scope: Scope
    ) -> Faults:
        match process:
            case Synchronisation(streams):
                yield from self._streams(streams, scope)
            case Merging(streams):
                yield from self._streams(streams, scope)
                yield from self._one_sort(streams, scope)
            case Mediation(stream, _, members):
                yield from unfit_member(process, scope, self._declared)
                yield from self._stream(members, scope)
                yield from self._stream(stream, scope.merging(process))
            case Selection():
                yield from _repeated_fields(process)
                yield from self._fields_of_states(process, scope)
                yield from self._streams(streams_of(process), scope)

    def _fields_of_states(self, selection: Selection, scope: Scope) -> Faults:
        """Yield a fault for each field that states do not have, if it is states."""
        selected: Process | Provider = selection.provider
        if isinstance(selected, Label):
            found = self._declared.meaning(selected, scope).generators
            selected = found[0].declaration.process if len(found) == 1 else selected
        if not isinstance(selected, Synchronisation):
            return
        known = field_names_of_states(selected.streams)
        used = [(field.path, field.span) for field in selection.fields]
        used += [(condition.path, condition.span) for condition in selection.conditions]
        for path, span in used:
            name = path.split(".")[0]
            if name not in known:
                yield UnknownNameError("field", name, span, nearest_name(name, known))

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

    def _application(self, unit: Name, streams: tuple[StreamTerm, ...], scope: Scope) -> Faults:
        known = self._declared.units
        if unit.text not in known:
            nearest = nearest_name(unit.text, known)
            yield UnknownNameError("computational unit", unit.text, unit.span, nearest)
        else:
            expected = known[unit.text].sorts_for(len(streams))
            yield from self._arguments(unit, expected, streams, scope)
        yield from self._streams(streams, scope)

    def _arguments(
        self, unit: Name, expected: tuple[Sort, ...], streams: tuple[StreamTerm, ...], scope: Scope
    ) -> Faults:
        if len(expected) != len(streams):
            yield ArityError(unit.text, len(expected), len(streams), unit.span)
            return
        for number, (sort, stream) in enumerate(zip(expected, streams, strict=True), start=1):
            yield from self._sort(f"argument {number} of '{unit.text}'", sort, stream, scope)

    def _one_sort(self, streams: tuple[StreamTerm, ...], scope: Scope) -> Faults:
        """Yield a fault for each merged stream of another sort than the first that is known."""
        sorts = (self._sorts.of(stream.provider, scope) for stream in streams)
        expected = next((sort for sort in sorts if sort.name != ANY_SORT), Sort(ANY_SORT))
        for number, stream in enumerate(streams, start=1):
            yield from self._sort(f"stream {number} of 'merge'", expected, stream, scope)

    def _sort(self, what: str, expected: Sort, stream: StreamTerm, scope: Scope) -> Faults:
        found = self._sorts.of(stream.provider, scope)
        if not accepts(expected, found):
            yield SortMismatchError(what, text_from(expected), text_from(found), stream.span)

    def _settings(self, unit: Name, settings: tuple[Setting, ...]) -> Faults:
        yield from repeated_settings(settings)
        if unit.text in self._factories:
            yield from setting_faults(unit, settings, self._factories[unit.text])

    def _streams(self, streams: tuple[StreamTerm, ...], scope: Scope) -> Faults:
        for stream in streams:
            yield from self._stream(stream, scope)

    def _stream(self, stream: StreamTerm, scope: Scope) -> Faults:
        yield from self._promises.faults_of_stream(stream, scope)
        yield from self._process(stream.provider, scope)

    def _label(self, label: Label, scope: Scope) -> Faults:
        is_unbound = any(each.text in self._declared.parameters for each in label.objects)
        meaning = self._declared.meaning(label, scope)
        if is_unbound or meaning.all or scope.is_merged(label):
            return
        if meaning.elsewhere:
            block = meaning.elsewhere[0].scope.blocks[-1]
            message = (
                f"'{label.text}' is not known here: it exists for each '{block.member.text}' in "
                f"'{text_from(block.members)}' alone; expected a label that always exists, or "
                f"'merge(... for each ...)'"
            )
            yield SpecificationError(message, label.span)
        elif label.feature.text in self._declared.arities and any(self._arity(label)):
            yield from self._arity(label)
        else:
            known = [each.label.text for each in self._declared.placed]
            nearest = nearest_name(label.text, known)
            yield UnknownNameError("stream generator", label.text, label.span, nearest)

    def _arity(self, label: Label) -> Faults:
        feature, found = label.feature.text, len(label.objects)
        expected = self._declared.arities.get(feature, found)
        if expected != found:
            yield ArityError(feature, expected, found, label.span)


def _unbound_members(label: Label, scope: Scope) -> Faults:
    """Yield a fault if a label would be declared more than once, for several members."""
    objects = {each.text for each in label.objects}
    for block in scope.blocks:
        if block.member.text not in objects:
            message = (
                f"'{label.text}' would be declared again for each '{block.member.text}'; "
                f"expected '{block.member.text}' among its objects"
            )
            yield SpecificationError(message, label.span)


def _repeated_fields(selection: Selection) -> Faults:
    """Yield a fault for each field that comes out under a name that is taken for sure."""
    names: set[str] = set()
    for field in selection.fields:
        name = field.path if field.pattern is None else field.pattern
        if name in names:
            message = f"two fields are called '{name}'; expected a name for each, with 'as'"
            yield SpecificationError(message, field.span)
        names.add(name)

"""Every fault of a chronicle file that can be found without running it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from chronicles.constraints import Bound, TemporalNetwork, bounds_of
from chronicles.errors import (
    ChronicleError,
    InconsistentConstraintsError,
    UnboundInstantError,
    UnboundVariableError,
    ValueOutsideDomainError,
)
from chronicles.printer import text_of
from chronicles.syntax import (
    VALUE_VARIABLE,
    AttributeDeclaration,
    Chronicle,
    ChronicleFile,
    Comparison,
    Difference,
    Domain,
    DomainDeclaration,
    EventAt,
    EventType,
    Instant,
    Membership,
    MessageDeclaration,
    NoEvent,
    Occurs,
    Parameter,
    Relation,
    ReportAll,
    ReportNonOverlapping,
    TemporalConstraint,
    Value,
    ValueSet,
    Variable,
    Within,
    variables_of,
)
from dyknow.errors import (
    ArityError,
    DuplicateNameError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.source_text import Span, nearest_name

__all__ = ["check", "domain_values", "faults"]


def check(file: ChronicleFile) -> None:
    """Do nothing if *file* has no fault.

    Raises:
        SpecificationErrors: All its faults, in reading order.
    """
    found = faults(file)
    if found:
        raise SpecificationErrors("the chronicles have faults", found)


def faults(file: ChronicleFile) -> list[SpecificationError]:
    """Return every fault of *file*, in reading order."""
    declared = _Declared.of(file)
    found = [
        *_faults_of_names("domain", file.domains),
        *_faults_of_names("attribute or message", file.signals),
        *_faults_of_names("chronicle", file.chronicles),
    ]
    for signal in file.signals:
        found.extend(_faults_of_signal(signal, declared))
    for chronicle in file.chronicles:
        found.extend(_faults_of_chronicle(chronicle, declared))
    return sorted(found, key=lambda fault: (fault.span.start, fault.span.end))


def domain_values(domain: Domain, domains: Mapping[str, ValueSet]) -> frozenset[str]:
    """Return the members of *domain*, looking names up in *domains*."""
    value_set = domain if isinstance(domain, ValueSet) else domains[domain.name]
    return frozenset(value_set.values)


Named = Chronicle | AttributeDeclaration | MessageDeclaration


@dataclass(frozen=True)
class _Declared:
    """What a file declares, by name."""

    domains: Mapping[str, ValueSet]
    signals: Mapping[str, AttributeDeclaration | MessageDeclaration]

    @staticmethod
    def of(file: ChronicleFile) -> "_Declared":
        return _Declared(
            {declaration.name: declaration.domain for declaration in file.domains},
            {declaration.name: declaration for declaration in file.signals},
        )

    def allowed(
        self, signal: AttributeDeclaration | MessageDeclaration, variable: str
    ) -> frozenset[str] | None:
        """Return the values that *variable* may take in *signal*; None if any."""
        for membership in signal.memberships:
            domain = membership.domain
            is_known = isinstance(domain, ValueSet) or domain.name in self.domains
            if membership.variable.name == variable and is_known:
                return domain_values(domain, self.domains)
        return None


def _faults_of_names(
    kind: str, declarations: Iterable[DomainDeclaration | Named]
) -> Iterator[SpecificationError]:
    first: dict[str, Span] = {}
    for declaration in declarations:
        name, span = declaration.name, declaration.span
        if name in first:
            yield DuplicateNameError(kind, name, span, first[name])
        first.setdefault(name, span)


def _faults_of_parameters(node: Named) -> Iterator[SpecificationError]:
    first: dict[str, Span] = {}
    for parameter in node.parameters:
        if parameter.name in first:
            yield DuplicateNameError(
                "parameter", parameter.name, parameter.span, first[parameter.name]
            )
        elif parameter.name == VALUE_VARIABLE:
            yield _reserved_value(parameter)
        first.setdefault(parameter.name, parameter.span)


def _reserved_value(variable: Variable) -> ChronicleError:
    message = f"'{VALUE_VARIABLE}' stands for the value of an attribute and is no parameter"
    return ChronicleError(message, variable.span)


def _faults_of_domain(domain: Domain, declared: _Declared) -> Iterator[SpecificationError]:
    if not isinstance(domain, ValueSet) and domain.name not in declared.domains:
        nearest = nearest_name(domain.name, declared.domains)
        yield UnknownNameError("domain", domain.name, domain.span, nearest)


def _faults_of_signal(
    signal: AttributeDeclaration | MessageDeclaration, declared: _Declared
) -> Iterator[SpecificationError]:
    yield from _faults_of_parameters(signal)
    known = [parameter.name for parameter in signal.parameters]
    if isinstance(signal, AttributeDeclaration):
        known.append(VALUE_VARIABLE)
    for membership in signal.memberships:
        variable = membership.variable
        if variable.name not in known:
            nearest = nearest_name(variable.name, known)
            yield UnknownNameError("parameter", variable.name, variable.span, nearest)
        yield from _faults_of_domain(membership.domain, declared)


def _faults_of_chronicle(
    chronicle: Chronicle, declared: _Declared
) -> Iterator[SpecificationError]:
    events = [s for s in chronicle.statements if isinstance(s, EventAt)]
    if not events:
        message = f"chronicle '{chronicle.name}' has no event"
        yield ChronicleError(message, chronicle.span)
        return
    bound = {v.name for event in events for v in variables_of(event.event_type)}
    instants = list(dict.fromkeys(event.instant for event in events))
    yield from _faults_of_parameters(chronicle)
    yield from _faults_of_variables(chronicle, bound)
    for statement in chronicle.statements:
        match statement:
            case EventAt(_, event_type, _) | NoEvent(_, event_type, _, _):
                yield from _faults_of_event_type(event_type, declared)
            case Occurs(_, least, most, event_type, _, _):
                yield from _faults_of_event_type(event_type, declared)
                if most is not None and least > most:
                    message = f"expected at least {least} as the largest number, found {most}"
                    yield ChronicleError(message, statement.span)
            case Membership(_, _, domain):
                yield from _faults_of_domain(domain, declared)
            case _:
                pass
    yield from _faults_of_time(chronicle, instants)
    reports = [s for s in chronicle.statements if isinstance(s, ReportAll | ReportNonOverlapping)]
    for report in reports[1:]:
        yield ChronicleError("expected at most one 'report' statement", report.span)


def _faults_of_variables(chronicle: Chronicle, bound: set[str]) -> Iterator[SpecificationError]:
    used: list[Variable] = list(chronicle.parameters)
    for statement in chronicle.statements:
        used.extend(_variables_used_by(statement))
    for variable in used:
        if variable.name == VALUE_VARIABLE:
            yield _reserved_value(variable)
        elif variable.name not in bound:
            nearest = nearest_name(variable.name, bound)
            yield UnboundVariableError(variable.name, variable.span, nearest)


def _variables_used_by(statement: object) -> Iterator[Variable]:
    match statement:
        case NoEvent(_, event_type, _, _) | Occurs(_, _, _, event_type, _, _):
            yield from variables_of(event_type)
        case Membership(_, variable, _):
            yield variable
        case Relation(_, variable, _, other):
            yield variable
            if isinstance(other, Variable):
                yield other
        case EventAt(_, event_type, _):
            yield from (v for v in variables_of(event_type) if v.name == VALUE_VARIABLE)
        case _:
            pass


def _faults_of_event_type(
    event_type: EventType, declared: _Declared
) -> Iterator[SpecificationError]:
    if not declared.signals:
        return
    signal = declared.signals.get(event_type.name)
    if signal is None:
        nearest = nearest_name(event_type.name, declared.signals)
        span = event_type.span
        span = Span(span.source, span.start, span.start + len(event_type.name))
        yield UnknownNameError("attribute or message", event_type.name, span, nearest)
        return
    n_expected, n_found = len(signal.parameters), len(event_type.arguments)
    if n_expected != n_found:
        yield ArityError(event_type.name, n_expected, n_found, event_type.span)
    yield from _faults_of_kind(signal, event_type)
    names = [parameter.name for parameter in signal.parameters]
    yield from _faults_of_values(
        zip(event_type.arguments, names, strict=False),
        lambda name: declared.allowed(signal, name),
        signal.name,
    )
    if event_type.change:
        values = (event_type.change.before, event_type.change.after)
        yield from _faults_of_values(
            ((value, VALUE_VARIABLE) for value in values),
            lambda name: declared.allowed(signal, name),
            signal.name,
        )


def _faults_of_kind(
    signal: AttributeDeclaration | MessageDeclaration, event_type: EventType
) -> Iterator[SpecificationError]:
    if isinstance(signal, AttributeDeclaration) and event_type.change is None:
        message = f"expected ':(from, to)' behind the attribute '{signal.name}'"
        yield ChronicleError(message, event_type.span)
    if isinstance(signal, MessageDeclaration) and event_type.change is not None:
        message = f"'{signal.name}' is a message and has no values ':(from, to)'"
        yield ChronicleError(message, event_type.change.span)


def _faults_of_values(
    parameters: Iterable[tuple[Parameter, str]],
    allowed: Callable[[str], frozenset[str] | None],
    signal: str,
) -> Iterator[SpecificationError]:
    for parameter, name in parameters:
        values = allowed(name)
        if isinstance(parameter, Value) and values is not None and parameter.text not in values:
            nearest = nearest_name(parameter.text, sorted(values))
            place = f"'{name}' of '{signal}'"
            yield ValueOutsideDomainError(parameter.text, place, parameter.span, nearest)


def _faults_of_time(chronicle: Chronicle, known: Sequence[str]) -> Iterator[SpecificationError]:
    bounds: list[Bound] = []
    for statement in chronicle.statements:
        for name in _instants_used_by(statement):
            if name not in known:
                yield UnboundInstantError(name, statement.span, nearest_name(name, known))
        if isinstance(statement, TemporalConstraint):
            try:
                bounds.extend(bounds_of(statement))
            except ValueError as error:
                yield ChronicleError(f"{error}, found '{text_of(statement)}'", statement.span)
    bounds = [bound for bound in bounds if bound.later in known and bound.earlier in known]
    contradictory = TemporalNetwork(known, bounds).contradiction()
    if contradictory:
        in_order = sorted(contradictory, key=lambda constraint: constraint.span.start)
        texts = [text_of(constraint) for constraint in in_order]
        yield InconsistentConstraintsError(chronicle.name, texts, in_order[0].span)


def _instants_used_by(statement: object) -> tuple[str, ...]:
    match statement:
        case NoEvent(_, _, begin, end) | Occurs(_, _, _, _, begin, end):
            names = [begin.name, end.name]
        case ReportNonOverlapping(_, first, last):
            names = [first, last]
        case Comparison(_, operands, _):
            names = [name for operand in operands for name in _names_in(operand)]
        case Within(_, difference, _):
            names = list(_names_in(difference))
        case _:
            names = []
    return tuple(dict.fromkeys(names))


def _names_in(operand: object) -> tuple[str, ...]:
    match operand:
        case Instant(_, name, _):
            return (name,)
        case Difference(_, later, earlier, _):
            return (later, earlier)
        case _:
            return ()

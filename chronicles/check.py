"""Every fault of a chronicle file that can be found without running it."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from chronicles.conditions import (
    contradictory_conditions,
    holds,
    members_of,
    parts_of,
    references_of,
    variables_in,
)
from chronicles.constraints import bounds_of
from chronicles.errors import (
    ChronicleError,
    InconsistentConstraintsError,
    RecursionInChroniclesError,
    UnboundInstantError,
    UnboundVariableError,
    ValueOutsideDomainError,
)
from chronicles.expansion import (
    END,
    START,
    Expansion,
    expand,
    instants_of,
    statements_used,
)
from chronicles.printer import text_of
from chronicles.syntax import (
    VALUE_VARIABLE,
    AttributeDeclaration,
    Chronicle,
    ChronicleFile,
    Condition,
    ConstraintDeclaration,
    Domain,
    DomainDeclaration,
    EventAt,
    EventType,
    Inclusion,
    Membership,
    MessageDeclaration,
    NamedConstraint,
    NoEvent,
    Occurs,
    Parameter,
    ReportAll,
    ReportNonOverlapping,
    Star,
    Statement,
    TemporalConstraint,
    Value,
    Variable,
    VariableDeclaration,
    names_in,
    stars_of,
    variables_of,
)
from chronicles.timing import Timing, timing_of
from dyknow.errors import (
    ArityError,
    CircularDefinitionError,
    DuplicateNameError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.source_text import Span, nearest_name

__all__ = ["check", "faults"]


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
        *_faults_of_names("constraint", file.constraints),
        *_faults_of_names("attribute or message", file.signals),
        *_faults_of_names("chronicle", file.chronicles),
        *_faults_of_domains(file.domains),
        *_circles(file),
    ]
    for constraint in file.constraints:
        found.extend(_faults_of_constraint(constraint, declared))
    for signal in file.signals:
        found.extend(_faults_of_signal(signal, declared))
    for chronicle in file.chronicles:
        found.extend(_faults_of_chronicle(chronicle, file, declared))
    return sorted(found, key=lambda fault: (fault.span.start, fault.span.end))


Named = Chronicle | ConstraintDeclaration | AttributeDeclaration | MessageDeclaration
Signal = AttributeDeclaration | MessageDeclaration | Chronicle


@dataclass(frozen=True)
class _Declared:
    """What a file declares, by name."""

    domains: Mapping[str, Domain]
    constraints: Mapping[str, ConstraintDeclaration]
    signals: Mapping[str, AttributeDeclaration | MessageDeclaration]
    chronicles: Mapping[str, Chronicle]

    @staticmethod
    def of(file: ChronicleFile) -> "_Declared":
        return _Declared(
            _whole_domains(file.domains),
            {declaration.name: declaration for declaration in reversed(file.constraints)},
            {declaration.name: declaration for declaration in file.signals},
            {chronicle.name: chronicle for chronicle in reversed(file.chronicles)},
        )

    def allowed(self, signal: Signal, parameter: str) -> Callable[[str], bool]:
        """Return what tells whether a value may stand for *parameter* in *signal*."""
        conditions = [
            condition
            for condition in getattr(signal, "conditions", ())
            if {variable.name for variable in variables_in(condition)} == {parameter}
            and self.knows_domains_of(condition)
        ]
        return lambda value: all(
            holds(condition, {parameter: value}, self.domains) for condition in conditions
        )

    def listed(self, signal: Signal, parameter: str) -> Iterator[str]:
        """Yield the values that are written down for *parameter* in *signal*."""
        for condition in getattr(signal, "conditions", ()):
            names = [variable.name for variable in variables_in(condition)]
            is_membership = isinstance(condition, Membership) and names == [parameter]
            if is_membership and self.knows_domains_of(condition):
                yield from sorted(members_of(condition.domain, self.domains).values)

    def knows_domains_of(self, condition: Condition) -> bool:
        """Return whether every domain in *condition* is known."""
        parts = [part for part in parts_of(condition) if isinstance(part, Membership)]
        names = [ref.name for part in parts for ref in references_of(part.domain)]
        return all(name in self.domains for name in names)


def _whole_domains(declarations: Sequence[DomainDeclaration]) -> dict[str, Domain]:
    """Return the domains that can be worked out, by name: no circle, no unknown name."""
    waiting = {declaration.name: declaration.domain for declaration in declarations}
    whole: dict[str, Domain] = {}
    while True:
        ready = [n for n, d in waiting.items() if all(r.name in whole for r in references_of(d))]
        if not ready:
            return whole
        for name in ready:
            whole[name] = waiting.pop(name)


def _faults_of_domains(declarations: Sequence[DomainDeclaration]) -> Iterator[SpecificationError]:
    names = [declaration.name for declaration in declarations]
    for declaration in declarations:
        for reference in references_of(declaration.domain):
            if reference.name not in names:
                nearest = nearest_name(reference.name, names)
                yield UnknownNameError("domain", reference.name, reference.span, nearest)
    used = {d.name: [r.name for r in references_of(d.domain)] for d in declarations}
    for declaration in declarations:
        circle = _circle(declaration.name, used)
        if circle and declaration.name == min(circle):
            yield CircularDefinitionError(circle, declaration.span)


def _circle(name: str, used: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the shortest way from *name* to itself; empty if there is none."""
    ways = [[name]]
    seen: set[str] = set()
    for way in ways:
        for following in used.get(way[-1], ()):
            if following == name:
                return [*way, name]
            if following not in seen:
                seen.add(following)
                ways.append([*way, following])
    return []


def _circles(file: ChronicleFile) -> Iterator[SpecificationError]:
    """Yield the chronicles and constraints that are made of themselves."""
    chronicles = {chronicle.name for chronicle in file.chronicles}
    signals = {signal.name for signal in file.signals}
    used: dict[str, list[str]] = {}
    for chronicle in file.chronicles:
        names = [u.name for u in statements_used(chronicle) if isinstance(u, Inclusion)]
        types = [_event_type(statement) for statement in chronicle.statements]
        events = {t.name for t in types if t is not None} - signals
        used.setdefault(chronicle.name, [*names, *sorted(events & chronicles)])
    for chronicle in file.chronicles:
        circle = _circle(chronicle.name, used)
        if circle and chronicle.name == min(circle):
            yield RecursionInChroniclesError(circle, chronicle.span)
    used = {c.name: [u.name for u in statements_used(c)] for c in file.constraints}
    for constraint in file.constraints:
        circle = _circle(constraint.name, used)
        if circle and constraint.name == min(circle):
            yield RecursionInChroniclesError(circle, constraint.span)


def _event_type(statement: object) -> EventType | None:
    return statement.event_type if isinstance(statement, EventAt | NoEvent | Occurs) else None


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


def _reserved_value(variable: Variable | Star) -> ChronicleError:
    message = f"'{VALUE_VARIABLE}' stands for the value of an attribute and is no parameter"
    return ChronicleError(message, variable.span)


def _faults_of_domain(domain: Domain, declared: _Declared) -> Iterator[SpecificationError]:
    for reference in references_of(domain):
        if reference.name not in declared.domains:
            nearest = nearest_name(reference.name, declared.domains)
            yield UnknownNameError("domain", reference.name, reference.span, nearest)


def _faults_of_condition(
    condition: Condition, known: Sequence[str], declared: _Declared
) -> Iterator[SpecificationError]:
    for variable in variables_in(condition):
        if variable.name not in known:
            nearest = nearest_name(variable.name, known)
            yield UnknownNameError("parameter", variable.name, variable.span, nearest)
    yield from _faults_of_domains_in(condition, declared)


def _faults_of_domains_in(
    condition: Condition, declared: _Declared
) -> Iterator[SpecificationError]:
    for part in parts_of(condition):
        if isinstance(part, Membership):
            yield from _faults_of_domain(part.domain, declared)


def _faults_of_signal(
    signal: AttributeDeclaration | MessageDeclaration, declared: _Declared
) -> Iterator[SpecificationError]:
    yield from _faults_of_parameters(signal)
    known = [parameter.name for parameter in signal.parameters]
    if isinstance(signal, AttributeDeclaration):
        known.append(VALUE_VARIABLE)
    for condition in signal.conditions:
        yield from _faults_of_condition(condition, known, declared)


def _faults_of_constraint(
    constraint: ConstraintDeclaration, declared: _Declared
) -> Iterator[SpecificationError]:
    yield from _faults_of_parameters(constraint)
    yield from _duplicates_among("instant", constraint.instants, constraint.span)
    variables = [parameter.name for parameter in constraint.parameters]
    for statement in constraint.statements:
        for name in dict.fromkeys(instants_of(statement)):
            if name not in constraint.instants:
                nearest = nearest_name(name, constraint.instants)
                yield UnknownNameError("instant", name, statement.span, nearest)
        match statement:
            case NamedConstraint():
                yield from _faults_of_use(statement, declared)
            case _ if isinstance(statement, TemporalConstraint):
                yield from _faults_of_comparison(statement)
            case _ if isinstance(statement, Condition):
                yield from _faults_of_condition(statement, variables, declared)
            case _:
                pass


def _duplicates_among(kind: str, names: Sequence[str], span: Span) -> Iterator[SpecificationError]:
    for name in dict.fromkeys(name for name in names if names.count(name) > 1):
        yield DuplicateNameError(kind, name, span, span)


def _faults_of_comparison(constraint: TemporalConstraint) -> Iterator[SpecificationError]:
    try:
        bounds_of(constraint)
    except ValueError as error:
        yield ChronicleError(f"{error}, found '{text_of(constraint)}'", constraint.span)


def _faults_of_use(
    use: NamedConstraint | Inclusion, declared: _Declared
) -> Iterator[SpecificationError]:
    is_inclusion = isinstance(use, Inclusion)
    known = declared.chronicles if is_inclusion else declared.constraints
    named: Chronicle | ConstraintDeclaration | None = known.get(use.name)
    if named is None:
        kind = "chronicle" if is_inclusion else "constraint"
        yield UnknownNameError(kind, use.name, use.span, nearest_name(use.name, known))
        return
    if len(use.parameters) != len(named.parameters):
        yield ArityError(use.name, len(named.parameters), len(use.parameters), use.span)
    if isinstance(use, Inclusion):
        assert isinstance(named, Chronicle)
        yield from _faults_of_bindings(use, named)
    elif len(use.instants) != len(named.instants):
        yield ArityError(use.name, len(named.instants), len(use.instants), use.span)


def _faults_of_bindings(use: Inclusion, included: Chronicle) -> Iterator[SpecificationError]:
    labels = [binding.label for binding in use.bindings]
    n_by_place = sum(label is None for label in labels)
    if any(label is None for label in labels[n_by_place:]):
        message = "expected instants without a name before those with one"
        yield ChronicleError(message, use.span)
    if n_by_place > len(included.instants):
        yield ArityError(use.name, len(included.instants), n_by_place, use.span)
    inside = {name for statement in included.statements for name in instants_of(statement)}
    known = [*dict.fromkeys([*included.instants, *sorted(inside), START, END])]
    names = [*included.instants[:n_by_place], *(label for label in labels if label)]
    for name in dict.fromkeys(names):
        if name not in known:
            yield UnknownNameError("instant", name, use.span, nearest_name(name, known))
    yield from _duplicates_among("instant", names, use.span)


def _faults_of_chronicle(
    chronicle: Chronicle, file: ChronicleFile, declared: _Declared
) -> Iterator[SpecificationError]:
    yield from _faults_of_statements(chronicle, declared)
    expansion = expand(chronicle, file)
    if not expansion.events:
        if not any(isinstance(s, Inclusion) for s in chronicle.statements):
            message = f"chronicle '{chronicle.name}' has no event"
            yield ChronicleError(message, chronicle.span)
        return
    yield from _faults_of_parameters(chronicle)
    yield from _faults_of_variables(chronicle, expansion)
    yield from _faults_of_stars(expansion)
    yield from _faults_of_time(chronicle, expansion)
    yield from _faults_of_values_together(chronicle, expansion, declared)


def _faults_of_statements(
    chronicle: Chronicle, declared: _Declared
) -> Iterator[SpecificationError]:
    for statement in chronicle.statements:
        yield from _faults_of_statement(statement, declared)
    reports = [s for s in chronicle.statements if isinstance(s, ReportAll | ReportNonOverlapping)]
    for report in reports[1:]:
        yield ChronicleError("expected at most one 'report' statement", report.span)


def _faults_of_statement(
    statement: Statement, declared: _Declared
) -> Iterator[SpecificationError]:
    if isinstance(statement, TemporalConstraint):
        yield from _faults_of_comparison(statement)
    if isinstance(statement, Condition):
        yield from _faults_of_domains_in(statement, declared)
    match statement:
        case EventAt(_, event_type, _, _) | NoEvent(_, event_type, _, _):
            yield from _faults_of_event_type(event_type, declared)
        case Occurs(_, least, most, event_type, _, _):
            yield from _faults_of_event_type(event_type, declared)
            if most is not None and least > most:
                message = f"expected at least {least} as the largest number, found {most}"
                yield ChronicleError(message, statement.span)
        case Inclusion() | NamedConstraint():
            yield from _faults_of_use(statement, declared)
        case VariableDeclaration(_, _, domain) if domain is not None:
            yield from _faults_of_domain(domain, declared)
        case _:
            pass


def _faults_of_variables(
    chronicle: Chronicle, expansion: Expansion
) -> Iterator[SpecificationError]:
    bound = {v.name for event in expansion.events for v in variables_of(event.event_type)}
    used: list[Variable | Star] = list(chronicle.parameters)
    for statement in chronicle.statements:
        if isinstance(statement, VariableDeclaration):
            used.extend(statement.variables)
    for statement in expansion.statements:
        used.extend(_variables_used_by(statement))
    told: set[Span] = set()
    for variable in used:
        is_ours = isinstance(variable, Variable) and "." not in variable.name
        if variable.name == VALUE_VARIABLE:
            yield _reserved_value(variable)
        elif is_ours and variable.name not in bound and variable.span not in told:
            told.add(variable.span)
            nearest = nearest_name(variable.name, [name for name in bound if "." not in name])
            yield UnboundVariableError(variable.name, variable.span, nearest)


def _variables_used_by(statement: object) -> Iterator[Variable | Star]:
    match statement:
        case NoEvent(_, event_type, _, _) | Occurs(_, _, _, event_type, _, _):
            yield from variables_of(event_type)
        case EventAt(_, event_type, _, _):
            yield from (v for v in variables_of(event_type) if v.name == VALUE_VARIABLE)
        case _ if isinstance(statement, Condition):
            yield from variables_in(statement)
        case _:
            pass


def _faults_of_stars(expansion: Expansion) -> Iterator[SpecificationError]:
    """Yield the conditions on star variables that no event type can be tested for."""
    types = [t for t in map(_event_type, expansion.statements) if t is not None]
    groups = [names_in(t) for t in types]
    starred = {star.name for t in types for star in stars_of(t)}
    for name, span in expansion.stars.items():
        if name not in starred and "." not in name:
            yield ChronicleError(f"no event type uses '{name}'", span)
    for statement in expansion.statements:
        if isinstance(statement, Condition):
            variables = variables_in(statement)
            names = {variable.name for variable in variables}
            has_star = any(isinstance(variable, Star) for variable in variables)
            is_ours = not any("." in name for name in names)
            if has_star and is_ours and not any(names <= group for group in groups):
                listed = ", ".join(f"'{name}'" for name in sorted(names))
                message = f"expected an event type with all of {listed}, found none"
                yield ChronicleError(message, statement.span)


def _faults_of_event_type(
    event_type: EventType, declared: _Declared
) -> Iterator[SpecificationError]:
    signal: Signal | None = declared.signals.get(event_type.name)
    signal = signal or declared.chronicles.get(event_type.name)
    if signal is None and not declared.signals:
        return
    if signal is None:
        nearest = nearest_name(event_type.name, [*declared.signals, *declared.chronicles])
        span = event_type.span
        span = Span(span.source, span.start, span.start + len(event_type.name))
        yield UnknownNameError("attribute or message", event_type.name, span, nearest)
        return
    n_expected, n_found = len(signal.parameters), len(event_type.arguments)
    if n_expected != n_found:
        yield ArityError(event_type.name, n_expected, n_found, event_type.span)
    yield from _faults_of_kind(signal, event_type)
    names = [parameter.name for parameter in signal.parameters]
    for parameter, name in zip(event_type.arguments, names, strict=False):
        yield from _faults_of_value(parameter, name, signal, declared)
    if event_type.change and not isinstance(signal, Chronicle):
        for value in (event_type.change.before, event_type.change.after):
            yield from _faults_of_value(value, VALUE_VARIABLE, signal, declared)


def _faults_of_kind(signal: Signal, event_type: EventType) -> Iterator[SpecificationError]:
    if isinstance(signal, AttributeDeclaration) and event_type.change is None:
        message = f"expected ':(from, to)' behind the attribute '{signal.name}'"
        yield ChronicleError(message, event_type.span)
    if isinstance(signal, MessageDeclaration) and event_type.change is not None:
        message = f"'{signal.name}' is a message and has no values ':(from, to)'"
        yield ChronicleError(message, event_type.change.span)


def _faults_of_value(
    parameter: Parameter, name: str, signal: Signal, declared: _Declared
) -> Iterator[SpecificationError]:
    if isinstance(parameter, Value) and not declared.allowed(signal, name)(parameter.text):
        nearest = nearest_name(parameter.text, declared.listed(signal, name))
        place = f"'{name}' of '{signal.name}'"
        yield ValueOutsideDomainError(parameter.text, place, parameter.span, nearest)


def _faults_of_time(chronicle: Chronicle, expansion: Expansion) -> Iterator[SpecificationError]:
    timing = timing_of(expansion)
    known = set(timing.places)
    contradictory = timing.network.contradiction()
    if contradictory:
        yield _contradiction(chronicle, contradictory)
        known = {name for name in known if _is_time_of_event(expansion, name)}
    near = [name for name in known if "." not in name and " " not in name]
    used = list(expansion.declared.items())
    for statement in expansion.statements:
        used += [(name, statement.span) for name in dict.fromkeys(instants_of(statement))]
    for name, span in used:
        if name not in known and "." not in name:
            yield UnboundInstantError(name, span, nearest_name(name, near))
    yield from _faults_of_reports(expansion, timing)


def _faults_of_reports(expansion: Expansion, timing: Timing) -> Iterator[SpecificationError]:
    for report in expansion.statements:
        if isinstance(report, ReportNonOverlapping):
            for name in dict.fromkeys((report.begin, report.end)):
                if name in timing.places and timing.places[name].offset:
                    yield UnboundInstantError(name, report.span)


def _contradiction(
    chronicle: Chronicle, contradictory: Sequence[TemporalConstraint] | Sequence[Condition]
) -> SpecificationError:
    in_order = sorted(contradictory, key=lambda constraint: constraint.span.start)
    ours = chronicle.span
    inside = [c for c in in_order if ours.start <= c.span.start < ours.end]
    texts = list(dict.fromkeys(text_of(constraint) for constraint in in_order))
    span = inside[0].span if inside else chronicle.span
    return InconsistentConstraintsError(chronicle.name, texts, span)


def _is_time_of_event(expansion: Expansion, name: str) -> bool:
    """Return whether *name* is the time of an event, the beginning, or the end."""
    return name in expansion.extremes or any(e.instant == name for e in expansion.events)


def _faults_of_values_together(
    chronicle: Chronicle, expansion: Expansion, declared: _Declared
) -> Iterator[SpecificationError]:
    conditions = [
        statement
        for statement in expansion.statements
        if isinstance(statement, Condition) and declared.knows_domains_of(statement)
    ]
    contradictory = contradictory_conditions(conditions, declared.domains)
    if contradictory:
        yield _contradiction(chronicle, contradictory)

"""Every fault of a chronicle file that can be found without running it."""

from collections.abc import Iterator, Sequence

from chronicles.bindings import faults_of_stars, faults_of_variables
from chronicles.circles import circles, faults_of_domains
from chronicles.conditions import contradictory_conditions
from chronicles.declared import Declared
from chronicles.errors import ChronicleError, InconsistentConstraintsError, UnboundInstantError
from chronicles.event_types import faults_of_event_type
from chronicles.expansion import DEEPEST, MOST_EVENTS, Expansion, expand, instants_of
from chronicles.naming import (
    faults_of_condition,
    faults_of_domain,
    faults_of_domains_in,
    faults_of_names,
    faults_of_parameters,
)
from chronicles.parameters import faults_of_instants
from chronicles.printer import text_of
from chronicles.syntax import (
    VALUE_VARIABLE,
    AttributeDeclaration,
    Chronicle,
    ChronicleFile,
    Condition,
    EventAt,
    Inclusion,
    MessageDeclaration,
    NamedConstraint,
    NoEvent,
    Occurs,
    ReportAll,
    ReportNonOverlapping,
    Statement,
    TemporalConstraint,
    VariableDeclaration,
)
from chronicles.timing import Timing, timing_of
from chronicles.uses import faults_of_comparison, faults_of_constraint, faults_of_use
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.source_text import nearest_name

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
    declared = Declared.of(file)
    found = [
        *faults_of_names("parameter", file.parameters),
        *faults_of_instants(file),
        *faults_of_names("domain", file.domains),
        *faults_of_names("constraint", file.constraints),
        *faults_of_names("attribute or message", file.signals),
        *faults_of_names("chronicle", file.chronicles),
        *faults_of_domains(file.domains),
        *circles(file),
    ]
    for constraint in file.constraints:
        found.extend(faults_of_constraint(constraint, declared))
    for signal in file.signals:
        found.extend(_faults_of_signal(signal, declared))
    for chronicle in file.chronicles:
        found.extend(_faults_of_chronicle(chronicle, file, declared))
    return sorted(found, key=lambda fault: (fault.span.start, fault.span.end))


def _faults_of_signal(
    signal: AttributeDeclaration | MessageDeclaration, declared: Declared
) -> Iterator[SpecificationError]:
    yield from faults_of_parameters(signal)
    known = [parameter.name for parameter in signal.parameters]
    if isinstance(signal, AttributeDeclaration):
        known.append(VALUE_VARIABLE)
    for condition in signal.conditions:
        yield from faults_of_condition(condition, known, declared)


def _faults_of_chronicle(
    chronicle: Chronicle, file: ChronicleFile, declared: Declared
) -> Iterator[SpecificationError]:
    yield from _faults_of_statements(chronicle, declared)
    expansion = expand(chronicle, file)
    if expansion.is_too_large:
        limits = f"{MOST_EVENTS} events, and {DEEPEST} others inside one another"
        message = f"expected chronicle '{chronicle.name}' to have at most {limits}, found more"
        yield ChronicleError(message, chronicle.span)
        return
    if not expansion.events:
        if not any(isinstance(s, Inclusion) for s in chronicle.plain):
            message = f"chronicle '{chronicle.name}' has no event"
            yield ChronicleError(message, chronicle.span)
        return
    yield from faults_of_parameters(chronicle)
    yield from faults_of_variables(chronicle, expansion)
    yield from faults_of_stars(expansion)
    yield from _faults_of_time(chronicle, expansion, declared)
    yield from _faults_of_values_together(chronicle, expansion, declared)


def _faults_of_statements(
    chronicle: Chronicle, declared: Declared
) -> Iterator[SpecificationError]:
    for statement in chronicle.plain:
        yield from _faults_of_statement(statement, declared)
    reports = [s for s in chronicle.plain if isinstance(s, ReportAll | ReportNonOverlapping)]
    for report in reports[1:]:
        yield ChronicleError("expected at most one 'report' statement", report.span)


def _faults_of_statement(statement: Statement, declared: Declared) -> Iterator[SpecificationError]:
    if isinstance(statement, TemporalConstraint):
        yield from faults_of_comparison(statement)
    if isinstance(statement, Condition):
        yield from faults_of_domains_in(statement, declared)
    match statement:
        case EventAt(_, event_type, _, _) | NoEvent(_, event_type, _, _):
            yield from faults_of_event_type(event_type, declared)
        case Occurs(_, least, most, event_type, _, _):
            yield from faults_of_event_type(event_type, declared)
            if most is not None and least > most:
                message = f"expected at least {least} as the largest number, found {most}"
                yield ChronicleError(message, statement.span)
        case Inclusion() | NamedConstraint():
            yield from faults_of_use(statement, declared)
        case VariableDeclaration(_, _, domain) if domain is not None:
            yield from faults_of_domain(domain, declared)
        case _:
            pass


def _faults_of_time(
    chronicle: Chronicle, expansion: Expansion, declared: Declared
) -> Iterator[SpecificationError]:
    timing = timing_of(expansion)
    known = set(timing.places)
    contradictory = timing.network.contradiction()
    if contradictory:
        yield _contradiction(chronicle, contradictory)
        known = {name for name in known if _is_time_of_event(expansion, name)}
    known |= set(declared.parameters)  # where one stands for an instant is told elsewhere
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
    chronicle: Chronicle, expansion: Expansion, declared: Declared
) -> Iterator[SpecificationError]:
    conditions = [
        statement
        for statement in expansion.statements
        if isinstance(statement, Condition) and declared.knows_domains_of(statement)
    ]
    contradictory = contradictory_conditions(conditions, declared.domains)
    if contradictory:
        yield _contradiction(chronicle, contradictory)

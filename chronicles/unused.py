"""Declarations of a chronicle file that nothing in it uses."""

from collections.abc import Iterator
from itertools import chain

from chronicles.conditions import parts_of, references_of
from chronicles.event_types import event_type_of
from chronicles.syntax import (
    ChronicleFile,
    Condition,
    Domain,
    Membership,
    NamedConstraint,
    Parametric,
    Statement,
    VariableDeclaration,
)
from dyknow.errors import SpecificationError

__all__ = ["warnings"]


def warnings(file: ChronicleFile) -> list[SpecificationError]:
    """Return a remark on every declaration of *file* that nothing uses, in reading order.

    A chronicle is for those who recognise it. What only unused declarations use is used.
    """
    used = set(_names_used(file))
    unused = [
        *(each for each in file.parameters if ("parameter", each.name) not in used),
        *(domain for domain in file.domains if ("domain", domain.name) not in used),
        *(each for each in file.constraints if ("constraint", each.name) not in used),
        *(signal for signal in file.signals if ("signal", signal.name) not in used),
    ]
    found = [SpecificationError(f"'{each.name}' is not used", each.span) for each in unused]
    return sorted(found, key=lambda each: each.span.start)


def _names_used(file: ChronicleFile) -> Iterator[tuple[str, str]]:
    """Yield what is named in *file*, and what kind of thing it is."""
    yield from (("parameter", name) for name in _parameters_used(file))
    for domain in _domains_used(file):
        for reference in references_of(domain):
            yield "domain", reference.name
    for statement in _statements(file):
        event_type = event_type_of(statement)
        if event_type is not None:
            yield "signal", event_type.name
        if isinstance(statement, NamedConstraint):
            yield "constraint", statement.name


def _parameters_used(file: ChronicleFile) -> Iterator[str]:
    stated = [each.statements for each in file.chronicles]
    stated += [each.statements for each in file.constraints]
    for statement in chain.from_iterable(stated):
        if isinstance(statement, Parametric):
            yield from statement.parameters


def _domains_used(file: ChronicleFile) -> Iterator[Domain]:
    yield from (declaration.domain for declaration in file.domains)
    conditions = [condition for signal in file.signals for condition in signal.conditions]
    for statement in (*_statements(file), *conditions):
        if isinstance(statement, VariableDeclaration) and statement.domain is not None:
            yield statement.domain
        elif isinstance(statement, Condition):
            for part in parts_of(statement):
                if isinstance(part, Membership):
                    yield part.domain


def _statements(file: ChronicleFile) -> Iterator[Statement]:
    for chronicle in file.chronicles:
        yield from chronicle.plain
    for constraint in file.constraints:
        yield from constraint.plain

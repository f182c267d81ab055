"""Faults of named constraints and included chronicles, and of their uses."""

from collections.abc import Iterator

from chronicles.constraints import bounds_of
from chronicles.declared import Declared
from chronicles.errors import ChronicleError
from chronicles.expansion import END, START, instants_of
from chronicles.naming import duplicates_among, faults_of_condition, faults_of_parameters
from chronicles.printer import text_of
from chronicles.syntax import (
    Chronicle,
    Condition,
    ConstraintDeclaration,
    Inclusion,
    NamedConstraint,
    TemporalConstraint,
)
from dyknow.errors import ArityError, SpecificationError, UnknownNameError
from dyknow.source_text import nearest_name

__all__ = ["faults_of_comparison", "faults_of_constraint", "faults_of_use"]


def faults_of_use(
    use: NamedConstraint | Inclusion, declared: Declared
) -> Iterator[SpecificationError]:
    """Yield what is wrong with the use of a constraint or the inclusion of a chronicle."""
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
    inside = {name for statement in included.plain for name in instants_of(statement)}
    known = [*dict.fromkeys([*included.instants, *sorted(inside), START, END])]
    names = [*included.instants[:n_by_place], *(label for label in labels if label)]
    for name in dict.fromkeys(names):
        if name not in known:
            yield UnknownNameError("instant", name, use.span, nearest_name(name, known))
    yield from duplicates_among("instant", names, use.span)


def faults_of_constraint(
    constraint: ConstraintDeclaration, declared: Declared
) -> Iterator[SpecificationError]:
    """Yield what is wrong with a declared constraint."""
    yield from faults_of_parameters(constraint)
    yield from duplicates_among("instant", constraint.instants, constraint.span)
    variables = [parameter.name for parameter in constraint.parameters]
    for statement in constraint.plain:
        for name in dict.fromkeys(instants_of(statement)):
            if name not in constraint.instants and name not in declared.parameters:
                nearest = nearest_name(name, [*constraint.instants, *declared.parameters])
                yield UnknownNameError("instant", name, statement.span, nearest)
        match statement:
            case NamedConstraint():
                yield from faults_of_use(statement, declared)
            case _ if isinstance(statement, TemporalConstraint):
                yield from faults_of_comparison(statement)
            case _ if isinstance(statement, Condition):
                yield from faults_of_condition(statement, variables, declared)
            case _:
                pass


def faults_of_comparison(constraint: TemporalConstraint) -> Iterator[SpecificationError]:
    """Yield why a temporal constraint bounds nothing, if so."""
    try:
        bounds_of(constraint)
    except ValueError as error:
        yield ChronicleError(f"{error}, found '{text_of(constraint)}'", constraint.span)

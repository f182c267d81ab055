"""Faults of variables: which no event binds, and conditions that can never be asked."""

from collections.abc import Iterator

from chronicles.conditions import variables_in
from chronicles.errors import ChronicleError, UnboundVariableError
from chronicles.event_types import event_type_of
from chronicles.expansion import Expansion
from chronicles.naming import reserved_value
from chronicles.syntax import (
    VALUE_VARIABLE,
    Chronicle,
    Condition,
    EventAt,
    NoEvent,
    Occurs,
    Star,
    Variable,
    VariableDeclaration,
    names_in,
    stars_of,
    variables_of,
)
from dyknow.errors import SpecificationError
from dyknow.source_text import Span, nearest_name

__all__ = ["faults_of_stars", "faults_of_variables"]


def faults_of_variables(
    chronicle: Chronicle, expansion: Expansion
) -> Iterator[SpecificationError]:
    """Yield the variables of *chronicle* that no event of its *expansion* binds."""
    bound = {v.name for event in expansion.events for v in variables_of(event.event_type)}
    used: list[Variable | Star] = list(chronicle.parameters)
    for statement in chronicle.plain:
        if isinstance(statement, VariableDeclaration):
            used.extend(statement.variables)
    for statement in expansion.statements:
        used.extend(_variables_used_by(statement))
    told: set[Span] = set()
    for variable in used:
        is_ours = isinstance(variable, Variable) and "." not in variable.name
        if variable.name == VALUE_VARIABLE:
            yield reserved_value(variable)
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


def faults_of_stars(expansion: Expansion) -> Iterator[SpecificationError]:
    """Yield the conditions on star variables that no event type can be tested for."""
    types = [t for t in map(event_type_of, expansion.statements) if t is not None]
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

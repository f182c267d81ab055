"""Faults of names: declared twice, declared nowhere, or kept for something else."""

from collections.abc import Iterable, Iterator, Sequence

from chronicles.conditions import parts_of, references_of, variables_in
from chronicles.declared import Declared, Named
from chronicles.errors import ChronicleError
from chronicles.syntax import (
    VALUE_VARIABLE,
    Condition,
    Domain,
    DomainDeclaration,
    Membership,
    ParameterDeclaration,
    Star,
    Variable,
)
from dyknow.errors import DuplicateNameError, SpecificationError, UnknownNameError
from dyknow.source_text import Span, nearest_name

__all__ = [
    "duplicates_among",
    "faults_of_condition",
    "faults_of_domain",
    "faults_of_domains_in",
    "faults_of_names",
    "faults_of_parameters",
    "reserved_value",
]


def faults_of_names(
    kind: str, declarations: Iterable[ParameterDeclaration | DomainDeclaration | Named]
) -> Iterator[SpecificationError]:
    """Yield the declarations whose name another one of this *kind* has already."""
    first: dict[str, Span] = {}
    for declaration in declarations:
        name, span = declaration.name, declaration.span
        if name in first:
            yield DuplicateNameError(kind, name, span, first[name])
        first.setdefault(name, span)


def faults_of_parameters(node: Named) -> Iterator[SpecificationError]:
    """Yield the parameters of a declaration that stand there twice or cannot be one."""
    first: dict[str, Span] = {}
    for parameter in node.parameters:
        if parameter.name in first:
            yield DuplicateNameError(
                "parameter", parameter.name, parameter.span, first[parameter.name]
            )
        elif parameter.name == VALUE_VARIABLE:
            yield reserved_value(parameter)
        first.setdefault(parameter.name, parameter.span)


def reserved_value(variable: Variable | Star) -> ChronicleError:
    """Return the fault of a variable that is called like the value of an attribute."""
    message = f"'{VALUE_VARIABLE}' stands for the value of an attribute and is no parameter"
    return ChronicleError(message, variable.span)


def duplicates_among(kind: str, names: Sequence[str], span: Span) -> Iterator[SpecificationError]:
    """Yield each of the *names* that is there more than once."""
    for name in dict.fromkeys(name for name in names if names.count(name) > 1):
        yield DuplicateNameError(kind, name, span, span)


def faults_of_domain(domain: Domain, declared: Declared) -> Iterator[SpecificationError]:
    """Yield the unknown names in a domain."""
    for reference in references_of(domain):
        if reference.name not in declared.domains:
            nearest = nearest_name(reference.name, declared.domains)
            yield UnknownNameError("domain", reference.name, reference.span, nearest)


def faults_of_domains_in(condition: Condition, declared: Declared) -> Iterator[SpecificationError]:
    """Yield the unknown names in the domains of a condition."""
    for part in parts_of(condition):
        if isinstance(part, Membership):
            yield from faults_of_domain(part.domain, declared)


def faults_of_condition(
    condition: Condition, known: Sequence[str], declared: Declared
) -> Iterator[SpecificationError]:
    """Yield the unknown variables and domains of a condition on *known* variables."""
    for variable in variables_in(condition):
        if variable.name not in known:
            nearest = nearest_name(variable.name, known)
            yield UnknownNameError("parameter", variable.name, variable.span, nearest)
    yield from faults_of_domains_in(condition, declared)

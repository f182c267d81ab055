"""Which declarations somebody means, and who needs them."""

from collections.abc import Collection, Iterator, Sequence

from dyknow.errors import LabelInUseError, ServiceError
from dyknow.kpl.names import Declarations, Placed, Scope, descendants, labels_of
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    Configuration,
    Declaration,
    GeneratorDeclaration,
    Link,
    Name,
    ParameterDeclaration,
    Process,
    Provider,
    SourceDeclaration,
    SourceInstance,
    Specification,
    StreamDeclaration,
    UnitDeclaration,
    UnitInstance,
)
from dyknow.source_text import did_you_mean, nearest_name

__all__ = ["declarations_called", "forbid_use"]


def declarations_called(names: Sequence[str], specification: Specification) -> list[int]:
    """Return the places of the declarations that are called so, each as it begins or by name.

    Raises:
        ServiceError: There is no such declaration, or more than one.
    """
    beginnings = [_beginning(each) for each in specification.declarations]
    return sorted({_place_of(name, beginnings) for name in names})


def forbid_use(
    chosen: Collection[int], specification: Specification, bound: Specification
) -> None:
    """Raise an error if other declarations need those at the places *chosen*.

    What a mediation merges, or a member of a set may need, is needed by the declaration only if
    nothing else is left that it could be.

    Raises:
        LabelInUseError: They do; it names them.
    """
    declared = Declarations(bound)
    removed = {id(bound.declarations[at]): at for at in chosen}
    parameters = {
        each.name.text: at
        for at, each in enumerate(specification.declarations)
        if at in chosen and isinstance(each, ParameterDeclaration)
    }
    users: dict[int, list[str]] = {}
    for at, (written, declaration) in enumerate(
        zip(specification.declarations, bound.declarations, strict=True)
    ):
        if at in chosen:
            continue
        needed = {removed[key] for key in _needs(declaration, declared, set(removed))}
        words = {node.text for node in descendants(written) if isinstance(node, Name)}
        needed |= {place for name, place in parameters.items() if name in words}
        for place in needed:
            users.setdefault(place, []).append(_name(written))
    for place, names in sorted(users.items()):
        raise LabelInUseError(_name(specification.declarations[place]), names)


def _place_of(name: str, beginnings: Sequence[tuple[str, str]]) -> int:
    wanted = " ".join(name.split())
    found = [at for at, (kind, called) in enumerate(beginnings) if wanted == f"{kind} {called}"]
    found = found or [at for at, (_, called) in enumerate(beginnings) if wanted == called]
    if len(found) > 1:
        alternatives = ", ".join(f"'{' '.join(beginnings[at])}'" for at in found)
        raise ServiceError(f"'{name}' may be {alternatives}; expected one of them")
    if not found:
        known = [called for _, called in beginnings]
        hint = did_you_mean(nearest_name(name, [*known, *map(" ".join, beginnings)]))
        raise ServiceError(f"nothing is declared that is called '{name}'{hint}")
    return found[0]


def _beginning(declaration: Declaration) -> tuple[str, str]:
    match declaration:
        case SourceDeclaration(_, name):
            return "source", name.text
        case UnitDeclaration(_, name):
            return "compunit", name.text
        case GeneratorDeclaration(label):
            return "strmgen", label.text
        case StreamDeclaration(name):
            return "stream", name.text
        case ParameterDeclaration(name):
            return "parameter", name.text
        case Configuration(member, members):
            return "for each", f"{member.text} in {text_from(members)}"


def _name(declaration: Declaration) -> str:
    kind, name = _beginning(declaration)
    return f"{kind} {name}" if isinstance(declaration, Configuration) else name


def _needs(declaration: Declaration, declared: Declarations, removed: set[int]) -> set[int]:
    """Return what a declaration needs of *removed*; of a block, all that stands in it does."""
    found: set[int] = set()
    for each, scope in declared.scoped():
        if each is declaration or any(block is declaration for block in scope.blocks):
            for alternatives in _needs_of_one(each, scope, declared):
                if alternatives <= removed:
                    found |= alternatives
    return found


def _needs_of_one(each: Declaration, scope: Scope, declared: Declarations) -> Iterator[set[int]]:
    """Yield, for each name in a declaration, what it can mean: one of these is needed."""
    match each:
        case GeneratorDeclaration(_, process):
            yield from ({id(prototype)} for prototype in _prototypes(process, declared))
            yield from _needs_of_node(process, scope, declared)
        case StreamDeclaration(_, stream) | Configuration(_, stream):
            yield from _needs_of_node(stream.provider, scope, declared)
        case _:
            pass


def _needs_of_node(
    node: Process | Provider, scope: Scope, declared: Declarations
) -> Iterator[set[int]]:
    for label, place in labels_of(node, scope):
        if not place.is_merged(label):
            yield {id(_outermost(placed)) for placed in declared.meaning(label, place).all}


def _outermost(placed: Placed) -> Declaration:
    return placed.scope.blocks[0] if placed.scope.blocks else placed.declaration


def _prototypes(process: Process, declared: Declarations) -> Iterator[Declaration]:
    match process:
        case SourceInstance(name) if name.text in declared.sources:
            yield declared.sources[name.text]
        case UnitInstance(name) | Link(_, name) if name.text in declared.units:
            yield declared.units[name.text]
        case _:
            pass

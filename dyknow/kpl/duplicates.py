"""Names that are declared more than once.

Sources and computational units share one set of names; labels, streams and parameters have each
their own. Two labels are the same if they can be the same for some members of sets.
"""

from collections.abc import Iterator

from dyknow.errors import DuplicateNameError, SpecificationError
from dyknow.kpl.names import Declarations, Scope, may_be_one
from dyknow.kpl.syntax import (
    Configuration,
    Declaration,
    GeneratorDeclaration,
    Label,
    Mediation,
    ParameterDeclaration,
    SourceDeclaration,
    StreamDeclaration,
    UnitDeclaration,
)
from dyknow.source_text import Span

__all__ = ["duplicates", "unfit_member"]


def duplicates(declared: Declarations) -> Iterator[SpecificationError]:
    """Yield a fault for each declaration of a name that is taken."""
    symbols: dict[tuple[str, str], Span] = {}
    labels: dict[tuple[str, str, int], list[tuple[Label, Scope]]] = {}
    for declaration, scope in declared.scoped():
        match declaration:
            case GeneratorDeclaration(label) | StreamDeclaration(label):
                kind = _kind(declaration)
                key = kind, label.feature.text, len(label.objects)
                yield from _labels(kind, label, scope, labels.setdefault(key, []))
            case Configuration():
                yield from unfit_member(declaration, scope, declared)
            case _:
                name, kind = declaration.name, _kind(declaration)
                space = "parameter" if kind == "parameter" else "process"
                if (space, name.text) in symbols:
                    first = symbols[space, name.text]
                    yield DuplicateNameError(kind, name.text, name.span, first)
                symbols.setdefault((space, name.text), name.span)


def unfit_member(
    node: Configuration | Mediation, scope: Scope, declared: Declarations
) -> Iterator[SpecificationError]:
    """Yield a fault if the name of a member of a set, used in *scope*, is taken."""
    member = node.member
    for block in scope.blocks:
        if block.member.text == member.text:
            yield DuplicateNameError("member", member.text, member.span, block.member.span)
    if member.text in declared.parameters:
        first = declared.parameters[member.text].name.span
        yield DuplicateNameError("parameter", member.text, member.span, first)


def _labels(
    kind: str, label: Label, scope: Scope, before: list[tuple[Label, Scope]]
) -> Iterator[SpecificationError]:
    for other, place in before:
        if may_be_one(label, scope.members, other, place.members):
            yield DuplicateNameError(kind, label.text, label.span, other.span)
            break
    before.append((label, scope))


def _kind(declaration: Declaration) -> str:
    match declaration:
        case SourceDeclaration():
            return "source"
        case UnitDeclaration():
            return "computational unit"
        case GeneratorDeclaration():
            return "stream generator"
        case StreamDeclaration():
            return "stream"
        case ParameterDeclaration():
            return "parameter"
        case Configuration():
            return "block"

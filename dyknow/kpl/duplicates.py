"""Names that are declared more than once.

Sources and computational units share one set of names; labels, streams and parameters have each
their own. Two labels with members of sets in them are the same if they are so for every member;
whether some members make them the same is known only when the network runs.
"""

from collections.abc import Iterator

from dyknow.errors import DuplicateNameError, SpecificationError
from dyknow.kpl.names import Declarations, Scope
from dyknow.kpl.printer import text_from
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
    labels: dict[tuple[str, str], Label] = {}
    for declaration, scope in declared.scoped():
        match declaration:
            case GeneratorDeclaration(label) | StreamDeclaration(label):
                key = _kind(declaration), _text_in(label, scope)
                if key in labels:
                    first = labels[key].span
                    yield DuplicateNameError(key[0], label.text, label.span, first)
                labels.setdefault(key, label)
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


def _text_in(label: Label, scope: Scope) -> str:
    """Return a label with the set of which a member is in the place of its name."""
    sets = {block.member.text: f"each {text_from(block.members)}" for block in scope.blocks}
    objects = ", ".join(sets.get(each.text, each.text) for each in label.objects)
    return f"{label.feature.text}[{objects}]"


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

"""What the declarations before a formula say: its vocabulary and its domains."""

from collections.abc import Iterator, Mapping

from dyknow.errors import (
    DuplicateNameError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.mtl import check
from dyknow.mtl.check import BOOLEAN, NUMBER, TEXT, FeatureSignature, Vocabulary
from dyknow.mtl.parser import parse_document
from dyknow.mtl.quantifiers import Domains
from dyknow.mtl.syntax import (
    Document,
    FeatureDeclaration,
    Name,
    ObjectDeclaration,
    SortDeclaration,
)
from dyknow.source_text import Span, nearest_name

__all__ = ["document_faults", "domains_of", "read_document", "vocabulary_of"]

_VALUES = (BOOLEAN, NUMBER, TEXT)


def read_document(text: str, source_name: str = "<formula>") -> Document:
    """Read a formula with declarations and find every fault of both.

    Raises:
        FormulaSyntaxError: The text does not follow the grammar.
        SpecificationErrors: Every other fault, at once.
    """
    document = parse_document(text, source_name)
    found = document_faults(document)
    if found:
        raise SpecificationErrors(f"{len(found)} fault(s) in a formula", found)
    return document


def document_faults(document: Document) -> list[SpecificationError]:
    """Return the faults of the declarations and of the formula, in reading order.

    Names in the formula are looked at if there are declarations; without any they are free.
    """
    found = [*_duplicates(document), *_unknown_sorts(document)]
    found += check.faults(document.formula, vocabulary_of(document))
    return sorted(found, key=lambda fault: fault.span.start)


def vocabulary_of(document: Document) -> Vocabulary | None:
    """Return the names that the formula may use, or None if nothing is declared."""
    if not document.declarations:
        return None
    features: dict[str, FeatureSignature] = {}
    names: dict[str, str] = {}
    domains: dict[str, str] = {}
    for declaration in document.declarations:
        match declaration:
            case SortDeclaration(name, objects):
                domains[name.name] = name.name
                names |= {each.name: name.name for each in objects}
            case ObjectDeclaration(objects, sort):
                names |= {each.name: sort.name for each in objects}
            case FeatureDeclaration(name, parameters, sort):
                sorts = tuple(parameter.name for parameter in parameters)
                features[name.name] = FeatureSignature(sorts, sort.name)
    return Vocabulary(features, names, domains)


def domains_of(document: Document) -> Domains:
    """Return the objects of each sort that is declared with its objects."""
    return {
        declaration.name.name: tuple(each.name for each in declaration.objects)
        for declaration in document.declarations
        if isinstance(declaration, SortDeclaration) and declaration.objects
    }


def _duplicates(document: Document) -> Iterator[SpecificationError]:
    seen: dict[tuple[str, str], Span] = {}
    for kind, name in _declared(document):
        first = seen.setdefault((kind, name.name), name.span)
        if first is not name.span:
            yield DuplicateNameError(kind, name.name, name.span, first)


def _declared(document: Document) -> Iterator[tuple[str, Name]]:
    """Yield each name that is declared, and what it is called in messages."""
    for declaration in document.declarations:
        match declaration:
            case SortDeclaration(name, objects):
                yield "sort", name
                yield from (("object", each) for each in objects)
            case ObjectDeclaration(objects):
                yield from (("object", each) for each in objects)
            case FeatureDeclaration(name):
                yield "feature", name


def _unknown_sorts(document: Document) -> Iterator[SpecificationError]:
    sorts = dict.fromkeys((*_VALUES, *(n.name for k, n in _declared(document) if k == "sort")))
    for declaration in document.declarations:
        match declaration:
            case ObjectDeclaration(_, sort):
                yield from _unknown([sort], sorts)
            case FeatureDeclaration(_, parameters, sort):
                yield from _unknown([*parameters, sort], sorts)
            case SortDeclaration():
                pass


def _unknown(names: list[Name], sorts: Mapping[str, None]) -> Iterator[SpecificationError]:
    for name in names:
        if name.name not in sorts:
            yield UnknownNameError("sort", name.name, name.span, nearest_name(name.name, sorts))

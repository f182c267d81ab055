"""What is asked about states: a formula, over given domains, and the features that it needs."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from dyknow.errors import (
    SortMismatchError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.mtl import syntax
from dyknow.mtl.check import BOOLEAN, NUMBER, TEXT, Vocabulary
from dyknow.mtl.declarations import document_faults, domains_of, vocabulary_of
from dyknow.mtl.parser import parse_document
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.quantifiers import Domains, expand
from dyknow.mtl.syntax import Feature, Formula, Node, descendants, parts
from dyknow.source_text import Span, did_you_mean, nearest_name
from traffic.errors import RequestError

__all__ = ["Question", "domains_from", "forbid_missing", "read_question"]

_ENDING = ".mtl"
_LONGEST_NAME = 4096
_VALUES = frozenset({BOOLEAN, NUMBER, TEXT})


@dataclass(frozen=True)
class Question:
    """A formula without quantifiers, ready to be asked about states.

    Attributes:
        formula: The formula.
        sorts: Printed term of each feature in it to its sort, or None if it is not declared and
            the formula only compares it with other features.
        places: Printed term of each feature to where it is written first.
    """

    formula: Formula
    sorts: Mapping[str, str | None]
    places: Mapping[str, Span]


def read_question(text: str, domains: Domains) -> Question:
    """Read a formula, or the file of a formula, and write its quantifiers out.

    There may be declarations before the formula (`dyknow.mtl.declarations`).

    Raises:
        FormulaSyntaxError: The text is not a formula.
        SpecificationErrors: Every other fault of the formula.
        RequestError: A domain is given that the formula does not speak of, or the file cannot be
            read.
    """
    name = "<formula>"
    path = _file_of(text)
    if path is not None:
        name = str(path)
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            raise RequestError("FORMULA", "a text in UTF-8", path) from None
    document = parse_document(text, name)
    formula, vocabulary = document.formula, vocabulary_of(document)
    declared = domains_of(document)
    known = {**declared, **domains}
    _raise_if_any([*document_faults(document), *_unknown_domains(formula, known, vocabulary)])
    _forbid_without_effect(domains, formula, declared)
    ground = expand(formula, known)
    return Question(ground, *_features_of(ground, vocabulary))


def domains_from(texts: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return the domains that are written as `car=car1,car2`.

    Raises:
        RequestError: One of them is not of this form, is empty, or names something twice.
    """
    domains: dict[str, tuple[str, ...]] = {}
    for text in texts:
        name, sign, members = text.partition("=")
        objects = tuple(member.strip() for member in members.split(","))
        if not sign or not name.strip():
            raise RequestError("--domain", "a domain such as 'car=car1,car2'", text)
        if not all(objects):
            raise RequestError("--domain", f"names of objects after '{name}='", text)
        if len(set(objects)) < len(objects):
            raise RequestError("--domain", "each object once", text)
        if name.strip() in domains:
            raise RequestError("--domain", f"the domain '{name.strip()}' once", text)
        domains[name.strip()] = objects
    return domains


def forbid_missing(question: Question, terms: Collection[str], place: str) -> None:
    """Raise every place of the formula whose feature is not among those of a state.

    Args:
        question: What is asked.
        terms: The features of the state, as they are printed.
        place: Where the state is.

    Raises:
        SpecificationErrors: There is at least one.
    """
    missing: dict[Span, SpecificationError] = {}
    for term in question.sorts.keys() - set(terms):
        hint = did_you_mean(nearest_name(term, terms))
        span = question.places[term]
        message = f"the state at {place} has no feature '{term}'{hint}"
        missing.setdefault(span, SpecificationError(message, span))
    _raise_if_any(list(missing.values()))


def _file_of(text: str) -> Path | None:
    """Return the path that *text* is, if it is the name of a formula's file."""
    if len(text) > _LONGEST_NAME or "\n" in text or "\0" in text:
        return None
    path = Path(text)
    try:
        is_file = path.is_file()
    except OSError:
        return None  # no name that a file could have
    return path if is_file or path.suffix == _ENDING else None


def _raise_if_any(found: Sequence[SpecificationError]) -> None:
    if found:
        ordered = sorted(found, key=lambda fault: fault.span.start)
        raise SpecificationErrors(f"{len(found)} fault(s) in a formula", ordered)


def _quantified(formula: Formula) -> Iterator[syntax.Name]:
    for node, _ in descendants(formula):
        if isinstance(node, syntax.ForAll | syntax.Exists):
            yield node.domain


def _unknown_domains(
    formula: Formula, known: Domains, vocabulary: Vocabulary | None
) -> Iterator[SpecificationError]:
    """Yield the domains without objects; a sort that is not declared is a fault already."""
    for domain in _quantified(formula):
        is_declared = vocabulary is None or domain.name in vocabulary.domains
        if is_declared and domain.name not in known:
            nearest = nearest_name(domain.name, known)
            yield UnknownNameError("domain", domain.name, domain.span, nearest)


def _forbid_without_effect(domains: Domains, formula: Formula, declared: Domains) -> None:
    used = {domain.name for domain in _quantified(formula)}
    for name in domains:
        if name not in used:
            known = f"one of {', '.join(sorted(used))}" if used else "none: there is no quantifier"
            raise RequestError("--domain", f"a domain of the formula ({known})", name)
        if name in declared:
            raise RequestError("--domain", "a domain without declared objects", name)


def _features_of(
    formula: Formula, vocabulary: Vocabulary | None
) -> tuple[Mapping[str, str | None], Mapping[str, Span]]:
    """Return the sort and the place of each feature.

    Raises:
        SpecificationErrors: A feature is used as if it had two sorts.
    """
    sorts: dict[str, str | None] = {}
    places: dict[str, Span] = {}
    found: dict[Span, SpecificationError] = {}
    for feature, sort in _uses(formula):
        term = text_from_formula(feature)
        places.setdefault(term, feature.span)
        known = sorts.setdefault(term, sort)
        if known is None:
            sorts[term] = sort
        elif sort is not None and sort != known:
            fault = SortMismatchError(f"'{term}'", known, sort, feature.span)
            found.setdefault(feature.span, fault)
        if sorts[term] is None and vocabulary is not None:
            declared = vocabulary.features[feature.name].sort
            sorts[term] = declared if declared in _VALUES else TEXT
    _raise_if_any(list(found.values()))
    return sorts, places


def _uses(formula: Formula) -> Iterator[tuple[Feature, str | None]]:
    """Yield each feature with the sort that its place asks for."""
    if isinstance(formula, Feature):
        yield formula, BOOLEAN
    for node, _ in descendants(formula):
        for part in parts(node):
            if isinstance(part, Feature):
                yield part, _sort_wanted(node, part)


def _sort_wanted(node: Node, part: Node) -> str | None:
    match node:
        case syntax.Comparison(left, operator, right):
            other = right if part is left else left
            return NUMBER if operator not in {"=", "!="} else _sort_of(other)
        case syntax.Arithmetic() | syntax.Minus():
            return NUMBER
        case _:
            return BOOLEAN


def _sort_of(term: Node) -> str | None:
    match term:
        case syntax.Truth():
            return BOOLEAN
        case syntax.Number() | syntax.Arithmetic() | syntax.Minus():
            return NUMBER
        case syntax.Text():
            return TEXT
        case _:
            return None

"""Find every fault of a formula that can be seen without running it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from dyknow.errors import (
    ArityError,
    DuplicateNameError,
    SortMismatchError,
    SpecificationError,
    SpecificationErrors,
    UnknownNameError,
)
from dyknow.mtl import syntax
from dyknow.mtl.printer import text_from_formula, text_from_interval
from dyknow.mtl.syntax import Formula, Interval, Name, Node, Term, parts
from dyknow.source_text import nearest_name

__all__ = ["BOOLEAN", "NUMBER", "TEXT", "FeatureSignature", "Vocabulary", "check", "faults"]

BOOLEAN, NUMBER, TEXT = "boolean", "number", "text"
_ORDERED = frozenset({"<", "<=", ">", ">="})


@dataclass(frozen=True, slots=True)
class FeatureSignature:
    """What a feature takes and what it is.

    Attributes:
        parameters: The sort of each argument.
        sort: The sort of the value: `boolean`, `number`, `text`, or a sort of objects.
    """

    parameters: tuple[str, ...] = ()
    sort: str = BOOLEAN


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The names that a formula may use.

    Attributes:
        features: Name of a feature to its signature.
        names: Name of an object or a free variable, such as `from`, to its sort.
        domains: Name of a domain of quantification to the sort of its members.
    """

    features: Mapping[str, FeatureSignature]
    names: Mapping[str, str] = field(default_factory=dict)
    domains: Mapping[str, str] = field(default_factory=dict)


def check(formula: Formula, vocabulary: Vocabulary | None = None) -> None:
    """Raise every fault of *formula* at once.

    Raises:
        SpecificationErrors: There is at least one fault.
    """
    found = faults(formula, vocabulary)
    if found:
        raise SpecificationErrors(f"{len(found)} fault(s) in a formula", found)


def faults(formula: Formula, vocabulary: Vocabulary | None = None) -> list[SpecificationError]:
    """Return the faults of *formula* in reading order.

    Intervals, divisions by zero, repeated variables and the sorts of constants are always
    looked at; names, numbers of arguments and the sorts of features only with a *vocabulary*. That
    a formula is nested too deep is its only fault then.
    """
    deep = syntax.too_deep(formula)
    if deep is not None:
        return [SpecificationError(syntax.TOO_DEEP, deep.span)]
    checker = _Checker(vocabulary)
    found = [*checker.boolean_faults(formula, {}), *checker.faults(formula, {})]
    return sorted(found, key=lambda fault: fault.span.start)


_Scope = Mapping[str, Name]


class _Checker:
    """The walk over a formula; a scope holds the bound variables and where they are bound."""

    def __init__(self, vocabulary: Vocabulary | None) -> None:
        self._vocabulary = vocabulary

    def faults(self, node: Node, scope: _Scope) -> Iterator[SpecificationError]:
        """Yield the faults of a formula or a term."""
        match node:
            case syntax.Always(within) | syntax.Eventually(within) | syntax.Until(within):
                yield from _interval_faults(within)
            case syntax.ForAll(variable, domain, body) | syntax.Exists(variable, domain, body):
                yield from self._quantifier_faults(variable, domain, scope)
                yield from self.faults(body, {**scope, variable.name: domain})
                return
            case syntax.Comparison():
                yield from self._comparison_faults(node, scope)
            case syntax.Arithmetic():
                yield from self._arithmetic_faults(node, scope)
            case syntax.Feature():
                yield from self._feature_faults(node, scope)
            case _:
                pass
        yield from self._operand_faults(node, scope)
        for part in parts(node):
            yield from self.faults(part, scope)

    def _quantifier_faults(
        self, variable: Name, domain: Name, scope: _Scope
    ) -> Iterator[SpecificationError]:
        if variable.name in scope:
            first = scope[variable.name].span
            yield DuplicateNameError("variable", variable.name, variable.span, first)
        if self._vocabulary is not None and domain.name not in self._vocabulary.domains:
            yield _unknown("domain", domain, self._vocabulary.domains)

    def _operand_faults(self, node: Node, scope: _Scope) -> Iterator[SpecificationError]:
        """Yield the features that stand for a formula but are not boolean."""
        if isinstance(node, syntax.Comparison | syntax.Arithmetic | syntax.Minus):
            return
        for part in parts(node):
            yield from self.boolean_faults(part, scope)

    def boolean_faults(self, node: Node, scope: _Scope) -> Iterator[SpecificationError]:
        """Yield a fault if *node* is a feature that is not boolean."""
        if isinstance(node, syntax.Feature):
            sort = self._sort(node, scope)
            if sort not in {None, BOOLEAN}:
                what = f"'{text_from_formula(node)}'"
                yield SortMismatchError(what, BOOLEAN, sort or "", node.span)

    def _comparison_faults(
        self, node: syntax.Comparison, scope: _Scope
    ) -> Iterator[SpecificationError]:
        left, right = self._sort(node.left, scope), self._sort(node.right, scope)
        if node.operator in _ORDERED:
            yield from self._number_faults(node.left, node.operator, scope)
            yield from self._number_faults(node.right, node.operator, scope)
        elif left is not None and right is not None and left != right:
            what = f"the right side of '{node.operator}'"
            yield SortMismatchError(what, left, right, node.right.span)

    def _arithmetic_faults(
        self, node: syntax.Arithmetic, scope: _Scope
    ) -> Iterator[SpecificationError]:
        yield from self._number_faults(node.left, node.operator, scope)
        yield from self._number_faults(node.right, node.operator, scope)
        if node.operator == "/" and node.right == syntax.Number(0.0):
            yield SpecificationError("expected a divisor other than 0, found '0'", node.right.span)

    def _number_faults(
        self, node: Term, operator: str, scope: _Scope
    ) -> Iterator[SpecificationError]:
        sort = self._sort(node, scope)
        if sort not in {None, NUMBER}:
            yield SortMismatchError(f"a side of '{operator}'", NUMBER, sort or "", node.span)

    def _feature_faults(self, node: syntax.Feature, scope: _Scope) -> Iterator[SpecificationError]:
        known = self._vocabulary
        if known is None or (not node.arguments and self._is_name(node.name, scope)):
            return
        signature = known.features.get(node.name)
        if signature is None:
            yield _unknown("feature", Name(node.name, span=node.span), known.features)
            yield from self._variable_faults(node, scope)
            return
        if len(node.arguments) != len(signature.parameters):
            expected, found = len(signature.parameters), len(node.arguments)
            yield ArityError(node.name, expected, found, node.span)
        yield from self._variable_faults(node, scope)
        yield from self._argument_faults(node, signature, scope)

    def _variable_faults(
        self, node: syntax.Feature, scope: _Scope
    ) -> Iterator[SpecificationError]:
        known = self._vocabulary
        for argument in node.arguments:
            if isinstance(argument, Name) and known and not self._is_name(argument.name, scope):
                yield _unknown("variable or object", argument, {**known.names, **scope})

    def _argument_faults(
        self, node: syntax.Feature, signature: FeatureSignature, scope: _Scope
    ) -> Iterator[SpecificationError]:
        for argument, sort in zip(node.arguments, signature.parameters, strict=False):
            found = self._sort(argument, scope)
            if found not in {None, sort}:
                what = f"an argument of '{node.name}'"
                yield SortMismatchError(what, sort, found or "", argument.span)

    def _is_name(self, name: str, scope: _Scope) -> bool:
        return name in scope or (self._vocabulary is not None and name in self._vocabulary.names)

    def _sort(self, node: Node | Name, scope: _Scope) -> str | None:
        """Return the sort of a term or an argument, or None if it cannot be known."""
        match node:
            case syntax.Number() | syntax.Arithmetic() | syntax.Minus():
                return NUMBER
            case syntax.Text():
                return TEXT
            case syntax.Name(name) | syntax.Feature(name, ()) if self._is_name(name, scope):
                return self._sort_of_name(name, scope)
            case syntax.Feature(name) if self._vocabulary and name in self._vocabulary.features:
                return self._vocabulary.features[name].sort
            case syntax.Feature() | syntax.Name():
                return None
            case _:
                return BOOLEAN

    def _sort_of_name(self, name: str, scope: _Scope) -> str | None:
        if self._vocabulary is None:
            return None
        if name in scope:
            return self._vocabulary.domains.get(scope[name].name)
        return self._vocabulary.names[name]


def _interval_faults(within: Interval) -> Iterator[SpecificationError]:
    if within.start < 0:
        message = f"expected an interval from 0 on, found {text_from_interval(within)}"
        yield SpecificationError(message, within.span)
    if within.end is not None and within.end < within.start:
        message = (
            f"expected an interval that ends after it begins, found {text_from_interval(within)}"
        )
        yield SpecificationError(message, within.span)


def _unknown(kind: str, name: Name, known: Mapping[str, object]) -> UnknownNameError:
    return UnknownNameError(kind, name.name, name.span, nearest_name(name.name, known))

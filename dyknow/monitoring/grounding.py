"""From a formula as it is written to one for which streams have to be found.

Quantifiers are written out over their domains, and what constants and objects alone decide is
decided: of `forall x in UAV (x != uav1 -> always XYDist[x, uav1] > 10)` nothing is left for `uav1`
itself, and so no stream has to say how far it is from itself. By the strong three-valued logic of
`dyknow.mtl.semantics` this changes neither verdicts nor when they come.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from dyknow.monitoring.interpretation import Constant, Interpretation
from dyknow.mtl import syntax
from dyknow.mtl.check import check
from dyknow.mtl.columns import AtomColumns
from dyknow.mtl.quantifiers import expand
from dyknow.mtl.symbols import extract_symbols
from dyknow.mtl.syntax import FALSE, TRUE, Atom, Feature, Formula, Truth

__all__ = ["constants_in", "grounded"]


def grounded(formula: Formula, interpretation: Interpretation) -> Formula:
    """Return *formula* without quantifiers and without what no stream is needed for.

    Raises:
        FeatureError: Constants are compared that cannot be.
        SpecificationErrors: The formula has faults.
        UnknownNameError: A quantifier ranges over a domain that is not given.
    """
    check(formula)
    ground = expand(formula, interpretation.domains)
    return _simplified(ground, constants_in([ground], interpretation))


def constants_in(
    formulas: Iterable[Formula], interpretation: Interpretation
) -> dict[str, Constant]:
    """Return the names in formulas that stand for constants or objects, and what these are."""
    found: dict[str, Constant] = {}
    for feature in extract_symbols(formulas).features:
        constant = None if feature.arguments else interpretation.constant(feature.name)
        if constant is not None:
            found[feature.name] = constant
    return found


def _simplified(formula: Formula, constants: Mapping[str, Constant]) -> Formula:  # noqa: C901, PLR0911, PLR0912
    def inner(body: Formula) -> Formula:
        return _simplified(body, constants)

    match formula:
        case syntax.Truth() | syntax.ForAll() | syntax.Exists():
            return formula
        case syntax.Feature() | syntax.Comparison():
            return _atom(formula, constants)
        case syntax.Negation(body):
            return _negated(inner(body))
        case syntax.Conjunction(bodies):
            return _joined(syntax.Conjunction, tuple(map(inner, bodies)), FALSE)
        case syntax.Disjunction(bodies):
            return _joined(syntax.Disjunction, tuple(map(inner, bodies)), TRUE)
        case syntax.Implication(left, right):
            return _implied(inner(left), inner(right))
        case syntax.Equivalence(left, right):
            return _equal(inner(left), inner(right))
        case syntax.Always(_, body) | syntax.Eventually(_, body):
            return replace(formula, body=inner(body))
        case syntax.Until(_, left, right):
            return replace(formula, left=inner(left), right=inner(right))


def _atom(atom: Atom, constants: Mapping[str, Constant]) -> Formula:
    """Return an atom, or its truth if it depends on nothing but constants."""
    features = extract_symbols([atom]).features
    if not all(_is_constant(each, constants) for each in features):
        return atom
    return TRUE if AtomColumns((atom,)).of_state(constants) else FALSE


def _is_constant(feature: Feature, constants: Mapping[str, Constant]) -> bool:
    return not feature.arguments and feature.name in constants


def _negated(body: Formula) -> Formula:
    match body:
        case Truth(value):
            return FALSE if value else TRUE
        case syntax.Negation(twice):
            return twice
        case _:
            return syntax.Negation(body)


def _joined(
    kind: type[syntax.Conjunction | syntax.Disjunction],
    bodies: tuple[Formula, ...],
    deciding: Truth,
) -> Formula:
    """Return `and` or `or` between formulas, of which one that is *deciding* decides the whole."""
    if deciding in bodies:
        return deciding
    left = tuple(body for body in bodies if not isinstance(body, Truth))
    match left:
        case ():
            return _negated(deciding)
        case (only,):
            return only
        case _:
            return kind(left)


def _implied(left: Formula, right: Formula) -> Formula:
    if isinstance(left, Truth):
        return right if left.value else TRUE
    if isinstance(right, Truth):
        return TRUE if right.value else _negated(left)
    return syntax.Implication(left, right)


def _equal(left: Formula, right: Formula) -> Formula:
    for one, other in ((left, right), (right, left)):
        if isinstance(one, Truth):
            return other if one.value else _negated(other)
    return syntax.Equivalence(left, right)

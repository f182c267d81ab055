"""Names in formulas and what they stand for: parameters, and the variables of quantifiers.

Quantifiers range over fixed domains and are written out as conjunctions and disjunctions.

The domain of a quantifier is fixed when a formula begins to be monitored (Heintz, Kvarnström and
Doherty 2010, on stream reasoning in ROS), as in lines 6 to 9 of the progression algorithm of
Heintz (2009), definition 7.5.3.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from dyknow.errors import UnknownNameError
from dyknow.mtl import syntax
from dyknow.mtl.printer import text_from_formula
from dyknow.mtl.syntax import Argument, Feature, Formula, Minus, Name, Term
from dyknow.source_text import nearest_name

__all__ = ["Domains", "Stand", "bind", "bound_feature", "expand"]

Domains = Mapping[str, Sequence[str]]
"""Name of a domain to its objects."""

Stand = Argument | Minus
"""What a parameter can stand for: an object, a number, or a text."""


def expand(formula: Formula, domains: Domains) -> Formula:
    """Return *formula* without quantifiers.

    `forall` over an empty domain is true, `exists` false. Where a bound variable stands alone,
    the object's name takes its place as a text.

    Raises:
        UnknownNameError: A quantifier ranges over a domain that is not given.
    """
    return _expand(formula, domains, {})


def bind(formula: Formula, binding: Mapping[str, Stand | Feature]) -> Formula:
    """Return *formula* with parameters replaced by what they stand for.

    Args:
        formula: The formula; its quantifiers stay, and their variables hide parameters.
        binding: The object, number or text that each parameter stands for; where an object's
            parameter stands alone, its name takes its place as a text. A feature takes the place
            of a name that is used as a feature without arguments.

    Raises:
        ValueError: A negative number would become an argument of a feature.
    """
    return _expand(formula, None, binding)


_Binding = Mapping[str, Stand | Feature]


def _expand(  # noqa: C901, PLR0911, PLR0912
    node: Formula, domains: Domains | None, binding: _Binding
) -> Formula:
    def inner(body: Formula) -> Formula:
        return _expand(body, domains, binding)

    match node:
        case syntax.Truth():
            return node
        case syntax.Feature():
            return bound_feature(node, binding)
        case syntax.Comparison(left, _, right):
            return replace(node, left=_term(left, binding), right=_term(right, binding))
        case syntax.Conjunction(bodies) | syntax.Disjunction(bodies):
            return replace(node, bodies=tuple(map(inner, bodies)))
        case syntax.Negation(body) | syntax.Always(_, body) | syntax.Eventually(_, body):
            return replace(node, body=inner(body))
        case syntax.Implication(left, right) | syntax.Equivalence(left, right):
            return replace(node, left=inner(left), right=inner(right))
        case syntax.Until(_, left, right):
            return replace(node, left=inner(left), right=inner(right))
        case syntax.ForAll(variable) | syntax.Exists(variable) if domains is None:
            rest = {name: known for name, known in binding.items() if name != variable.name}
            return replace(node, body=_expand(node.body, None, rest))
        case syntax.ForAll():
            instances = _instances(node, domains, binding)
            return _joined(syntax.Conjunction, instances, syntax.TRUE)
        case syntax.Exists():
            instances = _instances(node, domains, binding)
            return _joined(syntax.Disjunction, instances, syntax.FALSE)


def _instances(
    node: syntax.ForAll | syntax.Exists, domains: Domains | None, binding: _Binding
) -> tuple[Formula, ...]:
    domain, domains = node.domain, domains or {}
    if domain.name not in domains:
        nearest = nearest_name(domain.name, domains)
        raise UnknownNameError("domain", domain.name, domain.span, nearest)
    name = node.variable.name
    objects = [Name(o) for o in domains[domain.name]]
    return tuple(_expand(node.body, domains, {**binding, name: o}) for o in objects)


def _joined(
    kind: type[syntax.Conjunction | syntax.Disjunction],
    instances: tuple[Formula, ...],
    empty: Formula,
) -> Formula:
    match instances:
        case ():
            return empty
        case (only,):
            return only
        case _:
            return kind(instances)


def bound_feature(feature: Feature, binding: _Binding) -> Feature:
    """Return *feature* with parameters replaced as by `bind`."""
    known = None if feature.arguments else binding.get(feature.name)
    if isinstance(known, Feature):
        return replace(known, span=feature.span)
    arguments = tuple(_argument(argument, binding) for argument in feature.arguments)
    return replace(feature, arguments=arguments)


def _argument(argument: Argument, binding: _Binding) -> Argument:
    known = binding.get(argument.name) if isinstance(argument, Name) else None
    match known:
        case None | Feature():
            return argument
        case Minus():
            text = text_from_formula(known)
            raise ValueError(f"expected no negative number as an argument, found {text}")
        case _:
            return known


def _term(term: Term, binding: _Binding) -> Term:
    match term:
        case Feature(name, ()) if name in binding:
            known = binding[name]
            return syntax.Text(known.name, span=term.span) if isinstance(known, Name) else known
        case Feature():
            return bound_feature(term, binding)
        case syntax.Arithmetic(left, _, right):
            return replace(term, left=_term(left, binding), right=_term(right, binding))
        case syntax.Minus(body):
            return replace(term, body=_term(body, binding))
        case syntax.Truth() | syntax.Number() | syntax.Text():
            return term

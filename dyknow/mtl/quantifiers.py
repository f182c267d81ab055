"""Quantifiers over fixed domains, written out as conjunctions and disjunctions.

The domain of a quantifier is fixed when a formula begins to be monitored (Heintz, Kvarnström and
Doherty 2010, on stream reasoning in ROS), as in lines 6 to 9 of the progression algorithm of
Heintz (2009), definition 7.5.3.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from dyknow.errors import UnknownNameError
from dyknow.mtl import syntax
from dyknow.mtl.syntax import Argument, Formula, Name, Term
from dyknow.source_text import nearest_name

__all__ = ["Domains", "expand"]

Domains = Mapping[str, Sequence[str]]
"""Name of a domain to its objects."""


def expand(formula: Formula, domains: Domains) -> Formula:
    """Return *formula* without quantifiers.

    `forall` over an empty domain is true, `exists` false. Where a bound variable stands alone,
    the object's name takes its place as a text.

    Raises:
        UnknownNameError: A quantifier ranges over a domain that is not given.
    """
    return _expand(formula, domains, {})


_Binding = Mapping[str, str]


def _expand(node: Formula, domains: Domains, binding: _Binding) -> Formula:  # noqa: C901, PLR0911, PLR0912
    def inner(body: Formula) -> Formula:
        return _expand(body, domains, binding)

    match node:
        case syntax.Truth():
            return node
        case syntax.Feature():
            return replace(node, arguments=_arguments(node.arguments, binding))
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
        case syntax.ForAll():
            instances = _instances(node, domains, binding)
            return _joined(syntax.Conjunction, instances, syntax.TRUE)
        case syntax.Exists():
            instances = _instances(node, domains, binding)
            return _joined(syntax.Disjunction, instances, syntax.FALSE)


def _instances(
    node: syntax.ForAll | syntax.Exists, domains: Domains, binding: _Binding
) -> tuple[Formula, ...]:
    domain = node.domain
    if domain.name not in domains:
        nearest = nearest_name(domain.name, domains)
        raise UnknownNameError("domain", domain.name, domain.span, nearest)
    name = node.variable.name
    return tuple(_expand(node.body, domains, {**binding, name: o}) for o in domains[domain.name])


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


def _arguments(arguments: tuple[Argument, ...], binding: _Binding) -> tuple[Argument, ...]:
    return tuple(
        replace(a, name=binding.get(a.name, a.name)) if isinstance(a, Name) else a
        for a in arguments
    )


def _term(term: Term, binding: _Binding) -> Term:
    match term:
        case syntax.Feature(name, ()) if name in binding:
            return syntax.Text(binding[name], span=term.span)
        case syntax.Feature(_, arguments):
            return replace(term, arguments=_arguments(arguments, binding))
        case syntax.Arithmetic(left, _, right):
            return replace(term, left=_term(left, binding), right=_term(right, binding))
        case syntax.Minus(body):
            return replace(term, body=_term(body, binding))
        case syntax.Truth() | syntax.Number() | syntax.Text():
            return term

"""From the syntax of a formula to its text; the inverse of the parser.

Parentheses are printed only where the text would otherwise be read differently, except around
the sides of `->` and `<->`, where people disagree about what binds tighter.
"""

import json
from functools import singledispatch

from dyknow.mtl import syntax
from dyknow.mtl.syntax import Declaration, Document, Interval, Node
from dyknow.time import text_from_duration

__all__ = ["text_from_document", "text_from_formula", "text_from_interval"]

_LOOSEST, _IMPLICATION, _OR, _AND, _UNTIL, _PREFIX, _SUM, _PRODUCT, _MINUS, _TIGHTEST = range(10)
_PRINTED_IN_FULL = 1e15


def text_from_formula(node: Node | syntax.Name) -> str:
    """Write a formula, a term or an argument in the form that `parse_formula` reads."""
    return _text(node)


def text_from_document(document: Document) -> str:
    """Write declarations and a formula in the form that `parse_document` reads."""
    lines = [_declared(declaration) for declaration in document.declarations]
    return "\n".join([*lines, text_from_formula(document.formula)])


def text_from_interval(interval: Interval) -> str:
    """Write an interval, such as `[0, 1000]` or `[200, oo]`, in milliseconds."""
    end = "oo" if interval.end is None else text_from_duration(interval.end)
    return f"[{text_from_duration(interval.start)}, {end}]"


def _declared(declaration: Declaration) -> str:
    match declaration:
        case syntax.SortDeclaration(name, objects):
            return f"sort {name.name}" + (f" = {_listed(objects)}" if objects else "")
        case syntax.ObjectDeclaration(names, sort):
            return f"object {_listed(names)}: {sort.name}"
        case syntax.FeatureDeclaration(name, parameters, sort):
            arguments = f"({_listed(parameters)})" if parameters else ""
            return f"feature {name.name}{arguments}: {sort.name}"


def _listed(names: tuple[syntax.Name, ...]) -> str:
    return ", ".join(name.name for name in names)


@singledispatch
def _text(node: Node | syntax.Name) -> str:
    raise TypeError(f"not a formula: {node!r}")


@_text.register
def _(node: syntax.Truth) -> str:
    return "true" if node.value else "false"


@_text.register
def _(node: syntax.Number) -> str:
    whole = node.value.is_integer() and node.value < _PRINTED_IN_FULL
    return str(int(node.value)) if whole else repr(node.value)


@_text.register
def _(node: syntax.Text) -> str:
    return json.dumps(node.value, ensure_ascii=False)


@_text.register
def _(node: syntax.Name) -> str:
    return node.name


@_text.register
def _(node: syntax.Feature) -> str:
    if not node.arguments:
        return node.name
    return f"{node.name}({', '.join(map(_text, node.arguments))})"


@_text.register
def _(node: syntax.Minus) -> str:
    return f"-{_inside(node.body, _MINUS)}"


@_text.register
def _(node: syntax.Arithmetic) -> str:
    level = _level(node)
    return f"{_inside(node.left, level)} {node.operator} {_inside(node.right, level + 1)}"


@_text.register
def _(node: syntax.Comparison) -> str:
    return f"{_inside(node.left, _SUM)} {node.operator} {_inside(node.right, _SUM)}"


@_text.register
def _(node: syntax.Negation) -> str:
    return f"not {_inside(node.body, _PREFIX)}"


@_text.register
def _(node: syntax.Conjunction) -> str:
    return " and ".join(_inside(body, _AND + 1) for body in node.bodies)


@_text.register
def _(node: syntax.Disjunction) -> str:
    return " or ".join(_inside(body, _OR + 1) for body in node.bodies)


@_text.register
def _(node: syntax.Implication) -> str:
    return f"{_inside(node.left, _OR)} -> {_inside(node.right, _OR)}"


@_text.register
def _(node: syntax.Equivalence) -> str:
    return f"{_inside(node.left, _OR)} <-> {_inside(node.right, _OR)}"


@_text.register
def _(node: syntax.Always) -> str:
    return f"always {_within(node.within)}{_inside(node.body, _PREFIX)}"


@_text.register
def _(node: syntax.Eventually) -> str:
    return f"eventually {_within(node.within)}{_inside(node.body, _PREFIX)}"


@_text.register
def _(node: syntax.Until) -> str:
    left, right = _inside(node.left, _PREFIX), _inside(node.right, _PREFIX)
    return f"{left} until {_within(node.within)}{right}"


@_text.register
def _(node: syntax.ForAll) -> str:
    return f"forall {node.variable.name} in {node.domain.name} ({_text(node.body)})"


@_text.register
def _(node: syntax.Exists) -> str:
    return f"exists {node.variable.name} in {node.domain.name} ({_text(node.body)})"


def _within(interval: Interval) -> str:
    return "" if interval == syntax.ALWAYS_HENCEFORTH else f"{text_from_interval(interval)} "


def _inside(node: Node, level: int) -> str:
    """Return the text of an operand, in parentheses if it binds looser than *level*."""
    text = _text.dispatch(type(node))(node)  # Without the wrapper nesting costs fewer frames.
    return text if _level(node) >= level else f"({text})"


def _level(node: Node) -> int:
    match node:
        case syntax.Arithmetic(_, operator, _):
            return _SUM if operator in "+-" else _PRODUCT
        case syntax.Minus():
            return _MINUS
        case _:
            return _LEVELS.get(type(node), _TIGHTEST)


_LEVELS: dict[type[Node], int] = {
    syntax.Equivalence: _LOOSEST,
    syntax.Implication: _IMPLICATION,
    syntax.Disjunction: _OR,
    syntax.Conjunction: _AND,
    syntax.Until: _UNTIL,
    syntax.Negation: _PREFIX,
    syntax.Always: _PREFIX,
    syntax.Eventually: _PREFIX,
    syntax.ForAll: _PREFIX,
    syntax.Exists: _PREFIX,
    syntax.Comparison: _PREFIX,
}

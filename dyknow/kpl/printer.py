"""From the syntax tree of a specification to its text; the inverse of the parser."""

import json
from collections.abc import Iterable
from functools import singledispatch

from dyknow.kpl import syntax
from dyknow.mtl.printer import text_from_formula
from dyknow.time import text_from_duration

__all__ = ["text_from"]

Printable = (
    syntax.Specification
    | syntax.Declaration
    | syntax.Process
    | syntax.StreamTerm
    | syntax.Label
    | syntax.Constraint
    | syntax.Setting
    | syntax.Value
    | syntax.Sort
    | syntax.Endless
)
"""Every piece of a specification that has a text of its own."""


def text_from(node: Printable) -> str:
    """Write a specification, or a piece of one, in the form that the parser reads."""
    return _text(node)


@singledispatch
def _text(node: Printable) -> str:
    raise TypeError(f"not a piece of a specification: {node!r}")


@_text.register
def _(node: syntax.Specification) -> str:
    return "".join(f"{_text(declaration)}\n" for declaration in node.declarations)


@_text.register
def _(node: syntax.SourceDeclaration) -> str:
    return f"source {_text(node.sort)} {node.name.text}"


@_text.register
def _(node: syntax.UnitDeclaration) -> str:
    more = ", ..." if node.takes_more else ""
    return f"compunit {_text(node.sort)} {node.name.text}({_list(node.inputs)}{more})"


@_text.register
def _(node: syntax.GeneratorDeclaration) -> str:
    return f"strmgen {_text(node.label)} = {_text(node.process)}"


@_text.register
def _(node: syntax.StreamDeclaration) -> str:
    return f"stream {node.name.text} = {_text(node.stream)}"


@_text.register
def _(node: syntax.ParameterDeclaration) -> str:
    return f"parameter {node.name.text} = {_value(node.default)}"


@_text.register
def _(node: syntax.Sort) -> str:
    return f"{node.name}({_list(node.parts)})" if node.parts else node.name


@_text.register
def _(node: syntax.Label) -> str:
    objects = f"[{_list(node.objects)}]" if node.objects else ""
    return f"{node.feature.text}{objects}"


@_text.register
def _(node: syntax.SourceInstance) -> str:
    return node.source.text


@_text.register
def _(node: syntax.UnitInstance) -> str:
    return f"{node.unit.text}({_list((*node.streams, *node.settings))})"


@_text.register
def _(node: syntax.Synchronisation) -> str:
    return f"sync({_list(node.streams)})"


@_text.register
def _(node: syntax.Link) -> str:
    parts = [
        _text(node.stream),
        node.unit.text,
        f"establish = {text_from_formula(node.establish)}",
        f"reestablish = {text_from_formula(node.reestablish)}",
        f"maintain = {text_from_formula(node.maintain)}",
        *map(_text, node.settings),
    ]
    lines = ",\n    ".join(parts)
    return f"link(\n    {lines})"


@_text.register
def _(node: syntax.StreamTerm) -> str:
    policy = f" with {_list(node.constraints)}" if node.constraints else ""
    return f"{_text(node.provider)}{policy}"


@_text.register
def _(node: syntax.Setting) -> str:
    return f"{node.name} = {_value(node.value)}"


@_text.register
def _(node: syntax.Name) -> str:
    return node.text


@_text.register
def _(node: syntax.Time) -> str:
    return text_from_duration(node.time)


@_text.register
def _(node: syntax.Number) -> str:
    return repr(node.value)


@_text.register
def _(node: syntax.Text) -> str:
    return json.dumps(node.value, ensure_ascii=False)


@_text.register
def _(node: syntax.Truth) -> str:
    return "true" if node.value else "false"


@_text.register
def _(node: syntax.Values) -> str:
    return f"[{', '.join(map(_value, node.values))}]"


@_text.register
def _(_node: syntax.Endless) -> str:
    return "oo"


@_text.register
def _(_node: syntax.NoApproximation) -> str:
    return "no approximation"


@_text.register
def _(_node: syntax.UseMostRecent) -> str:
    return "use most recent"


@_text.register
def _(_node: syntax.AnyUpdate) -> str:
    return "any update"


@_text.register
def _(_node: syntax.AnyChange) -> str:
    return "any change"


@_text.register
def _(node: syntax.SampleEvery) -> str:
    return f"sample every {_text(node.period)}"


@_text.register
def _(node: syntax.MaxDelay) -> str:
    return f"max delay {_text(node.delay)}"


@_text.register
def _(node: syntax.FromTo) -> str:
    end = f" to {_text(node.end)}" if node.end is not None else ""
    return f"from {_text(node.start)}{end}"


@_text.register
def _(node: syntax.To) -> str:
    return f"to {_text(node.end)}"


@_text.register
def _(_node: syntax.AnyOrder) -> str:
    return "any order"


@_text.register
def _(_node: syntax.MonotoneOrder) -> str:
    return "monotone order"


@_text.register
def _(_node: syntax.StrictOrder) -> str:
    return "strict order"


def _list(nodes: Iterable[Printable]) -> str:
    return ", ".join(map(_text, nodes))


def _value(node: syntax.Value) -> str:
    """Write a value; unlike a time in a policy, a time here must show its unit."""
    text = _text(node)
    is_bare = isinstance(node, syntax.Time) and not text.endswith("ns")
    return f"{text} ms" if is_bare else text

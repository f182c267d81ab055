"""From the syntax tree of a specification to its text; the inverse of the parser."""

import json
from collections.abc import Iterable
from functools import singledispatch

from dyknow.kpl import syntax
from dyknow.mtl.printer import text_from_formula
from dyknow.runtime.failures import OnFailure
from dyknow.time import text_from_duration

__all__ = ["text_from"]


Printable = (
    syntax.Specification
    | syntax.Declaration
    | syntax.Process
    | syntax.Provider
    | syntax.StreamTerm
    | syntax.SelectedField
    | syntax.Condition
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
    on_failure = (
        "" if node.on_failure is OnFailure.STOP else f" on failure {node.on_failure.value}"
    )
    policy = _policy(node.constraints)
    return f"strmgen {node.label.text} = {_text(node.process)}{policy}{on_failure}"


@_text.register
def _(node: syntax.StreamDeclaration) -> str:
    return f"stream {node.name.text} = {_text(node.stream)}"


@_text.register
def _(node: syntax.ParameterDeclaration) -> str:
    return f"parameter {node.name.text} = {_value(node.default)}"


@_text.register
def _(node: syntax.Configuration) -> str:
    lines = [line for each in node.declarations for line in _text(each).split("\n")]
    inner = "".join(f"    {line}\n" for line in lines)
    return f"{_for_each(node)} {{\n{inner}}}"


@_text.register
def _(node: syntax.Sort) -> str:
    return f"{node.name}({_list(node.parts)})" if node.parts else node.name


@_text.register
def _(node: syntax.Label) -> str:
    return node.text


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
def _(node: syntax.Merging) -> str:
    return f"merge({_list(node.streams)})"


@_text.register
def _(node: syntax.Mediation) -> str:
    return f"merge({_text(node.stream)} {_for_each(node)})"


@_text.register
def _(node: syntax.Selection) -> str:
    fields = _list(node.fields) or "*"
    where = f" where {' and '.join(map(_text, node.conditions))}" if node.conditions else ""
    return f"select {fields} from {_text(node.provider)}{where}"


@_text.register
def _(node: syntax.SelectedField) -> str:
    return node.path if node.pattern is None else f"{node.path} as {node.pattern}"


@_text.register
def _(node: syntax.Condition) -> str:
    return f"{node.path} = {_value(node.value)}"


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
    return f"{_text(node.provider)}{_policy(node.constraints)}"


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
def _(_node: syntax.UseLinear) -> str:
    return "use linear"


@_text.register
def _(_node: syntax.UseLatest) -> str:
    return "use latest"


@_text.register
def _(_node: syntax.AnyUpdate) -> str:
    return "any update"


@_text.register
def _(_node: syntax.AnyChange) -> str:
    return "any change"


@_text.register
def _(_node: syntax.AllUpdates) -> str:
    return "all updates"


@_text.register
def _(_node: syntax.SampleEveryCommonPeriod) -> str:
    return "sample every common period"


@_text.register
def _(node: syntax.SampleEvery) -> str:
    deviation = "" if node.deviation is None else f" deviation {_text(node.deviation)}"
    longest = "" if node.longest is None else f" up to {_text(node.longest)} under load"
    return f"sample every {_text(node.period)}{deviation}{longest}"


@_text.register
def _(node: syntax.DelayBeforeApproximation) -> str:
    return f"delay before approximation {_text(node.delay)}"


@_text.register
def _(node: syntax.MaxDelay) -> str:
    return f"max delay {_text(node.delay)}"


@_text.register
def _(_node: syntax.AtMaxDelay) -> str:
    return "at max delay"


@_text.register
def _(node: syntax.Capacity) -> str:
    return f"capacity {node.count}"


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


def _policy(constraints: tuple[syntax.Constraint, ...]) -> str:
    return f" with {_list(constraints)}" if constraints else ""


def _for_each(node: syntax.Mediation | syntax.Configuration) -> str:
    return f"for each {node.member.text} in {_text(node.members)}"


def _value(node: syntax.Value) -> str:
    """Write a value; unlike a time in a policy, a time here must show its unit."""
    text = _text(node)
    is_bare = isinstance(node, syntax.Time) and not text.endswith("ns")
    return f"{text} ms" if is_bare else text

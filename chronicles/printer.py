"""From a syntax tree to the text of a chronicle file: the inverse of the parser.

Comments and the layout of the original are not part of the tree. Equal trees print equally.
"""

import re
from collections.abc import Iterable
from functools import singledispatch

from chronicles.parser import RESERVED_WORDS
from chronicles.syntax import (
    Anything,
    AttributeDeclaration,
    Change,
    Chronicle,
    ChronicleFile,
    Comparison,
    Difference,
    DomainDeclaration,
    DomainReference,
    EventAt,
    EventType,
    Instant,
    Interval,
    Length,
    Membership,
    MessageDeclaration,
    NoEvent,
    Occurs,
    Relation,
    ReportAll,
    ReportNonOverlapping,
    Star,
    Value,
    ValueSet,
    Variable,
    Within,
)
from dyknow.time import text_from_duration

__all__ = ["print_chronicles", "text_of"]

_BARE = re.compile(r"[A-Za-z_]\w*|\d+", re.ASCII)


def print_chronicles(file: ChronicleFile) -> str:
    """Return the text of *file*, declarations parted by empty lines."""
    return "\n\n".join(text_of(declaration) for declaration in file.declarations) + "\n"


@singledispatch
def text_of(node: object) -> str:
    """Return the text of one node of a chronicle file."""
    raise TypeError(f"expected a node of a chronicle file, found {node!r}")


@text_of.register
def _(node: Variable | Star) -> str:
    return node.name


@text_of.register
def _(_node: Anything) -> str:
    return "?"


@text_of.register
def _(node: Value) -> str:
    return _constant(node.text)


@text_of.register
def _(node: Change) -> str:
    return f":({text_of(node.before)}, {text_of(node.after)})"


@text_of.register
def _(node: EventType) -> str:
    change = text_of(node.change) if node.change else ""
    return f"{node.name}{_bracketed(node.arguments)}{change}"


@text_of.register
def _(node: Instant) -> str:
    return f"{node.name}{_offset(node.offset)}"


@text_of.register
def _(node: Difference) -> str:
    return f"{node.later} - {node.earlier}{_offset(node.offset)}"


@text_of.register
def _(node: Length) -> str:
    return text_from_duration(node.duration)


@text_of.register
def _(node: Interval) -> str:
    lower = "]-oo" if node.lower is None else f"[{text_from_duration(node.lower)}"
    upper = "oo[" if node.upper is None else f"{text_from_duration(node.upper)}]"
    return f"{lower}, {upper}"


@text_of.register
def _(node: Comparison) -> str:
    first, *others = map(text_of, node.operands)
    return first + "".join(
        f" {order} {operand}" for order, operand in zip(node.orders, others, strict=True)
    )


@text_of.register
def _(node: Within) -> str:
    return f"{text_of(node.difference)} in {text_of(node.interval)}"


@text_of.register
def _(node: ValueSet) -> str:
    return "{" + ", ".join(map(_constant, node.values)) + "}"


@text_of.register
def _(node: DomainReference) -> str:
    return node.name


@text_of.register
def _(node: Membership) -> str:
    return f"{node.variable.name} in {text_of(node.domain)}"


@text_of.register
def _(node: Relation) -> str:
    return f"{node.variable.name} {node.sign} {text_of(node.other)}"


@text_of.register
def _(node: EventAt) -> str:
    return f"event({text_of(node.event_type)}, {node.instant})"


@text_of.register
def _(node: NoEvent) -> str:
    return f"noevent({text_of(node.event_type)}, ({text_of(node.begin)}, {text_of(node.end)}))"


@text_of.register
def _(node: Occurs) -> str:
    most = "oo" if node.most is None else node.most
    interval = f"({text_of(node.begin)}, {text_of(node.end)})"
    return f"occurs({node.least}, {most}, {text_of(node.event_type)}, {interval})"


@text_of.register
def _(_node: ReportAll) -> str:
    return "report all"


@text_of.register
def _(node: ReportNonOverlapping) -> str:
    return f"report non_overlapping ({node.begin}, {node.end})"


@text_of.register
def _(node: Chronicle) -> str:
    head = f"chronicle {node.name}{_bracketed(node.parameters)}"
    return f"{head} {_block(node.statements)}"


@text_of.register
def _(node: DomainDeclaration) -> str:
    return f"domain {node.name} = {text_of(node.domain)}"


@text_of.register
def _(node: AttributeDeclaration) -> str:
    return f"attribute {_signal(node)}"


@text_of.register
def _(node: MessageDeclaration) -> str:
    return f"message {_signal(node)}"


def _signal(node: AttributeDeclaration | MessageDeclaration) -> str:
    block = f" {_block(node.memberships)}" if node.memberships else ""
    return f"{node.name}{_bracketed(node.parameters)}{block}"


def _block(statements: Iterable[object]) -> str:
    lines = "".join(f"    {text_of(statement)}\n" for statement in statements)
    return f"{{\n{lines}}}"


def _bracketed(parameters: Iterable[object]) -> str:
    listed = ", ".join(map(text_of, parameters))
    return f"[{listed}]" if listed else ""


def _offset(offset: int) -> str:
    if not offset:
        return ""
    return f" {'+' if offset > 0 else '-'} {text_from_duration(abs(offset))}"


def _constant(text: str) -> str:
    if _BARE.fullmatch(text) and text not in RESERVED_WORDS:
        return text
    return f'"{text}"'

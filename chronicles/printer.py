"""From a syntax tree to the text of a chronicle file: the inverse of the parser.

Comments and the layout of the original are not part of the tree. Equal trees print equally.
"""

from collections.abc import Iterable, Iterator
from functools import singledispatch
from itertools import pairwise

from chronicles.spacing import constant
from chronicles.syntax import (
    Anything,
    AttributeDeclaration,
    Change,
    Chronicle,
    ChronicleFile,
    Comparison,
    Condition,
    Conditional,
    Conjunction,
    ConstraintDeclaration,
    Difference,
    Disjunction,
    Displaced,
    Domain,
    DomainComplement,
    DomainDeclaration,
    DomainDifference,
    DomainIntersection,
    DomainReference,
    DomainUnion,
    Equivalence,
    EventAt,
    EventType,
    Implication,
    Inclusion,
    Instant,
    InstantBinding,
    InstantDeclaration,
    Interval,
    Length,
    Membership,
    MessageDeclaration,
    NamedConstraint,
    Negation,
    NoEvent,
    Number,
    Occurs,
    ParameterDeclaration,
    Parametric,
    Relation,
    ReportAll,
    ReportNonOverlapping,
    Star,
    Value,
    ValueSet,
    Variable,
    VariableDeclaration,
    Within,
)
from dyknow.time import text_from_duration

__all__ = ["print_chronicles", "text_of", "text_of_moment"]


def print_chronicles(file: ChronicleFile) -> str:
    """Return the text of *file*, declarations parted by empty lines."""
    return "\n\n".join(text_of(declaration) for declaration in file.declarations) + "\n"


def text_of_moment(name: str, displacement: Interval) -> str:
    """Return the text of a moment that is so much later than an instant."""
    lower = displacement.lower
    if lower is not None and lower == displacement.upper:
        return f"{name}{_offset(lower)}"
    return f"{name} + {text_of(displacement)}"


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
    return constant(node.text)


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
def _(node: Displaced) -> str:
    return f"{node.name} + {text_of(node.interval)}"


@text_of.register
def _(node: Length) -> str:
    return text_from_duration(node.duration)


@text_of.register
def _(node: Number) -> str:
    return str(node.value)


@text_of.register
def _(node: Parametric) -> str:
    return node.text


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
    return "{" + ", ".join(map(constant, node.values)) + "}"


@text_of.register
def _(node: DomainReference) -> str:
    return node.name


@text_of.register
def _(node: DomainUnion) -> str:
    return f"{_first_domain(node)} | {_operand_domain(node.right)}"


@text_of.register
def _(node: DomainIntersection) -> str:
    return f"{_first_domain(node)} & {_operand_domain(node.right)}"


@text_of.register
def _(node: DomainDifference) -> str:
    return f"{_first_domain(node)} \\ {_operand_domain(node.right)}"


@text_of.register
def _(node: DomainComplement) -> str:
    return f"~{_operand_domain(node.body)}"


@text_of.register
def _(node: Membership) -> str:
    return f"{text_of(node.variable)} in {text_of(node.domain)}"


@text_of.register
def _(node: Relation) -> str:
    return f"{text_of(node.variable)} {node.sign} {text_of(node.other)}"


@text_of.register
def _(node: Negation) -> str:
    if isinstance(node.body, Membership):
        return f"{text_of(node.body.variable)} not in {text_of(node.body.domain)}"
    return f"not {_last_condition(node, node.body)}"


@text_of.register
def _(node: Conjunction) -> str:
    return f"{_operand_condition(node.left)} and {_last_condition(node, node.right)}"


@text_of.register
def _(node: Disjunction) -> str:
    return f"{_operand_condition(node.left)} or {_last_condition(node, node.right)}"


@text_of.register
def _(node: Implication) -> str:
    return f"{_operand_condition(node.left)} => {_operand_condition(node.right)}"


@text_of.register
def _(node: Equivalence) -> str:
    return f"{_operand_condition(node.left)} <=> {_operand_condition(node.right)}"


@text_of.register
def _(node: Conditional) -> str:
    then = f"if {_operand_condition(node.condition)} then {_operand_condition(node.consequence)}"
    if node.alternative is None:
        return then
    return f"{then} else {_operand_condition(node.alternative)}"


@text_of.register
def _(node: EventAt) -> str:
    moment = node.instant
    if node.displacement is not None:
        moment = text_of_moment(node.instant, node.displacement)
    return f"event({text_of(node.event_type)}, {moment})"


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
def _(node: VariableDeclaration) -> str:
    domain = f" in {text_of(node.domain)}" if node.domain is not None else ""
    return f"variable {', '.join(map(text_of, node.variables))}{domain}"


@text_of.register
def _(node: InstantDeclaration) -> str:
    return f"instant {', '.join(node.names)}"


@text_of.register
def _(node: NamedConstraint) -> str:
    instants = f"({', '.join(map(text_of, node.instants))})"
    if not node.parameters:
        return f"{node.name}{instants}"
    return f"{node.name}{_bracketed(node.parameters)}{instants if node.instants else ''}"


@text_of.register
def _(node: InstantBinding) -> str:
    label = f"{node.label} = " if node.label else ""
    return f"{label}{text_of(node.instant)}"


@text_of.register
def _(node: Inclusion) -> str:
    bindings = f" ({', '.join(map(text_of, node.bindings))})" if node.bindings else ""
    return f"chronicle {node.name}{_bracketed(node.parameters)}{bindings}"


@text_of.register
def _(node: Chronicle) -> str:
    return f"chronicle {_head(node)} {_block(node.statements)}"


@text_of.register
def _(node: ConstraintDeclaration) -> str:
    return f"constraint {_head(node)} {_block(node.statements)}"


@text_of.register
def _(node: ParameterDeclaration) -> str:
    unit = " ms" if isinstance(node.value, Length) else ""
    return f"parameter {node.name} = {text_of(node.value)}{unit}"


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
    block = f" {_block(node.conditions)}" if node.conditions else ""
    return f"{node.name}{_bracketed(node.parameters)}{block}"


def _head(node: Chronicle | ConstraintDeclaration) -> str:
    instants = f"({', '.join(node.instants)})" if node.instants else ""
    return f"{node.name}{_bracketed(node.parameters)}{instants}"


def _operand_domain(domain: Domain) -> str:
    is_simple = isinstance(domain, ValueSet | DomainReference | DomainComplement)
    return text_of(domain) if is_simple else f"({text_of(domain)})"


def _first_domain(node: DomainUnion | DomainIntersection | DomainDifference) -> str:
    """Return the left part, without brackets if it is read first anyway."""
    is_first = type(node.left) is type(node)
    return text_of(node.left) if is_first else _operand_domain(node.left)


def _last_condition(node: Condition, part: Condition) -> str:
    """Return the right part of a condition, without brackets if it is read last anyway."""
    return text_of(part) if type(part) is type(node) else _operand_condition(part)


def _operand_condition(condition: Condition) -> str:
    is_simple = isinstance(condition, Membership | Relation)
    return text_of(condition) if is_simple else f"({text_of(condition)})"


def _block(statements: Iterable[object]) -> str:
    lines = "".join(f"    {text}\n" for text in _parted(map(text_of, statements)))
    return f"{{\n{lines}}}"


def _parted(texts: Iterable[str]) -> Iterator[str]:
    """Yield statements, parted by `;` where the next begins with a sign or a bracket."""
    for text, following in pairwise([*texts, ""]):
        yield f"{text};" if following.startswith(("-", "(")) else text


def _bracketed(parameters: Iterable[object]) -> str:
    listed = ", ".join(map(text_of, parameters))
    return f"[{listed}]" if listed else ""


def _offset(offset: int) -> str:
    if not offset:
        return ""
    return f" {'+' if offset > 0 else '-'} {text_from_duration(abs(offset))}"

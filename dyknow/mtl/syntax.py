"""The syntax of formulas of metric temporal logic, one frozen class for each rule.

The operators are those of Heintz (2009), definition 7.5.1, with quantification over named
domains. The place of a node in its text takes no part in comparison.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum, StrEnum

from dyknow.source_text import MADE_IN_PYTHON, Span
from dyknow.time import Duration

__all__ = [
    "ALWAYS_HENCEFORTH",
    "FALSE",
    "MAX_DEPTH",
    "TOO_DEEP",
    "TRUE",
    "Always",
    "Argument",
    "Arithmetic",
    "Atom",
    "Comparison",
    "Conjunction",
    "Declaration",
    "Disjunction",
    "Document",
    "Equivalence",
    "Eventually",
    "Exists",
    "Feature",
    "FeatureDeclaration",
    "ForAll",
    "Formula",
    "Implication",
    "Interval",
    "Minus",
    "Name",
    "Negation",
    "Node",
    "Number",
    "ObjectDeclaration",
    "SortDeclaration",
    "Term",
    "Text",
    "TimeModel",
    "Truth",
    "Until",
    "Verdict",
    "descendants",
    "operands",
    "parts",
    "too_deep",
    "with_operands",
]


MAX_DEPTH = 200
"""How deep operators may be nested; `and` or `or` between any number of formulas counts once."""

TOO_DEEP = f"expected at most {MAX_DEPTH} operators inside one another, found more"


class Verdict(IntEnum):
    """What is known about a formula: it is true or false whatever comes, or not yet decided."""

    FALSE = -1
    UNDECIDED = 0
    TRUE = 1


class TimeModel(StrEnum):
    """At which time-points there is a state (`dyknow.mtl.semantics`)."""

    HOLD = "hold"
    """Each state holds until the next one, at every nanosecond."""

    POINTS = "points"
    """Only the time-points of the states count; between them there is nothing."""


@dataclass(frozen=True)
class _Node:
    """A piece of a formula and the place where it was written."""

    span: Span = field(default=MADE_IN_PYTHON, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True)
class Interval(_Node):
    """The durations from now that an operator speaks of, both ends included.

    Attributes:
        start: The shortest duration.
        end: The longest duration, or None if there is no bound.
    """

    start: Duration
    end: Duration | None


ALWAYS_HENCEFORTH = Interval(Duration(0), None)
"""From now on, without end: the interval of an operator that is written without one."""


@dataclass(frozen=True)
class Name(_Node):
    """A variable or an object, as an argument of a feature."""

    name: str


@dataclass(frozen=True)
class Number(_Node):
    """A number, finite and not negative; a negative one is a `Minus`."""

    value: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.value) and self.value >= 0):
            raise ValueError(f"expected a finite number of at least 0, found {self.value}")


@dataclass(frozen=True)
class Text(_Node):
    """A text between double quotes."""

    value: str


@dataclass(frozen=True)
class Feature(_Node):
    """A feature of some objects; as a formula if it is boolean, as a term otherwise.

    A bound variable that stands alone, as in `x != y`, is a feature without arguments until
    quantifiers are expanded.
    """

    name: str
    arguments: tuple["Argument", ...] = ()


@dataclass(frozen=True)
class Arithmetic(_Node):
    """The sum, difference, product or quotient (`+ - * /`) of two terms."""

    left: "Term"
    operator: str
    right: "Term"


@dataclass(frozen=True)
class Minus(_Node):
    """A term with its sign changed."""

    body: "Term"


@dataclass(frozen=True)
class Truth(_Node):
    """The constant `true` or `false`."""

    value: bool


TRUE = Truth(value=True)
FALSE = Truth(value=False)


@dataclass(frozen=True)
class Comparison(_Node):
    """Two terms compared by one of `<`, `<=`, `=`, `!=`, `>=`, `>`."""

    left: "Term"
    operator: str
    right: "Term"


@dataclass(frozen=True)
class Negation(_Node):
    """`not`."""

    body: "Formula"


@dataclass(frozen=True)
class Conjunction(_Node):
    """`and` between two or more formulas."""

    bodies: tuple["Formula", ...]


@dataclass(frozen=True)
class Disjunction(_Node):
    """`or` between two or more formulas."""

    bodies: tuple["Formula", ...]


@dataclass(frozen=True)
class Implication(_Node):
    """`->`."""

    left: "Formula"
    right: "Formula"


@dataclass(frozen=True)
class Equivalence(_Node):
    """`<->`."""

    left: "Formula"
    right: "Formula"


@dataclass(frozen=True)
class Always(_Node):
    """The body holds at every instant of the interval."""

    within: Interval
    body: "Formula"


@dataclass(frozen=True)
class Eventually(_Node):
    """The body holds at some instant of the interval."""

    within: Interval
    body: "Formula"


@dataclass(frozen=True)
class Until(_Node):
    """The right side holds at some instant of the interval, the left one from now until then.

    The left side need not hold at the instant at which the right one does.
    """

    within: Interval
    left: "Formula"
    right: "Formula"


@dataclass(frozen=True)
class ForAll(_Node):
    """The body holds for every object of a domain."""

    variable: Name
    domain: Name
    body: "Formula"


@dataclass(frozen=True)
class Exists(_Node):
    """The body holds for some object of a domain."""

    variable: Name
    domain: Name
    body: "Formula"


@dataclass(frozen=True)
class SortDeclaration(_Node):
    """A sort, which is a domain of quantification, with its objects if they are known."""

    name: Name
    objects: tuple[Name, ...] = ()


@dataclass(frozen=True)
class ObjectDeclaration(_Node):
    """Objects of a sort that a formula mentions, or free variables such as `from`."""

    names: tuple[Name, ...]
    sort: Name


@dataclass(frozen=True)
class FeatureDeclaration(_Node):
    """A feature with the sorts of its arguments and of its value."""

    name: Name
    parameters: tuple[Name, ...]
    sort: Name


Declaration = SortDeclaration | ObjectDeclaration | FeatureDeclaration


@dataclass(frozen=True)
class Document:
    """A formula and the declarations before it."""

    declarations: tuple[Declaration, ...]
    formula: "Formula"


Argument = Name | Number | Text
Term = Truth | Number | Text | Feature | Arithmetic | Minus
Atom = Feature | Comparison
Formula = (
    Truth
    | Feature
    | Comparison
    | Negation
    | Conjunction
    | Disjunction
    | Implication
    | Equivalence
    | Always
    | Eventually
    | Until
    | ForAll
    | Exists
)
Node = Formula | Term


def parts(node: Node) -> tuple[Node, ...]:
    """Return the formulas and terms that *node* is made of, in reading order."""
    match node:
        case Conjunction(bodies) | Disjunction(bodies):
            return bodies
        case (
            Implication(left, right)
            | Equivalence(left, right)
            | Until(_, left, right)
            | Comparison(left, _, right)
            | Arithmetic(left, _, right)
        ):
            return (left, right)
        case (
            Negation(body) | Minus(body) | Always(_, body) | Eventually(_, body)
            | ForAll(_, _, body) | Exists(_, _, body)
        ):  # fmt: skip
            return (body,)
        case Truth() | Number() | Text() | Feature():
            return ()


def operands(formula: Formula) -> tuple[Formula, ...]:
    """Return the formulas that *formula* is made of, in reading order; atoms have none."""
    match formula:
        case Conjunction(bodies) | Disjunction(bodies):
            return bodies
        case Implication(left, right) | Equivalence(left, right) | Until(_, left, right):
            return (left, right)
        case (
            Negation(body) | Always(_, body) | Eventually(_, body)
            | ForAll(_, _, body) | Exists(_, _, body)
        ):  # fmt: skip
            return (body,)
        case Truth() | Feature() | Comparison():
            return ()


def with_operands(formula: Formula, new: Sequence[Formula]) -> Formula:
    """Return *formula* with other operands, as many as it has."""
    match formula:
        case Conjunction() | Disjunction():
            return replace(formula, bodies=tuple(new))
        case Implication() | Equivalence() | Until():
            left, right = new
            return replace(formula, left=left, right=right)
        case Negation() | Always() | Eventually() | ForAll() | Exists():
            (body,) = new
            return replace(formula, body=body)
        case Truth() | Feature() | Comparison():
            return formula


def descendants(node: Node) -> Iterator[tuple[Node, int]]:
    """Yield *node* and all it is made of, in reading order, each with its depth from 1."""
    waiting: list[tuple[Node, int]] = [(node, 1)]
    while waiting:
        found, depth = waiting.pop()
        yield found, depth
        waiting.extend((part, depth + 1) for part in reversed(parts(found)))


def too_deep(node: Node) -> Node | None:
    """Return a part of *node* that lies deeper than `MAX_DEPTH`, if there is one."""
    return next((part for part, depth in descendants(node) if depth > MAX_DEPTH), None)

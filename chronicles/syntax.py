"""What a chronicle file says: one frozen class for each rule of the grammar.

The language is that of C.R.S. as Heintz (2009) gives it in sections 8.3.1 to 8.3.5. Lengths of
time are in nanoseconds here and whole milliseconds in the text, because an instant of the
chronicle language is one millisecond: `t3 + 1` is the next instant, and `t1 < t2` says that t2
is at least one instant later.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from lark.ast_utils import Ast

from dyknow.source_text import Span
from dyknow.time import Duration

__all__ = [
    "VALUE_VARIABLE",
    "Amount",
    "Anything",
    "AttributeDeclaration",
    "Change",
    "Chronicle",
    "ChronicleFile",
    "Comparison",
    "Condition",
    "Conditional",
    "Conjunction",
    "ConstraintDeclaration",
    "Difference",
    "Disjunction",
    "Displaced",
    "Domain",
    "DomainComplement",
    "DomainDeclaration",
    "DomainDifference",
    "DomainIntersection",
    "DomainReference",
    "DomainUnion",
    "Equivalence",
    "EventAt",
    "EventType",
    "Implication",
    "Inclusion",
    "Instant",
    "InstantBinding",
    "InstantDeclaration",
    "Interval",
    "Length",
    "Membership",
    "MessageDeclaration",
    "NamedConstraint",
    "Negation",
    "NoEvent",
    "Number",
    "Occurs",
    "Operand",
    "Parameter",
    "ParameterDeclaration",
    "Parametric",
    "Relation",
    "ReportAll",
    "ReportNonOverlapping",
    "Star",
    "Statement",
    "TemporalConstraint",
    "Value",
    "ValueSet",
    "Variable",
    "VariableDeclaration",
    "Within",
    "names_in",
    "stars_of",
    "variables_of",
]

VALUE_VARIABLE = "?value"
"""The variable that stands for the value of an attribute in its declaration."""


@dataclass(frozen=True)
class _Node(Ast):
    """A piece of a chronicle file and the place where it was written."""

    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True)
class Variable(_Node):
    """`?x`: the same value wherever it stands in a chronicle; the name includes the mark."""

    name: str


@dataclass(frozen=True)
class Star(_Node):
    """`*x`: a value that may differ from one event to the next; binds nothing."""

    name: str


@dataclass(frozen=True)
class Anything(_Node):
    """`?`: some value that does not matter."""


@dataclass(frozen=True)
class Value(_Node):
    """A constant value."""

    text: str


Parameter = Variable | Star | Anything | Value


@dataclass(frozen=True)
class Change(_Node):
    """`:(from, to)`: the value of an attribute before and after."""

    before: Parameter
    after: Parameter


@dataclass(frozen=True)
class EventType(_Node):
    """The kind of event: a message, or with a `change` the change of an attribute."""

    name: str
    arguments: tuple[Parameter, ...]
    change: Change | None


@dataclass(frozen=True)
class Instant(_Node):
    """`t3` or `t3 + 1`: an instant of the chronicle, displaced by an offset."""

    name: str
    offset: Duration


@dataclass(frozen=True)
class Difference(_Node):
    """`t3 - t2`: the time from one instant to another, plus an offset."""

    later: str
    earlier: str
    offset: Duration


@dataclass(frozen=True)
class Length(_Node):
    """A constant length of time."""

    duration: Duration


@dataclass(frozen=True)
class Number(_Node):
    """A number without a unit: of events, or of milliseconds where a length of time stands."""

    value: int


Amount = Length | Number


@dataclass(frozen=True)
class Interval(_Node):
    """A closed interval of lengths; None is without limit.

    `]0, 5]` is read as `[1, 5]`, and a sum, an intersection or a union as what it amounts to.
    """

    lower: Duration | None
    upper: Duration | None


@dataclass(frozen=True)
class Displaced(_Node):
    """`t3 + [0, 5]`: some time that is as much later than an instant as an interval allows."""

    name: str
    interval: Interval


Operand = Instant | Displaced | Difference | Length


@dataclass(frozen=True)
class Comparison(_Node):
    """`t1 < t2 <= t3`: each operand compared with the next one."""

    operands: tuple[Operand, ...]
    orders: tuple[str, ...]


@dataclass(frozen=True)
class Within(_Node):
    """`t3 - t2 in [a, b]`, or `t3 in [a, b]`, which speaks of the time since time zero."""

    difference: Difference | Instant
    interval: Interval


TemporalConstraint = Comparison | Within


@dataclass(frozen=True)
class ValueSet(_Node):
    """`{red, blue}`."""

    values: tuple[str, ...]


@dataclass(frozen=True)
class DomainReference(_Node):
    """The name of a declared domain."""

    name: str


@dataclass(frozen=True)
class DomainUnion(_Node):
    """`A | B`, also `A + B`."""

    left: "Domain"
    right: "Domain"


@dataclass(frozen=True)
class DomainIntersection(_Node):
    """`A & B`."""

    left: "Domain"
    right: "Domain"


@dataclass(frozen=True)
class DomainDifference(_Node):
    r"""`A \ B`, also `A - B`."""

    left: "Domain"
    right: "Domain"


@dataclass(frozen=True)
class DomainComplement(_Node):
    """`~A`: every value that is not in A."""

    body: "Domain"


Domain = (
    ValueSet
    | DomainReference
    | DomainUnion
    | DomainIntersection
    | DomainDifference
    | DomainComplement
)


@dataclass(frozen=True)
class Membership(_Node):
    """`?x in Car`; an inclusion may put a value in the place of the variable."""

    variable: Variable | Star | Value
    domain: Domain


@dataclass(frozen=True)
class Relation(_Node):
    """`?a != ?b` or `?a == b`; an inclusion may put a value in the place of the variable."""

    variable: Variable | Star | Value
    sign: str
    other: Variable | Star | Value


@dataclass(frozen=True)
class Negation(_Node):
    """`not C`; `?x not in D` is read as `not ?x in D`."""

    body: "Condition"


@dataclass(frozen=True)
class Conjunction(_Node):
    """`C and D`."""

    left: "Condition"
    right: "Condition"


@dataclass(frozen=True)
class Disjunction(_Node):
    """`C or D`."""

    left: "Condition"
    right: "Condition"


@dataclass(frozen=True)
class Implication(_Node):
    """`C => D`."""

    left: "Condition"
    right: "Condition"


@dataclass(frozen=True)
class Equivalence(_Node):
    """`C <=> D`."""

    left: "Condition"
    right: "Condition"


@dataclass(frozen=True)
class Conditional(_Node):
    """`if C then D else E`; without `else` it is the implication."""

    condition: "Condition"
    consequence: "Condition"
    alternative: "Condition | None"


Condition = (
    Membership | Relation | Negation | Conjunction | Disjunction | Implication | Equivalence
) | Conditional


@dataclass(frozen=True)
class EventAt(_Node):
    """`event(E, t)`: an event of this type at the instant t.

    Attributes:
        event_type: Which event.
        instant: The instant t.
        displacement: In `event(E, t + 5)` and `event(E, t + [0, 5])` how much later than t.
    """

    event_type: EventType
    instant: str
    displacement: Interval | None = None


@dataclass(frozen=True)
class NoEvent(_Node):
    """`noevent(E, (t1, t2))`: no event of this type from t1 up to but not at t2."""

    event_type: EventType
    begin: Instant
    end: Instant


@dataclass(frozen=True)
class Occurs(_Node):
    """`occurs(n1, n2, E, (t1, t2))`: n1 to n2 events from t1 up to but not at t2.

    Attributes:
        least: The least number of events.
        most: The largest number of events; None is without limit.
        event_type: Which events count.
        begin: The first instant that counts.
        end: The instant before which the counting ends.
    """

    least: int
    most: int | None
    event_type: EventType
    begin: Instant
    end: Instant


@dataclass(frozen=True)
class ReportAll(_Node):
    """`report all`: every match is a recognition of its own; the same as saying nothing."""


@dataclass(frozen=True)
class ReportNonOverlapping(_Node):
    """`report non_overlapping (t1, t2)`: what a person counts.

    Of the matches with the same arguments of the chronicle, one is left out if its interval
    [t1, t2] shares an instant with that of one reported before.
    """

    begin: str
    end: str


@dataclass(frozen=True)
class VariableDeclaration(_Node):
    """`variable ?x, *y in Car`: variables of the chronicle, and what they may be."""

    variables: tuple[Variable | Star, ...]
    domain: Domain | None


@dataclass(frozen=True)
class InstantDeclaration(_Node):
    """`instant t1, t2`: instants of the chronicle, which need no declaration."""

    names: tuple[str, ...]


@dataclass(frozen=True)
class NamedConstraint(_Node):
    """`sequence(t1, t2 + 5)` or `rivals[?a, ?b]`: what a declared constraint says of these."""

    name: str
    parameters: tuple[Variable | Star | Value, ...]
    instants: tuple[Instant, ...]


@dataclass(frozen=True)
class InstantBinding(_Node):
    """`t1 = begin`: an instant of an included chronicle, by name or by place, is one of ours."""

    label: str | None
    instant: Instant


@dataclass(frozen=True)
class Inclusion(_Node):
    """`chronicle overtake[?a, ?b] (t1 = begin)`: everything that another chronicle says."""

    name: str
    parameters: tuple[Parameter, ...]
    bindings: tuple[InstantBinding, ...]


Statement = (
    EventAt
    | NoEvent
    | Occurs
    | Comparison
    | Within
    | Condition
    | VariableDeclaration
    | InstantDeclaration
    | NamedConstraint
    | Inclusion
    | ReportAll
    | ReportNonOverlapping
)


@dataclass(frozen=True)
class Parametric(_Node):
    """A statement in which parameters of the file stand: `t2 <= t1 + longest`.

    Attributes:
        text: How it is written.
        parameters: The names of the parameters.
        statement: What it says with their values.
    """

    text: str
    parameters: tuple[str, ...]
    statement: Statement


@dataclass(frozen=True)
class Chronicle(_Node):
    """A model of a complex event.

    Attributes:
        name: What its recognitions are called.
        parameters: The variables that a recognition tells.
        statements: Predicates and constraints, all of which must hold.
        instants: The instants that an inclusion can bind by their place.
    """

    name: str
    parameters: tuple[Variable, ...]
    statements: tuple[Statement | Parametric, ...]
    instants: tuple[str, ...] = ()

    @cached_property
    def plain(self) -> tuple[Statement, ...]:
        """The statements, with values in the places of parameters."""
        return _plain(self.statements)


@dataclass(frozen=True)
class ConstraintDeclaration(_Node):
    """`constraint sequence(t1, t2) { t1 <= t2 <= t1 + 5 }`: a name for some constraints.

    Attributes:
        name: Its name.
        parameters: The variables that it speaks of.
        instants: The instants that it speaks of.
        statements: What it says of them.
    """

    name: str
    parameters: tuple[Variable, ...]
    instants: tuple[str, ...]
    statements: tuple[Statement | Parametric, ...]

    @cached_property
    def plain(self) -> tuple[Statement, ...]:
        """The statements, with values in the places of parameters."""
        return _plain(self.statements)


@dataclass(frozen=True)
class ParameterDeclaration(_Node):
    """`parameter longest = 1 min`: a value that whoever uses the file may replace.

    Attributes:
        name: Its name.
        value: What stands in the place of the name.
    """

    name: str
    value: Amount


@dataclass(frozen=True)
class DomainDeclaration(_Node):
    """`domain Color = {red, blue}`."""

    name: str
    domain: Domain


@dataclass(frozen=True)
class AttributeDeclaration(_Node):
    """`attribute behind[?a, ?b] { ?value in {true, false} }`."""

    name: str
    parameters: tuple[Variable, ...]
    conditions: tuple[Condition, ...]


@dataclass(frozen=True)
class MessageDeclaration(_Node):
    """`message in_crossing[?car, ?crossing]`."""

    name: str
    parameters: tuple[Variable, ...]
    conditions: tuple[Condition, ...]


@dataclass(frozen=True)
class ChronicleFile(_Node):
    """Everything that one file declares, in the order of the text."""

    declarations: tuple[
        ParameterDeclaration
        | DomainDeclaration
        | ConstraintDeclaration
        | AttributeDeclaration
        | MessageDeclaration
        | Chronicle,
        ...,
    ]

    @cached_property
    def parameters(self) -> tuple[ParameterDeclaration, ...]:
        """The declared parameters."""
        return tuple(d for d in self.declarations if isinstance(d, ParameterDeclaration))

    @cached_property
    def domains(self) -> tuple[DomainDeclaration, ...]:
        """The declared domains."""
        return tuple(d for d in self.declarations if isinstance(d, DomainDeclaration))

    @cached_property
    def constraints(self) -> tuple[ConstraintDeclaration, ...]:
        """The declared constraints."""
        return tuple(d for d in self.declarations if isinstance(d, ConstraintDeclaration))

    @cached_property
    def signals(self) -> tuple[AttributeDeclaration | MessageDeclaration, ...]:
        """The declared attributes and messages."""
        kinds = (AttributeDeclaration, MessageDeclaration)
        return tuple(d for d in self.declarations if isinstance(d, kinds))

    @cached_property
    def chronicles(self) -> tuple[Chronicle, ...]:
        """The chronicle models."""
        return tuple(d for d in self.declarations if isinstance(d, Chronicle))

    @cached_property
    def chronicle_by_name(self) -> Mapping[str, Chronicle]:
        """The first chronicle of each name."""
        return {chronicle.name: chronicle for chronicle in reversed(self.chronicles)}

    @cached_property
    def constraint_by_name(self) -> Mapping[str, ConstraintDeclaration]:
        """The first constraint of each name."""
        return {constraint.name: constraint for constraint in reversed(self.constraints)}


def _plain(statements: tuple[Statement | Parametric, ...]) -> tuple[Statement, ...]:
    return tuple(s.statement if isinstance(s, Parametric) else s for s in statements)


def variables_of(event_type: EventType) -> Iterator[Variable]:
    """Yield the `?` variables of *event_type* from left to right, each as often as it stands."""
    change = event_type.change
    values = (change.before, change.after) if change else ()
    for parameter in (*event_type.arguments, *values):
        if isinstance(parameter, Variable):
            yield parameter


def names_in(event_type: EventType) -> set[str]:
    """Return the names of all variables of *event_type*."""
    variables = {variable.name for variable in variables_of(event_type)}
    return variables | {star.name for star in stars_of(event_type)}


def stars_of(event_type: EventType) -> Iterator[Star]:
    """Yield the `*` variables of *event_type* from left to right."""
    change = event_type.change
    values = (change.before, change.after) if change else ()
    for parameter in (*event_type.arguments, *values):
        if isinstance(parameter, Star):
            yield parameter

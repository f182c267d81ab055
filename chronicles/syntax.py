"""What a chronicle file says: one frozen class for each rule of the grammar.

The language is that of C.R.S. as Heintz (2009) gives it in sections 8.3.1 to 8.3.5. Lengths of
time are in nanoseconds here and whole milliseconds in the text, because an instant of the
chronicle language is one millisecond: `t3 + 1` is the next instant, and `t1 < t2` says that t2
is at least one instant later.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from lark.ast_utils import Ast

from dyknow.source_text import Span
from dyknow.time import Duration

__all__ = [
    "VALUE_VARIABLE",
    "Anything",
    "AttributeDeclaration",
    "Change",
    "Chronicle",
    "ChronicleFile",
    "Comparison",
    "Difference",
    "Domain",
    "DomainDeclaration",
    "DomainReference",
    "EventAt",
    "EventType",
    "Instant",
    "Interval",
    "Length",
    "Membership",
    "MessageDeclaration",
    "NoEvent",
    "Occurs",
    "Operand",
    "Parameter",
    "Relation",
    "ReportAll",
    "ReportNonOverlapping",
    "Star",
    "Statement",
    "TemporalConstraint",
    "Value",
    "ValueSet",
    "Variable",
    "Within",
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


Operand = Instant | Difference | Length


@dataclass(frozen=True)
class Interval(_Node):
    """A closed interval of lengths; None is without limit. `]0, 5]` is read as `[1, 5]`."""

    lower: Duration | None
    upper: Duration | None


@dataclass(frozen=True)
class Comparison(_Node):
    """`t1 < t2 <= t3`: each operand compared with the next one."""

    operands: tuple[Operand, ...]
    orders: tuple[str, ...]


@dataclass(frozen=True)
class Within(_Node):
    """`t3 - t2 in [a, b]`."""

    difference: Difference
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


Domain = ValueSet | DomainReference


@dataclass(frozen=True)
class Membership(_Node):
    """`?x in Car`."""

    variable: Variable
    domain: Domain


@dataclass(frozen=True)
class Relation(_Node):
    """`?a != ?b` or `?a == b`."""

    variable: Variable
    sign: str
    other: Variable | Value


@dataclass(frozen=True)
class EventAt(_Node):
    """`event(E, t)`: an event of this type at the instant t."""

    event_type: EventType
    instant: str


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


Statement = (
    EventAt
    | NoEvent
    | Occurs
    | Comparison
    | Within
    | Membership
    | Relation
    | ReportAll
    | ReportNonOverlapping
)


@dataclass(frozen=True)
class Chronicle(_Node):
    """A model of a complex event.

    Attributes:
        name: What its recognitions are called.
        parameters: The variables that a recognition tells.
        statements: Predicates and constraints, all of which must hold.
    """

    name: str
    parameters: tuple[Variable, ...]
    statements: tuple[Statement, ...]


@dataclass(frozen=True)
class DomainDeclaration(_Node):
    """`domain Color = {red, blue}`."""

    name: str
    domain: ValueSet


@dataclass(frozen=True)
class AttributeDeclaration(_Node):
    """`attribute behind[?a, ?b] { ?value in {true, false} }`."""

    name: str
    parameters: tuple[Variable, ...]
    memberships: tuple[Membership, ...]


@dataclass(frozen=True)
class MessageDeclaration(_Node):
    """`message in_crossing[?car, ?crossing]`."""

    name: str
    parameters: tuple[Variable, ...]
    memberships: tuple[Membership, ...]


@dataclass(frozen=True)
class ChronicleFile(_Node):
    """Everything that one file declares, in the order of the text."""

    declarations: tuple[
        DomainDeclaration | AttributeDeclaration | MessageDeclaration | Chronicle, ...
    ]

    @property
    def domains(self) -> tuple[DomainDeclaration, ...]:
        """The declared domains."""
        return tuple(d for d in self.declarations if isinstance(d, DomainDeclaration))

    @property
    def signals(self) -> tuple[AttributeDeclaration | MessageDeclaration, ...]:
        """The declared attributes and messages."""
        kinds = (AttributeDeclaration, MessageDeclaration)
        return tuple(d for d in self.declarations if isinstance(d, kinds))

    @property
    def chronicles(self) -> tuple[Chronicle, ...]:
        """The chronicle models."""
        return tuple(d for d in self.declarations if isinstance(d, Chronicle))


def variables_of(event_type: EventType) -> Iterator[Variable]:
    """Yield the `?` variables of *event_type* from left to right, each as often as it stands."""
    change = event_type.change
    values = (change.before, change.after) if change else ()
    for parameter in (*event_type.arguments, *values):
        if isinstance(parameter, Variable):
            yield parameter

"""The syntax tree of KPL specifications: one frozen class per rule of the grammar.

The place where a piece was written takes no part in comparison, so two texts that mean the same
give equal trees.
"""

from dataclasses import dataclass, field

from lark.ast_utils import AsList, Ast

from dyknow.mtl.syntax import Formula
from dyknow.source_text import MADE_IN_PYTHON, Span
from dyknow.time import Duration

__all__ = [
    "ANY_SORT",
    "STATE_SORT",
    "AnyChange",
    "AnyOrder",
    "AnyUpdate",
    "Constraint",
    "Declaration",
    "Endless",
    "FromTo",
    "GeneratorDeclaration",
    "Label",
    "Link",
    "MaxDelay",
    "MonotoneOrder",
    "Name",
    "NoApproximation",
    "Number",
    "ParameterDeclaration",
    "Process",
    "SampleEvery",
    "Setting",
    "Sort",
    "SourceDeclaration",
    "SourceInstance",
    "Specification",
    "StreamDeclaration",
    "StreamTerm",
    "StrictOrder",
    "Synchronisation",
    "Text",
    "Time",
    "To",
    "Truth",
    "UnitDeclaration",
    "UnitInstance",
    "UseMostRecent",
    "Value",
    "Values",
]

ANY_SORT = "any"
"""The sort of which every value is."""

STATE_SORT = "state"
"""The sort of states, with the sorts of their values as parts."""


@dataclass(frozen=True)
class _Node(Ast):
    """A piece of a specification and the place where it was written."""

    span: Span = field(default=MADE_IN_PYTHON, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True)
class Name(_Node):
    """A symbol; where a value may stand, the name of a parameter or a word."""

    text: str


@dataclass(frozen=True)
class Sort(_Node):
    """A sort of values; only `state` has parts."""

    name: str
    parts: tuple["Sort", ...] = ()


@dataclass(frozen=True)
class Label(_Node):
    """The name of a stream generator: a feature and the objects it is about (def. 4.4.6)."""

    feature: Name
    objects: tuple[Name, ...] = ()


@dataclass(frozen=True)
class Time(_Node):
    """A time-point or duration, in nanoseconds."""

    time: Duration


@dataclass(frozen=True)
class Endless(_Node):
    """The time after all others, `oo`."""


@dataclass(frozen=True)
class Number(_Node):
    """A number without a unit."""

    value: int | float


@dataclass(frozen=True)
class Text(_Node):
    """A string in quotes."""

    value: str


@dataclass(frozen=True)
class Truth(_Node):
    """`true` or `false`."""

    value: bool


@dataclass(frozen=True)
class Values(_Node, AsList):
    """Several values in brackets."""

    values: tuple["Value", ...]


Value = Number | Time | Text | Truth | Name | Values
"""What a setting or a parameter may be."""


@dataclass(frozen=True)
class NoApproximation(_Node):
    """No sample may be made up."""


@dataclass(frozen=True)
class UseMostRecent(_Node):
    """A sample that does not come may be replaced by the most recent value."""


@dataclass(frozen=True)
class AnyUpdate(_Node):
    """Every sample is wanted."""


@dataclass(frozen=True)
class AnyChange(_Node):
    """A sample is wanted if its value or valid time is new."""


@dataclass(frozen=True)
class SampleEvery(_Node):
    """Consecutive samples are one period of valid time apart."""

    period: Time | Name


@dataclass(frozen=True)
class MaxDelay(_Node):
    """Samples are at most so much later than their valid times."""

    delay: Time | Name | Endless


@dataclass(frozen=True)
class FromTo(_Node):
    """Valid times lie between two times."""

    start: Time | Name
    end: Time | Name | Endless | None = None


@dataclass(frozen=True)
class To(_Node):
    """Valid times lie at or before a time."""

    end: Time | Name | Endless


@dataclass(frozen=True)
class AnyOrder(_Node):
    """Valid times may come in any order."""


@dataclass(frozen=True)
class MonotoneOrder(_Node):
    """Valid times do not decrease."""


@dataclass(frozen=True)
class StrictOrder(_Node):
    """Valid times increase."""


Constraint = (
    NoApproximation
    | UseMostRecent
    | AnyUpdate
    | AnyChange
    | SampleEvery
    | MaxDelay
    | FromTo
    | To
    | AnyOrder
    | MonotoneOrder
    | StrictOrder
)
"""A constraint of a policy (definition 4.4.8)."""


@dataclass(frozen=True)
class StreamTerm(_Node):
    """A stream: a generator or a synchronisation, and a policy (definition 4.4.14)."""

    provider: "Label | Synchronisation"
    constraints: tuple[Constraint, ...] = ()


@dataclass(frozen=True)
class Synchronisation(_Node):
    """One stream of states from several streams: a state for each common valid time."""

    streams: tuple[StreamTerm, ...]


@dataclass(frozen=True)
class Setting(_Node):
    """A value that a computational unit is made with."""

    name: str
    value: Value


@dataclass(frozen=True)
class SourceInstance(_Node):
    """A primitive process."""

    source: Name


@dataclass(frozen=True)
class UnitInstance(_Node):
    """A refinement process: a computational unit applied to streams."""

    unit: Name
    streams: tuple[StreamTerm, ...]
    settings: tuple[Setting, ...] = ()


@dataclass(frozen=True)
class Link(_Node):
    """A link process (definition 8.5.3), with settings.

    Attributes:
        stream: The objects to be linked.
        unit: The symbol of the computational unit that computes the upper objects.
        establish: When a new upper object is made.
        reestablish: When a known upper object is linked again.
        maintain: What must go on holding for the link to stay.
        settings: What the link process is made with.
    """

    stream: StreamTerm
    unit: Name
    establish: Formula
    reestablish: Formula
    maintain: Formula
    settings: tuple[Setting, ...] = ()


Process = SourceInstance | UnitInstance | Link | Synchronisation
"""What feeds a stream generator."""


@dataclass(frozen=True)
class SourceDeclaration(_Node):
    """`source SORT NAME` (definition 4.4.4)."""

    sort: Sort
    name: Name


@dataclass(frozen=True)
class UnitDeclaration(_Node):
    """`compunit SORT NAME(SORT, SORT)` (definition 4.4.5).

    Attributes:
        sort: Of the output.
        name: The symbol.
        inputs: The sorts of the inputs.
        takes_more: Whether any number of further inputs of the last sort may follow, which is
            written as `, ...`.
    """

    sort: Sort
    name: Name
    inputs: tuple[Sort, ...]
    takes_more: bool = False

    def sorts_for(self, count: int) -> tuple[Sort, ...]:
        """Return the sorts of *count* inputs, or of as many as the unit takes."""
        more = max(0, count - len(self.inputs)) if self.takes_more else 0
        return self.inputs + more * self.inputs[-1:]


@dataclass(frozen=True)
class GeneratorDeclaration(_Node):
    """`strmgen LABEL = PROCESS` (definition 4.4.7)."""

    label: Label
    process: Process


@dataclass(frozen=True)
class StreamDeclaration(_Node):
    """`stream NAME = TERM`, an output of the application (definition 4.4.15)."""

    name: Name
    stream: StreamTerm


@dataclass(frozen=True)
class ParameterDeclaration(_Node):
    """`parameter NAME = VALUE`: a name for a value that the caller may replace."""

    name: Name
    default: Value


Declaration = (
    SourceDeclaration
    | UnitDeclaration
    | GeneratorDeclaration
    | StreamDeclaration
    | ParameterDeclaration
)
"""A statement of KPL."""


@dataclass(frozen=True)
class Specification(_Node, AsList):
    """A KPL specification: declarations in any order (definition 4.4.3)."""

    declarations: tuple[Declaration, ...]

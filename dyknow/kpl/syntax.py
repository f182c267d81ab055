"""The syntax tree of KPL specifications: one frozen class per rule of the grammar.

The place where a piece was written takes no part in comparison, so two texts that mean the same
give equal trees.
"""

from dataclasses import dataclass, field

from lark.ast_utils import AsList, Ast

from dyknow.mtl.syntax import Formula
from dyknow.runtime.failures import OnFailure
from dyknow.source_text import MADE_IN_PYTHON, Span
from dyknow.time import Duration

__all__ = [
    "ANY_SORT",
    "OBJECT_SORT",
    "STATE_SORT",
    "AllUpdates",
    "AnyChange",
    "AnyOrder",
    "AnyUpdate",
    "AtMaxDelay",
    "Capacity",
    "Condition",
    "Configuration",
    "Constraint",
    "Declaration",
    "DelayBeforeApproximation",
    "Endless",
    "FromTo",
    "GeneratorDeclaration",
    "Label",
    "Link",
    "MaxDelay",
    "Mediation",
    "Merging",
    "MonotoneOrder",
    "Name",
    "NoApproximation",
    "Number",
    "ParameterDeclaration",
    "Process",
    "Provider",
    "SampleEvery",
    "SampleEveryCommonPeriod",
    "SelectedField",
    "Selection",
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
    "UseLatest",
    "UseLinear",
    "UseMostRecent",
    "Value",
    "Values",
]

ANY_SORT = "any"
"""The sort of which every value is."""

STATE_SORT = "state"
"""The sort of states, with the sorts of their values as parts."""

OBJECT_SORT = "object"
"""The sort of what a table says about one object, with the sort of the table as its part."""


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
    """A sort of values; only `state` and `object` have parts."""

    name: str
    parts: tuple["Sort", ...] = ()


@dataclass(frozen=True)
class Label(_Node):
    """The name of a stream generator: a feature and the objects it is about (def. 4.4.6)."""

    feature: Name
    objects: tuple[Name, ...] = ()

    @property
    def text(self) -> str:
        """The label as it is written."""
        objects = ", ".join(each.text for each in self.objects)
        return f"{self.feature.text}[{objects}]" if objects else self.feature.text


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
class UseLinear(_Node):
    """A state may hold a point of the line from the sample before to the sample after."""


@dataclass(frozen=True)
class UseLatest(_Node):
    """States are made at once of the latest values there are; nothing is waited for."""


@dataclass(frozen=True)
class AnyUpdate(_Node):
    """Every sample is wanted."""


@dataclass(frozen=True)
class AnyChange(_Node):
    """A sample is wanted if its value or valid time is new."""


@dataclass(frozen=True)
class AllUpdates(_Node):
    """There is a state when every input has had a sample since the last one."""


@dataclass(frozen=True)
class SampleEvery(_Node):
    """Consecutive samples are one period of valid time apart.

    Attributes:
        period: The sample period.
        deviation: How much the distance may differ from the period; None for not at all.
        longest: How long the period may be made under load; None if it must stay as it is.
    """

    period: Time | Name
    deviation: Time | Name | None = None
    longest: Time | Name | None = None


@dataclass(frozen=True)
class SampleEveryCommonPeriod(_Node):
    """There is a state every greatest common divisor of the sample periods of the inputs."""


@dataclass(frozen=True)
class DelayBeforeApproximation(_Node):
    """How long a synchronisation waits before it approximates a value (def. 7.8.5)."""

    delay: Time | Name


@dataclass(frozen=True)
class MaxDelay(_Node):
    """Samples are at most so much later than their valid times."""

    delay: Time | Name | Endless


@dataclass(frozen=True)
class AtMaxDelay(_Node):
    """A state is made when the maximal delay has passed, never earlier."""


@dataclass(frozen=True)
class Capacity(_Node):
    """How many samples of one input may wait for the others."""

    count: int


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
    | UseLinear
    | UseLatest
    | AnyUpdate
    | AnyChange
    | AllUpdates
    | SampleEvery
    | SampleEveryCommonPeriod
    | DelayBeforeApproximation
    | MaxDelay
    | AtMaxDelay
    | Capacity
    | FromTo
    | To
    | AnyOrder
    | MonotoneOrder
    | StrictOrder
)
"""A constraint of a policy (definitions 4.4.8 and 7.8.4)."""


@dataclass(frozen=True)
class StreamTerm(_Node):
    """A stream: what provides it, and a policy (definition 4.4.14).

    After a synchronisation the policy says how states are made (definition 7.8.6); after anything
    else it is what the receiver requires.
    """

    provider: "Provider"
    constraints: tuple[Constraint, ...] = ()


@dataclass(frozen=True)
class Synchronisation(_Node):
    """One stream of states from several streams (definition 7.8.6)."""

    streams: tuple[StreamTerm, ...]


@dataclass(frozen=True)
class Merging(_Node):
    """One stream with the samples of several streams."""

    streams: tuple[StreamTerm, ...]


@dataclass(frozen=True)
class Mediation(_Node):
    """One stream with the samples of streams that change: a mediation process (def. 3.3.5).

    Attributes:
        stream: What is merged, for each member of the newest set; `member` stands in its labels
            for the member, or is itself the label.
        member: The name of the member.
        members: A stream of sets of objects or labels, or of single ones.
    """

    stream: StreamTerm
    member: Name
    members: StreamTerm


@dataclass(frozen=True)
class SelectedField(_Node):
    """A field of a selection.

    Attributes:
        path: Names joined by points, from the outermost to the innermost.
        pattern: What the field is called in the result; `%PATH%` in it stands for the value of
            another field. None leaves the name as it is.
    """

    path: str
    pattern: str | None = None


@dataclass(frozen=True)
class Condition(_Node):
    """`FIELD = VALUE` in a selection."""

    path: str
    value: Value


@dataclass(frozen=True)
class Selection(_Node):
    """`select FIELDS from STREAM where CONDITIONS`.

    Attributes:
        fields: What is selected; all fields if empty, written as `*`.
        provider: Of the stream to select from.
        conditions: What must hold; all of them.
    """

    fields: tuple[SelectedField, ...]
    provider: "Label | Synchronisation | Merging | Mediation"
    conditions: tuple[Condition, ...] = ()


Provider = Label | Synchronisation | Merging | Mediation | Selection
"""What a stream can be taken from: a stream generator, or a process without a label."""


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


Process = SourceInstance | UnitInstance | Link | Synchronisation | Merging | Mediation | Selection
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
    """`strmgen LABEL = PROCESS with POLICY on failure stop` (definition 4.4.7).

    Attributes:
        label: The name of the generator.
        process: What feeds it.
        constraints: What its samples keep; of a synchronisation, how states are made.
        on_failure: Whether a failure of the process stops everything or ends the process alone.
    """

    label: Label
    process: Process
    constraints: tuple[Constraint, ...] = ()
    on_failure: OnFailure = OnFailure.STOP


@dataclass(frozen=True)
class StreamDeclaration(_Node):
    """`stream NAME = TERM`, an output of the application (definition 4.4.15).

    Attributes:
        name: The name of the stream; like a label it may name objects, as an output that there
            is for each member of a set has to.
        stream: What it is.
    """

    name: Label
    stream: StreamTerm


@dataclass(frozen=True)
class ParameterDeclaration(_Node):
    """`parameter NAME = VALUE`: a name for a value that the caller may replace."""

    name: Name
    default: Value


@dataclass(frozen=True)
class Configuration(_Node):
    """`for each NAME in STREAM { ... }`: a configuration process (definition 3.3.4).

    Attributes:
        member: The name that stands for the member in labels and settings.
        members: A stream of sets of objects, or of single ones.
        declarations: What exists once for each member of the newest set.
    """

    member: Name
    members: StreamTerm
    declarations: "tuple[GeneratorDeclaration | StreamDeclaration | Configuration, ...]"


Declaration = (
    SourceDeclaration
    | UnitDeclaration
    | GeneratorDeclaration
    | StreamDeclaration
    | ParameterDeclaration
    | Configuration
)
"""A statement of KPL."""


@dataclass(frozen=True)
class Specification(_Node, AsList):
    """A KPL specification: declarations in any order (definition 4.4.3)."""

    declarations: tuple[Declaration, ...]

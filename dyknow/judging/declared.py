"""What a specification declares, as far as a judge needs it: processes, streams and policies."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from dyknow.judging.sorts import SortTest
from dyknow.judging.streams import KnownStreams
from dyknow.runtime.failures import OnFailure
from dyknow.runtime.generators import ANYTHING
from dyknow.runtime.names import OUTPUT, Label, input_name, output_name
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Policy
from dyknow.streams.process import ComputationalUnit, Element, Source

__all__ = ["ChangingPart", "DeclaredNetwork", "DeclaredProcess", "DeclaredStream"]


@dataclass(frozen=True, slots=True)
class DeclaredStream:
    """A stream term (Heintz 2009, definition 4.4.14) in its place.

    Attributes:
        topic: `RECEIVER/NUMBER` or `output/NAME`.
        provider: The label of the generator.
        policy: What the stream must keep.
        receiver: The label of the process that receives it, or `output`.
        number: Which input of the receiver, counted from 1; 0 for an output.
    """

    topic: str
    provider: Label
    policy: Policy
    receiver: Label
    number: int

    @classmethod
    def input(
        cls, receiver: Label, number: int, provider: Label, policy: Policy
    ) -> "DeclaredStream":
        """Return an input stream of a process."""
        return cls(input_name(receiver, number), provider, policy, receiver, number)

    @classmethod
    def output(cls, name: str, provider: Label, policy: Policy) -> "DeclaredStream":
        """Return an output stream of the application."""
        return cls(output_name(name), provider, policy, OUTPUT, 0)

    @property
    def is_output(self) -> bool:
        """Whether the application receives the stream."""
        return self.receiver == OUTPUT


@dataclass(frozen=True, slots=True)
class DeclaredProcess:
    """A stream generator and the process that feeds it (definition 4.4.7).

    Attributes:
        label: The name of the generator.
        inputs: The input streams; none for a source.
        make_source: Makes the source; None for a unit, and for a source that cannot be had again.
        make_unit: Makes the unit; None for a source, and for a mediation.
        is_mediation: Whether its inputs change while it works.
        sort: The declared sort of the values, as it is written.
        sort_test: Tells what is wrong with a value that is not of this sort; None if it is not
            known what the sort contains.
        promise: The output policy, which all samples keep.
        on_failure: Whether the whole network stops when the process fails.
    """

    label: Label
    inputs: tuple[DeclaredStream, ...] = ()
    make_source: Callable[[], Source] | None = None
    make_unit: Callable[[], ComputationalUnit] | None = None
    is_mediation: bool = False
    sort: str = "any"
    sort_test: SortTest | None = None
    promise: Policy = ANYTHING
    on_failure: OnFailure = OnFailure.STOP

    @property
    def is_source(self) -> bool:
        """Whether the process has no inputs."""
        return self.make_unit is None and not self.is_mediation

    @property
    def can_be_made(self) -> bool:
        """Whether the process can be had again."""
        return self.make_source is not None or self.make_unit is not None


class ChangingPart(Protocol):
    """What changes by itself in a network; it can only be run again as a whole."""

    @property
    def sources_within(self) -> Collection[str]:
        """The labels of sources that it has inside, without which it cannot be run."""

    def run(
        self, streams: KnownStreams, receive: Callable[[str, Element], None]
    ) -> Sequence[StreamViolation]:
        """Hand to *receive* what its streams should be, by topic; return its violations.

        Raises:
            ProcessError: A process fails on what was recorded.
        """


@dataclass(frozen=True, slots=True)
class DeclaredNetwork:
    """The processes of a specification and the output streams.

    Attributes:
        processes: By label, inputs before those that use them.
        outputs: The output streams.
        changing: What changes by itself, if anything does: configuration blocks and mediations.
    """

    processes: Mapping[Label, DeclaredProcess]
    outputs: tuple[DeclaredStream, ...] = ()
    changing: ChangingPart | None = None

    @property
    def static_topics(self) -> frozenset[str]:
        """The topics of all streams that there are from the beginning to the end."""
        labels = [each.label for each in self.processes.values() if not each.is_mediation]
        inputs = [stream.topic for each in self.processes.values() for stream in each.inputs]
        return frozenset([*labels, *inputs, *(stream.topic for stream in self.outputs)])

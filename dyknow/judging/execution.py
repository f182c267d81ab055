"""What a judge must know of an execution: an interpretation of the symbols of a specification.

An interpretation (Heintz 2009, definition 4.5.1) gives every label and every stream term a
finished stream. Streams go by their topics: the text of a label, `RECEIVER/NUMBER` for input
number NUMBER (from 1) of the process at RECEIVER, and `output/NAME` for an output of the
application.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.process import Element
from dyknow.time import TimePoint

__all__ = ["Execution", "Interpretation"]


class Execution(Protocol):
    """A finished execution, such as a recording."""

    @property
    def until(self) -> TimePoint:
        """The time up to which, inclusive, everything that happened is known."""

    @property
    def topics(self) -> Collection[str]:
        """The topics of the streams whose samples are known."""

    @property
    def existing(self) -> Collection[str] | None:
        """The topics of all streams that there were, recorded or not; None if not known."""

    def contents(self, topic: str) -> Iterable[Element]:
        """Return samples and heartbeats of a stream in the order in which they were recorded.

        Raises:
            DyKnowError: They cannot be read.
        """

    def violations(self) -> Sequence[StreamViolation] | None:
        """Return the violations that were published, or None if they are not known."""


@dataclass(frozen=True)
class Interpretation:
    """An execution that is held in memory.

    Attributes:
        until: The time up to which everything is known.
        streams: Samples and heartbeats by topic.
        published: The violations; None if they are not known.
        existing: The topics of all streams that there were; None if not known.
    """

    until: TimePoint
    streams: Mapping[str, Sequence[Element]]
    published: Sequence[StreamViolation] | None = ()
    existing: Collection[str] | None = None

    @property
    def topics(self) -> Collection[str]:
        """The topics of all streams."""
        return self.streams.keys()

    def contents(self, topic: str) -> Sequence[Element]:
        """Return samples and heartbeats of a stream."""
        return self.streams[topic]

    def violations(self) -> Sequence[StreamViolation] | None:
        """Return the violations that were published."""
        return self.published

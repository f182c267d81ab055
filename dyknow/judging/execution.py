"""What a judge must know of an execution: an interpretation of the symbols of a specification.

An interpretation (Heintz 2009, definition 4.5.1) gives every label and every stream term a
finished stream. Streams go by their topics: the text of a label, `RECEIVER/NUMBER` for input
number NUMBER (from 1) of the process at RECEIVER, and `output/NAME` for an output of the
application.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.sample import Heartbeat, Sample
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
    def outputs(self) -> Collection[str]:
        """The names of the output streams that were asked for."""

    def samples(self, topic: str) -> Sequence[Sample[Any]]:
        """Return the samples of a stream in the order in which they became available."""

    def heartbeats(self, topic: str) -> Sequence[Heartbeat]:
        """Return the heartbeats of a stream in the order in which they became available."""

    def violations(self) -> Sequence[StreamViolation] | None:
        """Return the violations that were published, or None if they are not known."""


@dataclass(frozen=True)
class Interpretation:
    """An execution that is held in memory.

    Attributes:
        until: The time up to which everything is known.
        streams: The samples by topic.
        outputs: The names of the output streams that were asked for.
        published: The violations; None if they are not known.
        beats: The heartbeats by topic, where there are any.
    """

    until: TimePoint
    streams: Mapping[str, Sequence[Sample[Any]]]
    outputs: Collection[str]
    published: Sequence[StreamViolation] | None = ()
    beats: Mapping[str, Sequence[Heartbeat]] = field(default_factory=dict)

    @property
    def topics(self) -> Collection[str]:
        """The topics of all streams."""
        return self.streams.keys()

    def samples(self, topic: str) -> Sequence[Sample[Any]]:
        """Return the samples of a stream."""
        return self.streams[topic]

    def heartbeats(self, topic: str) -> Sequence[Heartbeat]:
        """Return the heartbeats of a stream."""
        return self.beats.get(topic, ())

    def violations(self) -> Sequence[StreamViolation] | None:
        """Return the violations that were published."""
        return self.published

"""The execution that a recording is of."""

import json
from collections.abc import Collection, Iterator, Sequence

from dyknow.kpl.description import NetworkDescription
from dyknow.recordings.channels import ChannelRole
from dyknow.recordings.recording import Recording
from dyknow.runtime.names import input_name, output_name
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.process import Element
from dyknow.time import TimePoint

__all__ = ["RecordedExecution"]


class RecordedExecution:
    """What a recording says of the execution that it is of.

    Of a recording that was cut off, or that ended with an error, the last instant is left out:
    nobody knows what else there was. Neither is it known what came after a gap in one that was
    recovered. What stands there for viewers alone is no part of the execution.

    Attributes:
        topics: The topics of the streams whose samples are known.
        existing: The topics of all streams that there were when the recording began.
        is_whole: Whether the recording goes on to the end of the execution.
        until: The time up to which, inclusive, everything that happened is known.

    Args:
        recording: The recording.
        until: The end of the run; by default the last time at which something was recorded.
        without: Topics that are no part of the execution.
        is_complete: Whether the run was recorded to its end, as far as the application knows.
    """

    def __init__(
        self,
        recording: Recording,
        until: TimePoint | None = None,
        without: Collection[str] = (),
        *,
        is_complete: bool = True,
    ) -> None:
        self._recording = recording
        streams = recording.streams
        self.topics: Collection[str] = [
            topic
            for topic, stream in streams.items()
            if stream.role in (ChannelRole.GENERATOR, ChannelRole.STREAM) and topic not in without
        ]
        self.existing = _existing(recording.metadata.get("network"))
        last = max((streams[topic].last or 0 for topic in self.topics), default=0)
        is_closed = recording.damage is None and recording.path.suffix != ".partial"
        self.is_whole = is_closed and is_complete
        if recording.gap is not None:
            last = min(last, recording.gap)
        self.until = TimePoint(max(last, until or 0) if self.is_whole else last - 1)

    def contents(self, topic: str) -> Iterator[Element]:
        """Yield samples and heartbeats of a stream.

        Raises:
            RecordingError: They cannot be read.
        """
        for element in self._recording.contents(topic):
            if element.available_time <= self.until:
                yield element

    def violations(self) -> Sequence[StreamViolation]:
        """Return the violations that were published."""
        return [
            each
            for each in self._recording.violations()
            if each.violation.noticed_at <= self.until
        ]


def _existing(network: str | None) -> frozenset[str] | None:
    """Return the topics of all streams that the description of a network tells of."""
    if network is None:
        return None
    description: NetworkDescription = json.loads(network)
    labels = [each["label"] for each in description["generators"]]
    inputs = [
        input_name(each["label"], stream["number"])
        for each in description["generators"]
        for stream in each["inputs"]
    ]
    outputs = [output_name(each["name"]) for each in description["outputs"]]
    return frozenset([*labels, *inputs, *outputs])

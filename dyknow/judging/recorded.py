"""The execution that a recording is of."""

from collections.abc import Collection, Iterator, Sequence

from dyknow.recordings.channels import ChannelRole
from dyknow.recordings.recording import Recording
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.process import Element
from dyknow.time import TimePoint

__all__ = ["RecordedExecution"]


class RecordedExecution:
    """What a recording says of the execution that it is of.

    Of a recording that was cut off, the last instant is left out: nobody knows what else there
    was. What stands there for viewers alone is no part of the execution.

    Args:
        recording: The recording.
        outputs: The names of the output streams that were asked for.
        until: The end of the run; by default the last time at which something was recorded.
        without: Topics that are no part of the execution.
    """

    def __init__(
        self,
        recording: Recording,
        outputs: Collection[str],
        until: TimePoint | None = None,
        without: Collection[str] = (),
    ) -> None:
        self.outputs = outputs
        self._recording = recording
        streams = recording.streams
        self.topics: Collection[str] = [
            topic
            for topic, stream in streams.items()
            if stream.role in (ChannelRole.GENERATOR, ChannelRole.STREAM) and topic not in without
        ]
        last = max((streams[topic].last or 0 for topic in self.topics), default=0)
        self.until = TimePoint(max(last, until or 0) if recording.damage is None else last - 1)

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

"""What takes the samples of a stream as they flow and has them written."""

from collections import deque
from collections.abc import Callable
from typing import Any

from google.protobuf.message import Message

from dyknow.recordings.channels import HEAD, HEAD_TAGS, HEARTBEAT, NO_VALUE_MARK
from dyknow.recordings.origins import N_ORIGINS, ORIGIN_BYTES
from dyknow.recordings.topics import Topic
from dyknow.recordings.writing import FileWriter
from dyknow.streams.process import Element
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.time import TimePoint

__all__ = ["GeneratorTap", "StreamTap", "ViewTap"]

_NEVER = TimePoint(-(1 << 63))
_VALID_TIME, _AVAILABLE_TIME = HEAD_TAGS


class GeneratorTap:
    """Writes the samples and heartbeats of a stream generator; call it with each of them.

    Attributes:
        last: When the last sample became available.
    """

    def __init__(self, topic: Topic) -> None:
        self.last = _NEVER
        self._topic = topic
        self._recent: deque[tuple[Sample[Any], int]] = deque()
        self._recent_bytes = 0
        self._has_keys = True
        self._waiting: list[StreamTap] = []

    def __call__(self, element: Element) -> None:
        """Write a sample or a heartbeat."""
        if isinstance(element, Heartbeat):
            _put_heartbeat(self._topic, element)
            return
        self._remember(element, _put_sample(self._topic, element))
        if self._waiting:
            self.settle()

    def origin_of(self, sample: Sample[Any]) -> TimePoint | None:
        """Return when the sample became available whose value *sample* has, if one is known.

        Of several with that very value it is the one with the latest valid time that is not
        later than that of *sample*. Values are compared by identity.
        """
        if not self._has_keys or not self._recent:
            return None
        if self._recent[-1][0] is sample:
            return sample.available_time
        value = sample.value
        known = [each for each, _ in self._recent if each.value is value]
        if not known:
            return None
        fitting = [each for each in known if each.valid_time <= sample.valid_time] or known
        return max(fitting, key=lambda each: (each.valid_time, each.available_time)).available_time

    def await_origin(self, tap: "StreamTap") -> None:
        """Settle *tap* when the next sample has been written."""
        self._waiting.append(tap)

    def settle(self) -> None:
        """Let the streams that wait for an origin do without."""
        waiting, self._waiting = self._waiting, []
        for tap in waiting:
            tap.settle()

    def _remember(self, sample: Sample[Any], size: int) -> None:
        if sample.available_time <= self.last:
            self._has_keys = False  # available times tell nothing apart in such a stream
        self.last = sample.available_time
        self._recent.append((sample, size))
        self._recent_bytes += size
        while len(self._recent) > N_ORIGINS or self._recent_bytes > ORIGIN_BYTES:
            self._recent_bytes -= self._recent.popleft()[1]


class StreamTap:
    """Writes the samples and heartbeats of an adapted stream; call it with each of them.

    A value that the provider's tap has written lately is referred to and not written again. At
    one instant this tap may be called before the provider's: a sample that is ahead of the
    provider waits until that has caught up.
    """

    def __init__(self, topic: Topic, provider: GeneratorTap | None) -> None:
        self._topic = topic
        self._provider = provider
        self._ahead: Sample[Any] | None = None

    def __call__(self, element: Element) -> None:
        """Write a sample or a heartbeat."""
        self.settle()
        if isinstance(element, Heartbeat):
            _put_heartbeat(self._topic, element)
        elif self._provider is not None and self._provider.last < element.available_time:
            self._ahead = element
            self._provider.await_origin(self)
        else:
            self._put(element)

    def settle(self) -> None:
        """Write the sample that waits, if one does."""
        sample, self._ahead = self._ahead, None
        if sample is not None:
            self._put(sample)

    def _put(self, sample: Sample[Any]) -> None:
        origin = self._provider.origin_of(sample) if self._provider is not None else None
        if origin is None:
            _put_sample(self._topic, sample)
        else:
            head = _head(sample.valid_time, sample.available_time)
            self._topic.put_reference(head, sample, origin)


class ViewTap:
    """Writes what a function makes of samples, for viewers; call it with each sample."""

    def __init__(
        self,
        writer: FileWriter,
        channel: int,
        convert: Callable[[Sample[Any]], Message | bytes | None],
    ) -> None:
        self._writer = writer
        self._channel = channel
        self._convert = convert
        self._count = 0

    def __call__(self, sample: Sample[Any]) -> None:
        """Write what there is to be seen of *sample*, if anything."""
        message = self._convert(sample)
        if message is None:
            return
        self._count += 1
        data = message if isinstance(message, bytes) else message.SerializeToString()
        times = max(0, sample.available_time), max(0, sample.valid_time)
        self._writer.add_message(self._channel, times[0], data, times[1], self._count)


def _put_sample(topic: Topic, sample: Sample[Any]) -> int:
    head = _head(sample.valid_time, sample.available_time)
    if sample.value is NO_VALUE:
        topic.put(head + NO_VALUE_MARK, sample.available_time, sample.valid_time)
        return len(head)
    return topic.put_value(head, sample)


def _put_heartbeat(topic: Topic, heartbeat: Heartbeat) -> None:
    head = _head(heartbeat.until, heartbeat.available_time)
    topic.put(head + HEARTBEAT, heartbeat.available_time, heartbeat.until)


def _head(valid_time: TimePoint, available_time: TimePoint) -> bytes:
    return HEAD.pack(_VALID_TIME, valid_time, _AVAILABLE_TIME, available_time)

"""Whether two recordings have the same streams, byte by byte."""

from collections import deque
from collections.abc import Collection
from dataclasses import dataclass
from itertools import zip_longest

from dyknow.recordings.messages import times_of
from dyknow.recordings.recording import RecordedMessage, Recording
from dyknow.time import TimePoint, text_from_duration

__all__ = ["Difference", "compare"]


@dataclass(frozen=True, slots=True)
class Difference:
    """The first place at which the streams of one topic differ.

    Attributes:
        topic: The topic.
        number: Which message of the stream it is, from 1; 0 if one recording has no such stream.
        time: When it became available: the earlier one of the two.
        what: What differs.
    """

    topic: str
    number: int
    time: TimePoint
    what: str

    def __str__(self) -> str:
        if not self.number:
            return f"stream '{self.topic}': {self.what}"
        time = text_from_duration(self.time)
        return f"stream '{self.topic}', message {self.number}, at {time} ms: {self.what}"


def compare(
    one: Recording, other: Recording, topics: Collection[str] | None = None
) -> list[Difference]:
    """Return the first difference of each stream that differs, the earliest first.

    Both recordings are read once, side by side. Compared are the streams of *topics*, or all but
    those for viewers alone.
    """
    known = one.topics | other.topics if topics is None else frozenset(topics)
    shared = known & one.topics & other.topics
    differences = [_missing(topic, one) for topic in known - shared]
    streams = {topic: _Pair(topic) for topic in shared}
    for left, right in zip_longest(one.messages(shared), other.messages(shared)):
        if left is not None:
            streams[left.topic].take(left, 0)
        if right is not None:
            streams[right.topic].take(right, 1)
    found = [pair.difference() for pair in streams.values()]
    differences += [each for each in found if each is not None]
    return sorted(differences, key=lambda each: (each.time, each.topic))


def _missing(topic: str, one: Recording) -> Difference:
    which = "first" if topic in one.topics else "second"
    return Difference(topic, 0, TimePoint(0), f"only the {which} recording has it")


class _Pair:
    """The two streams of one topic, as far as they have been read."""

    def __init__(self, topic: str) -> None:
        self._topic = topic
        self._n_same = 0
        self._ahead: deque[RecordedMessage] = deque()
        self._side = 0
        self._found: Difference | None = None

    def take(self, message: RecordedMessage, side: int) -> None:
        """Take the next message of one side; compare it with the other's when that is known."""
        if self._found is not None:
            return
        if not self._ahead or self._side == side:
            self._ahead.append(message)
            self._side = side
            return
        waiting = self._ahead.popleft()
        if waiting == message:
            self._n_same += 1
            return
        self._found = self._between(waiting, message)
        self._ahead.clear()

    def difference(self) -> Difference | None:
        """Return the first difference, when both sides have been read to their ends."""
        if self._found is not None or not self._ahead:
            return self._found
        longer = "first" if self._side == 0 else "second"
        _, available_time = times_of(self._ahead[0].data)
        what = f"only the {longer} recording has it"
        return Difference(self._topic, self._n_same + 1, available_time, what)

    def _between(self, waiting: RecordedMessage, message: RecordedMessage) -> Difference:
        one, other = (waiting, message) if self._side == 0 else (message, waiting)
        (valid_1, available_1), (valid_2, available_2) = times_of(one.data), times_of(other.data)
        what = _first_of(
            ("it became available at", available_1, available_2),
            ("its valid time is", valid_1, valid_2),
        )
        time = min(available_1, available_2)
        return Difference(self._topic, self._n_same + 1, time, what or "it has another value")


def _first_of(*compared: tuple[str, TimePoint, TimePoint]) -> str:
    for what, left, right in compared:
        if left != right:
            return f"{what} {text_from_duration(left)} and {text_from_duration(right)}"
    return ""

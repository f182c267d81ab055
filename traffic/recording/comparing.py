"""Are the streams of two recordings the same, byte by byte?"""

from collections import deque
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader

__all__ = ["Comparison", "Difference", "compare"]


@dataclass(frozen=True, slots=True)
class Difference:
    """The first place at which two streams of one topic differ.

    Attributes:
        topic: The topic.
        number: How many samples before it are the same.
        recorded: Available and valid time and size of the sample in the first recording, None if
            that has ended.
        computed: Likewise in the second.
    """

    topic: str
    number: int
    recorded: tuple[int, int, int] | None
    computed: tuple[int, int, int] | None

    @property
    def at(self) -> int:
        """The available time of the earlier of the two samples, nanoseconds."""
        times = [each[0] for each in (self.recorded, self.computed) if each is not None]
        return min(times)


@dataclass(frozen=True, slots=True)
class Comparison:
    """What came of comparing two recordings.

    Attributes:
        topics: What was compared, in order of name.
        differences: The first difference of each stream that has one, the earliest first.
    """

    topics: tuple[str, ...]
    differences: tuple[Difference, ...]

    @property
    def identical(self) -> int:
        """The number of streams that are the same."""
        return len(self.topics) - len(self.differences)


class _Item(NamedTuple):
    """A message as it stands in a file; its schema says what its bytes mean."""

    schema: bytes
    topic: str
    available_time: int
    valid_time: int
    data: bytes

    @property
    def summary(self) -> tuple[int, int, int]:
        return self.available_time, self.valid_time, len(self.data)


def compare(recorded: Path, computed: Path, topics: Collection[str]) -> Comparison:
    """Compare the streams of *topics* in two recordings; both are read once, side by side."""
    streams = {topic: _Stream(topic) for topic in sorted(topics)}
    for one, other in zip_longest(_items(recorded, streams), _items(computed, streams)):
        if one is not None:
            streams[one.topic].take(one, 0)
        if other is not None:
            streams[other.topic].take(other, 1)
    found = [difference for each in streams.values() if (difference := each.difference())]
    return Comparison(tuple(streams), tuple(sorted(found, key=lambda each: each.at)))


class _Stream:
    """Two streams of one topic, as far as they have been read."""

    def __init__(self, topic: str) -> None:
        self._topic = topic
        self._n_same = 0
        self._ahead: deque[_Item] = deque()
        self._side = 0
        self._difference: Difference | None = None

    def take(self, item: _Item, side: int) -> None:
        """Take the next message of one side, and compare it with that of the other if known."""
        if self._difference is not None:
            return
        if not self._ahead or self._side == side:
            self._ahead.append(item)
            self._side = side
            return
        other = self._ahead.popleft()
        if item == other:
            self._n_same += 1
            return
        pair = (item, other) if side == 0 else (other, item)
        self._difference = self._between(*(each.summary for each in pair))
        self._ahead.clear()

    def difference(self) -> Difference | None:
        """Return the first difference, when both sides have been read to their ends."""
        if self._difference is None and self._ahead:
            summary = self._ahead[0].summary
            pair = (summary, None) if self._side == 0 else (None, summary)
            return self._between(*pair)
        return self._difference

    def _between(
        self, recorded: tuple[int, int, int] | None, computed: tuple[int, int, int] | None
    ) -> Difference:
        return Difference(self._topic, self._n_same, recorded, computed)


def _items(path: Path, topics: Collection[str]) -> Iterator[_Item]:
    """Yield the messages of *topics* in the order in which they were written."""
    schemas: dict[int, bytes] = {0: b""}
    channels: dict[int, tuple[bytes, str]] = {}
    with path.open("rb") as file:
        for record in StreamReader(file).records:
            match record:
                case Schema(id=number, data=data):
                    schemas[number] = data
                case Channel(id=number, topic=topic) if topic in topics:
                    channels[number] = schemas[record.schema_id], topic
                case Message(channel_id=number) if number in channels:
                    times = record.log_time, record.publish_time
                    yield _Item(*channels[number], *times, record.data)
                case _:
                    pass

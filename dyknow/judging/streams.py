"""The streams of an execution, put in order, with those at hand that were used last."""

from collections import OrderedDict
from collections.abc import Iterable, Iterator, Sequence
from heapq import merge
from typing import Any

from dyknow.errors import DyKnowError
from dyknow.judging.execution import Execution
from dyknow.recordings.errors import DamagedRecordingError, MissingCodecError
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.stream import is_fluent_stream
from dyknow.time import TimePoint

__all__ = ["KnownStreams"]

_KEPT = 4
"""How many streams are kept in memory."""


class KnownStreams:
    """The recorded streams by topic, each in strict order of available time.

    A recording that is out of order is put in order, and of samples with one available time the
    first is taken; the judge has reported it then.
    """

    def __init__(self, execution: Execution) -> None:
        self._execution = execution
        self._topics = frozenset(execution.topics)
        self._recent: OrderedDict[str, _Contents] = OrderedDict()

    def __contains__(self, topic: str) -> bool:
        return topic in self._topics

    def __getitem__(self, topic: str) -> Sequence[Sample[Any]]:
        samples = self.as_recorded(topic)
        if is_fluent_stream(samples):
            return samples
        by_time: dict[int, Sample[Any]] = {}
        for sample in samples:
            by_time.setdefault(sample.available_time, sample)
        return [by_time[time] for time in sorted(by_time)]

    @property
    def until(self) -> TimePoint:
        """The time up to which, inclusive, everything that happened is known."""
        return self._execution.until

    @property
    def topics(self) -> frozenset[str]:
        """The topics of the recorded streams."""
        return self._topics

    def may_have_been(self, topic: str) -> bool:
        """Return whether there may have been a stream of this topic, recorded or not."""
        existing = self._execution.existing
        return topic in self._topics or existing is None or topic in existing

    def heartbeats(self, topic: str) -> Sequence[Heartbeat]:
        """Return the heartbeats of a stream."""
        return self._contents(topic).heartbeats

    def elements(self, topic: str) -> Iterator[Element]:
        """Yield samples and heartbeats in order of available time; at one time, samples first.

        A heartbeat promises no more than what is kept; the judge has reported it then.
        """
        samples, heartbeats = self[topic], self.heartbeats(topic)
        if not heartbeats:
            return iter(samples)
        return merge(samples, _kept_promises(samples, heartbeats), key=_available_time)

    def as_recorded(self, topic: str) -> Sequence[Sample[Any]]:
        """Return the samples of a stream as they stand in the recording."""
        return self._contents(topic).samples

    def fault(self, topic: str) -> str | None:
        """Return why a stream cannot be what was recorded, and know it no more, or None.

        Raises:
            DamagedRecordingError, MissingCodecError: The execution itself cannot be read.
        """
        try:
            self._contents(topic)
        except (DamagedRecordingError, MissingCodecError):
            raise
        except DyKnowError as error:
            self._topics -= {topic}
            return str(error)
        return None

    def _contents(self, topic: str) -> "_Contents":
        if topic not in self._recent:
            self._recent[topic] = _Contents(self._execution.contents(topic))
            if len(self._recent) > _KEPT:
                self._recent.popitem(last=False)
        self._recent.move_to_end(topic)
        return self._recent[topic]


class _Contents:
    """What was recorded of one stream."""

    def __init__(self, elements: Iterable[Element]) -> None:
        self.samples: list[Sample[Any]] = []
        self.heartbeats: list[Heartbeat] = []
        for element in elements:
            if isinstance(element, Sample):
                self.samples.append(element)
            else:
                self.heartbeats.append(element)


def _kept_promises(
    samples: Sequence[Sample[Any]], heartbeats: Sequence[Heartbeat]
) -> list[Heartbeat]:
    kept: list[Heartbeat] = []
    later = list(samples)
    earliest: TimePoint | None = None
    for heartbeat in reversed(heartbeats):
        while later and later[-1].available_time > heartbeat.available_time:
            valid_time = later.pop().valid_time
            earliest = valid_time if earliest is None else min(earliest, valid_time)
        until = heartbeat.until if earliest is None else min(heartbeat.until, earliest - 1)
        kept.append(Heartbeat(TimePoint(until), heartbeat.available_time))
    return kept[::-1]


def _available_time(element: Element) -> TimePoint:
    return element.available_time

"""A finished stream, prepared for many questions about what was valid when.

The answers are those of the functions in `dyknow.streams.stream` (Heintz 2009, section 4.3).
"""

from bisect import bisect_right
from collections.abc import Iterator
from itertools import accumulate
from typing import Any

from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.streams.stream import FluentStream
from dyknow.time import TimePoint

__all__ = ["History"]


class History:
    """Answers questions about a fluent stream in logarithmic time, if it is nearly in order.

    A sample that is valid earlier than those available before it costs a step more for each of
    them. The stream must not change any more.
    """

    def __init__(self, stream: FluentStream) -> None:
        self._stream = stream
        self._available = [sample.available_time for sample in stream]
        valid = [sample.valid_time for sample in stream]
        # Up to each sample, the highest valid time, and from it on, the lowest.
        self._highest = list(accumulate(valid, max))
        self._lowest = list(accumulate(reversed(valid), min))[::-1]

    def last_available(self, time: TimePoint) -> Sample[Any]:
        """Return the sample that became available last, up to *time* (definition 4.3.8)."""
        count = bisect_right(self._available, time)
        return self._stream[count - 1] if count else NO_SAMPLE

    def most_recent_at(self, time: TimePoint, query_time: TimePoint) -> Sample[Any]:
        """Return the sample of definition 4.3.11, the most recent for *time* at *query_time*."""
        best = NO_SAMPLE
        for at in self._candidates(time, query_time):
            if self._highest[at] <= best.valid_time:
                break
            sample = self._stream[at]
            if best.valid_time < sample.valid_time <= time:
                best = sample
        return best

    def _candidates(self, time: TimePoint, query_time: TimePoint) -> Iterator[int]:
        """Yield positions from the last backwards; all beyond are too new or too late."""
        available = bisect_right(self._available, query_time)
        return iter(range(min(available, bisect_right(self._lowest, time)) - 1, -1, -1))

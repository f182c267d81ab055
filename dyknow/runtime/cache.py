"""The last samples of a stream generator, and the questions that can be asked of them.

The questions are those of the stream generator interfaces of Heintz (2009), *DyKnow: A
Stream-Based Knowledge Processing Middleware Framework*, section 5.3.2. A question about valid
times looks at every sample that is held.
"""

from collections import deque
from collections.abc import Sequence
from typing import Any

from dyknow.errors import ValueNotAvailableError
from dyknow.runtime.names import Label
from dyknow.streams.sample import BEGINNING_OF_TIME, Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["CACHE_SIZE", "CachedStream"]

CACHE_SIZE = 8
"""How many samples are held where nobody says otherwise: few, since a sample may be an image."""


class CachedStream:
    """The newest samples of a stream, in order of available time.

    Attributes:
        label: The name of the generator whose samples these are.
        lost_until: The highest valid time of the samples that are not held any more.
    """

    __slots__ = ("_cache", "label", "lost_until")

    def __init__(self, label: Label, capacity: int = CACHE_SIZE) -> None:
        """Hold up to *capacity* samples."""
        self.label = label
        self._cache: deque[Sample[Any]] = deque(maxlen=_checked(capacity))
        self.lost_until = BEGINNING_OF_TIME

    @property
    def size(self) -> int:
        """How many samples are held."""
        return len(self._cache)

    @property
    def capacity(self) -> int:
        """How many samples can be held; it can be set, and when it shrinks the oldest go."""
        return self._cache.maxlen or 0

    @capacity.setter
    def capacity(self, capacity: int) -> None:
        held, self._cache = self._cache, deque(maxlen=_checked(capacity))
        for sample in held:
            self.hold(sample)

    @property
    def samples(self) -> tuple[Sample[Any], ...]:
        """All samples that are held, in order of available time."""
        return tuple(self._cache)

    def latest(self) -> Sample[Any]:
        """Return the sample with the highest available time.

        Raises:
            ValueNotAvailableError: No sample is held.
        """
        return self.nth_latest(0)

    def nth_latest(self, n: int) -> Sample[Any]:
        """Return the *n*th latest sample; number 0 is the latest.

        Raises:
            ValueNotAvailableError: So many samples are not held.
        """
        if not 0 <= n < len(self._cache):
            raise ValueNotAvailableError(self.label, f"latest sample number {n}")
        return self._cache[-1 - n]

    def slice(self, first: int, last: int) -> Sequence[Sample[Any]]:
        """Return the samples from number *first* to number *last*, inclusive; 0 is the oldest.

        Raises:
            ValueNotAvailableError: Not all of them are held.
        """
        for number in (first, last):
            if not 0 <= number < len(self._cache):
                raise ValueNotAvailableError(self.label, f"sample number {number}")
        return [self._cache[number] for number in range(first, last + 1)]

    def latest_valid(self) -> Sample[Any]:
        """Return the sample with the highest valid time; of several, the latest.

        Raises:
            ValueNotAvailableError: No sample is held.
        """
        if not self._cache:
            raise ValueNotAvailableError(self.label, "sample")
        return max(reversed(self._cache), key=_valid_time)

    def closest_at_or_before(self, time: TimePoint) -> Sample[Any]:
        """Return the sample with the highest valid time up to *time*; of several, the latest.

        Raises:
            ValueNotAvailableError: No such sample is held.
        """
        found = self.find_at_or_before(time)
        if found is None:
            wanted = f"sample with a valid time up to {text_from_duration(time)}"
            raise ValueNotAvailableError(self.label, wanted)
        return found

    def find_at_or_before(self, time: TimePoint) -> Sample[Any] | None:
        """Return what `closest_at_or_before` returns, or None if there is no such sample."""
        candidates = (sample for sample in reversed(self._cache) if sample.valid_time <= time)
        return max(candidates, key=_valid_time, default=None)

    def between(self, first: TimePoint, last: TimePoint) -> Sequence[Sample[Any]]:
        """Return all samples with valid times from *first* to *last*, inclusive."""
        return [sample for sample in self._cache if first <= sample.valid_time <= last]

    def snapshot(self) -> "CachedStream":
        """Return a cache of the same samples, with room for one more."""
        held = CachedStream(self.label, self.capacity + 1)
        held.lost_until = self.lost_until
        for sample in self._cache:
            held.hold(sample)
        return held

    def reset(self) -> None:
        """Forget all samples."""
        lost = [sample.valid_time for sample in self._cache]
        self.lost_until = max([self.lost_until, *lost])
        self._cache.clear()

    def hold(self, sample: Sample[Any]) -> None:
        """Hold the next sample, in place of the oldest if there is no room."""
        cache = self._cache
        if len(cache) == cache.maxlen:
            self.lost_until = max(self.lost_until, cache[0].valid_time)
        cache.append(sample)


def _checked(capacity: int) -> int:
    if capacity < 1:
        raise ValueError(f"a cache holds at least one sample, found a capacity of {capacity}")
    return capacity


def _valid_time(sample: Sample[Any]) -> TimePoint:
    return sample.valid_time

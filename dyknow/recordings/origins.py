"""The last samples of a generator, for adapted streams that refer to them."""

from collections import deque
from collections.abc import Callable
from typing import Any

from dyknow.recordings.messages import ReadMessage, Reference, available_time_of
from dyknow.streams.process import Element
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["N_ORIGINS", "ORIGIN_BYTES", "Origins"]

N_ORIGINS = 64
"""How many samples of a generator streams refer to: those written last."""

ORIGIN_BYTES = 16_000_000
"""How many bytes they may take, as written."""

Find = Callable[[TimePoint], Sample[Any] | None]
"""Returns the sample that became available at a time, from wherever it is in the file."""


class _Origin:
    """A message that may be referred to, read when it is needed, and once."""

    __slots__ = ("_element", "available_time", "data", "read")

    def __init__(self, data: bytes, read: ReadMessage) -> None:
        self.available_time = available_time_of(data)
        self.data = data
        self.read = read
        self._element: Element | Reference | None = None

    def element(self) -> Element | Reference:
        """Return what the message says."""
        if self._element is None:
            self._element = self.read(self.data)
        return self._element


class Origins:
    """Finds the samples that streams refer to, each as one object however often it is found."""

    def __init__(self, find: Find) -> None:
        """Remember nothing yet; *find* is asked for what is not among the last samples."""
        self._find = find
        self._recent: deque[_Origin] = deque()
        self._bytes = 0

    def keep(self, data: bytes, read: ReadMessage) -> Callable[[], Element | Reference]:
        """Remember a message of the generator; return what reads it."""
        origin = _Origin(data, read)
        self._recent.append(origin)
        self._bytes += len(data)
        while len(self._recent) > N_ORIGINS or self._bytes > ORIGIN_BYTES:
            self._bytes -= len(self._recent.popleft().data)
        return origin.element

    def sample(self, available_time: TimePoint) -> Sample[Any] | None:
        """Return the sample that became available at a time, if the recording has it."""
        for origin in reversed(self._recent):
            if origin.available_time == available_time:
                element = origin.element()
                if isinstance(element, Sample):
                    return element
        return self._find(available_time)

"""Events put in order of time, as far as a stated delay allows."""

from collections.abc import Iterator
from heapq import heappop, heappush

from chronicles.constraints import INSTANT, floor_to_instant
from chronicles.events import Event
from dyknow.time import Duration

__all__ = ["Ordering"]


class Ordering:
    """Lets events through in order of time; each may come so much later than the latest one.

    An event waits until one has come that is later by *max_delay*. What comes before the clock,
    which is the latest time less the delay, is late. Events of one instant, a millisecond, are at
    one time.
    """

    def __init__(self, max_delay: Duration) -> None:
        self._max_delay = max_delay
        self._waiting: list[tuple[int, int, Event, str]] = []
        self._clock: int | None = None
        self._n_events = 0

    @property
    def clock(self) -> int | None:
        """The time before which nothing can be put in order any more; None before any event."""
        return self._clock

    def put(self, event: Event, place: str) -> Iterator[tuple[Event, str]]:
        """Take in an event that is not late; yield those that have waited long enough."""
        clock = floor_to_instant(event.time - self._max_delay)
        if self._clock is None or clock > self._clock:
            self._clock = clock
        self._n_events += 1
        heappush(self._waiting, (event.time, self._n_events, event, place))
        while self._waiting and self._waiting[0][0] < self._clock + INSTANT:
            _, _, due, where = heappop(self._waiting)
            yield due, where

    def rest(self) -> Iterator[tuple[Event, str]]:
        """Yield what still waits, at the end of the input."""
        while self._waiting:
            _, _, event, place = heappop(self._waiting)
            yield event, place

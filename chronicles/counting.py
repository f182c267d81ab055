"""Which counted events have come, for counters that may have to look back.

Most forbidden events need no record: the instances that they concern know so when they come. A
record is kept where an instance can learn later that an earlier event counts, because its
interval begins before the event that anchors it, or a variable gets its value later.
"""

from bisect import bisect_left

from chronicles.models import Counter
from chronicles.patterns import Values

__all__ = ["CountedEvents"]

_LEAST_TO_SWEEP = 1024


class CountedEvents:
    """The times of the events of one counter, by the values of its variables.

    Attributes:
        n_times: How many times are kept.
    """

    def __init__(self, counter: Counter) -> None:
        self._counter = counter
        self._times: dict[Values, list[int]] = {}
        self.n_times = 0
        self._full = _LEAST_TO_SWEEP

    @property
    def is_full(self) -> bool:
        """Whether it is time to forget what nothing can ask for any more."""
        return self.n_times >= self._full

    def add(self, key: Values, time: int) -> None:
        """Note an event; times come in order."""
        times = self._times.get(key)
        if times is None:
            self._times[key] = [time]
        else:
            times.append(time)
        self.n_times += 1

    def count(self, key: Values, begin: int, end: int) -> int:
        """Return the number of events from *begin* up to but not at *end*."""
        times = self._times.get(key)
        if times is None or end <= begin:
            return 0
        return bisect_left(times, end) - bisect_left(times, begin)

    def nth(self, key: Values, begin: int, n: int) -> int | None:
        """Return the time of the event after *n* others from *begin* on, if it has come."""
        times = self._times.get(key)
        if times is None:
            return None
        at = bisect_left(times, begin) + n
        return times[at] if at < len(times) else None

    def forget_before(self, time: int) -> None:
        """Forget the events before *time*."""
        for key in list(self._times):
            times = self._times[key]
            n_old = bisect_left(times, time)
            if n_old == len(times):
                del self._times[key]
            elif n_old:
                del times[:n_old]
            self.n_times -= n_old
        self._full = max(_LEAST_TO_SWEEP, 2 * self.n_times)

"""At which valid times there are states: on a grid, or where the inputs have samples."""

from bisect import bisect_left
from collections.abc import Iterable

from dyknow.streams.state_buffers import FOREVER, Buffer
from dyknow.time import Duration, TimePoint

__all__ = ["Grid", "Updates"]


class Grid:
    """Time-points that are one period apart.

    Where the start is not told, it is the latest of the first valid times of the inputs.

    Attributes:
        current: The next one to be settled, `FOREVER` before the start is known.
    """

    def __init__(self, start: TimePoint | None, period: Duration) -> None:
        self.current = FOREVER
        self._period = period
        self._start = FOREVER
        if start is not None:
            self.current = self._start = start

    def note(self, buffer: Buffer, valid_time: TimePoint) -> None:  # noqa: ARG002, updates need it
        """Let the buffer forget what lies between two time-points and is of no use to either."""
        samples = buffer.samples
        is_dense = (
            len(samples) > 1 and samples[-1].valid_time - samples[-2].valid_time < self._period
        )
        if is_dense and self._start != FOREVER:
            buffer.thin_out(self._start, self._period)

    def move_on(self) -> None:
        """Go on to the time after the current one."""
        self.current = TimePoint(self.current + self._period)

    def has(self, valid_time: TimePoint) -> bool:
        """Return whether the time lies on the grid."""
        return valid_time >= self._start and (valid_time - self._start) % self._period == 0

    def begins(self, buffers: Iterable[Buffer]) -> TimePoint:
        """Return when the first valid times of all inputs are certain, `FOREVER` if never yet."""
        if self._start != FOREVER:
            return FOREVER
        return max(_certain(buffer) for buffer in buffers)

    def begin(self, buffers: Iterable[Buffer]) -> TimePoint:
        """Start at the latest of the first valid times of the inputs, and return it."""
        self.current = self._start = max(buffer.first for buffer in buffers)
        return self._start


class Updates:
    """The valid times of the inputs' samples, in order and each once.

    Attributes:
        current: The earliest one that has not been settled, `FOREVER` if there is none.
    """

    def __init__(self) -> None:
        self.current = FOREVER
        self._times: list[TimePoint] = []

    def note(self, buffer: Buffer, valid_time: TimePoint) -> None:  # noqa: ARG002, a grid needs it
        """Take in that an input has a new sample for a state to come."""
        times = self._times
        if times and times[-1] == valid_time:
            return
        if not times or times[-1] < valid_time:
            times.append(valid_time)
        else:
            at = bisect_left(times, valid_time)
            if times[at] != valid_time:
                times.insert(at, valid_time)
        self.current = times[0]

    def move_on(self) -> None:
        """Go on to the time after the current one."""
        del self._times[0]
        self.current = self._times[0] if self._times else FOREVER

    def has(self, valid_time: TimePoint) -> bool:  # noqa: ARG002, a grid needs it
        """Return True: each valid time of a sample is one of a state."""
        return True


def _certain(buffer: Buffer) -> TimePoint:
    """Return when it is certain that no sample to come has a lower valid time than the first."""
    if buffer.first == FOREVER:
        return FOREVER
    if buffer.complete >= buffer.first - 1:
        return TimePoint(-1)
    return FOREVER if buffer.max_delay is None else TimePoint(buffer.first - 1 + buffer.max_delay)

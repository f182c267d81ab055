"""Whether the state of a valid time can be made yet, or has been waited for long enough.

The rule is that of Heintz (2009), section 7.8.2, procedure *synchronized*: a state is made when
all is known about its valid time; or when a delay has passed, if every input has a value or an
approximation; or, whatever is known, when the maximal delay has passed.
"""

from collections.abc import Sequence

from dyknow.streams.state_buffers import FOREVER, Buffer
from dyknow.streams.state_policy import Settling, StatePolicy
from dyknow.time import TimePoint

__all__ = ["Waiting"]


class Waiting:
    """What one valid time waits for.

    Attributes:
        time: The valid time, `FOREVER` if there is none.
        n_open: How many inputs can still say something about it.
        newest: The highest valid time of a sample of any input.
    """

    def __init__(self, policy: StatePolicy, buffers: Sequence[Buffer]) -> None:
        self.time = FOREVER
        self.n_open = len(buffers)
        self.newest = TimePoint(-1)
        self._buffers = buffers
        self._max_delay = FOREVER if policy.max_delay is None else policy.max_delay
        self._patience = policy.delay_before_approximation
        self._is_early = policy.settling is Settling.EARLY
        self._is_patient = policy.max_delay is None and self._patience is None
        self._has_end = policy.end is not None
        self._has_alarms = False
        self._deadline: TimePoint | None = None
        self._critical: Buffer | None = None

    def begin(self, time: TimePoint) -> None:
        """Wait for a first valid time, or anew after the inputs have changed what they keep."""
        self._has_alarms = not self._is_patient or any(
            buffer.max_delay is not None for buffer in self._buffers
        )
        self.turn_to(time)

    def turn_to(self, time: TimePoint) -> None:
        """Wait for another valid time."""
        self.time = time
        self._deadline = None
        if time == FOREVER:
            return
        n_open = 0
        for buffer in self._buffers:
            is_final = self._is_early and buffer.settles(time)
            buffer.is_final = is_final
            if not is_final:
                n_open += 1
        self.n_open = n_open

    def look_at(self, buffer: Buffer) -> None:
        """Take in that an input has said something."""
        if buffer.is_final or not self._is_early:
            return
        if buffer.settles(self.time):
            buffer.is_final = True
            self.n_open -= 1
            if buffer is self._critical:
                self._deadline = None
        else:
            self._deadline = None

    @property
    def is_vain(self) -> bool:
        """Whether all inputs have ended before the valid time, so that it will have no state."""
        return all(b.complete >= FOREVER for b in self._buffers) and not self._exists()

    def is_over(self, now: TimePoint) -> bool:
        """Return whether the state is to be made at *now*."""
        if self.n_open and (not self._has_alarms or self.deadline() > now):
            return False
        return self._is_passed() or (self.time <= now and self._exists())

    def due(self) -> TimePoint | None:
        """Return when there will be no more waiting, if that is known."""
        if self.time == FOREVER or (self.n_open and not self._has_alarms) or not self._exists():
            return None
        deadline = self.deadline() if self.n_open else TimePoint(0)
        if deadline == FOREVER:
            return None
        return deadline if self._is_passed() else max(deadline, self.time)

    def deadline(self) -> TimePoint:
        """Return when open inputs are no longer waited for, `FOREVER` if always."""
        if self._deadline is None:
            latest = TimePoint(-1)
            for buffer in self._buffers:
                if not buffer.is_final:
                    ends = self._patience_with(buffer)
                    if ends >= latest:
                        latest, self._critical = ends, buffer
            self._deadline = min(latest, TimePoint(self.time + self._max_delay))
        return self._deadline

    def _patience_with(self, buffer: Buffer) -> TimePoint:
        """Return until when an open input is waited for, if only the others allowed it."""
        ends = FOREVER
        if self._is_early and buffer.max_delay is not None:
            ends = TimePoint(buffer.needed(self.time) + buffer.max_delay)
        if self._patience is not None and buffer.has_value(self.time):
            ends = min(ends, TimePoint(buffer.awaited(self.time) + self._patience))
        return min(ends, FOREVER)

    def _is_passed(self) -> bool:
        """Return whether an input has a sample that is as late as the valid time."""
        return self.newest >= self.time

    def _exists(self) -> bool:
        """Return whether the inputs go on as far as the valid time.

        As long as no delay of the policy asks for a state, that only inputs can tell, lest states
        after their last samples depended on when they are known to have ended.
        """
        if self._has_end or self._is_passed():
            return True
        if not self._is_patient and any(buffer.complete < FOREVER for buffer in self._buffers):
            return True
        if any(self.time <= buffer.heard for buffer in self._buffers):
            return True
        return all(self.time <= buffer.promised for buffer in self._buffers)

"""Changes of a network while it works: each is made between two instants, never within one."""

from collections import deque
from collections.abc import Callable

from dyknow.time import TimePoint

__all__ = ["Changes"]


class Changes:
    """When the network may be changed.

    A change that is asked for while an instant is being worked on is made when the work of that
    instant is done, and any other one at once, so that all work of one instant is done by one
    network.

    Attributes:
        begin: The first time-point at which what is changed now can have an effect.
        epoch: The number of instants that have been begun; equal when nothing has happened
            between two changes.
    """

    def __init__(self) -> None:
        self.begin = TimePoint(0)
        self.epoch = 0
        self._is_working = False
        self._waiting: deque[Callable[[], object]] = deque()

    def make(self, change: Callable[[], object]) -> None:
        """Make a change now, or when the work of the current instant is done."""
        if self._is_working:
            self._waiting.append(change)
        else:
            change()

    def enter(self, instant: TimePoint) -> None:
        """Begin to work on an instant."""
        self._is_working = True
        self.epoch += 1
        self.begin = TimePoint(instant + 1)

    def leave(self) -> None:
        """End the work on the instant, and make the changes that have waited for it."""
        self._is_working = False
        while self._waiting:
            self._waiting.popleft()()

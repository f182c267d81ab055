"""Clocks: when, outside the network, an instant is worked on.

The instants of a run and all that happens at them are the same with every clock: a clock can only
let the kernel wait before it works on an instant, and measure how late its work was done.
"""

import time
from collections.abc import Callable
from threading import Event
from typing import Protocol

from dyknow.runtime.statistics import Delays
from dyknow.time import SECOND, Duration, TimePoint

__all__ = ["Clock", "VirtualClock", "WallClock", "wait_seconds"]


class Clock(Protocol):
    """Says when an instant is to be worked on."""

    def start(self, now: TimePoint) -> None:
        """Begin a run in which everything up to *now* has been done."""

    def await_instant(self, instant: TimePoint) -> None:
        """Return when the work of *instant* may begin."""

    def finish(self, instant: TimePoint) -> None:
        """Take note that the work of *instant* is done."""


class VirtualClock:
    """Stands at the instant that is worked on, and moves as fast as the work allows."""

    def start(self, now: TimePoint) -> None:
        """Do nothing."""

    def await_instant(self, instant: TimePoint) -> None:
        """Return at once."""

    def finish(self, instant: TimePoint) -> None:
        """Do nothing."""


def wait_seconds(seconds: float) -> None:
    """Let *seconds* pass; an interruption from the keyboard ends that."""
    Event().wait(seconds)


class WallClock:
    """Lets every instant begin when it is that time outside, counted from the run's beginning.

    The work of an instant is late by the time from the instant to its completion; the network
    has met the deadline if that is at most *deadline*.

    Attributes:
        deadline: How late the work of an instant may be done.
        lateness: How late the work of all instants was done: number, mean, percentiles.
        last_lateness: How late the work of the last instant was done.
        n_missed: How many instants have missed the deadline.
    """

    def __init__(
        self,
        deadline: Duration,
        now_ns: Callable[[], int] = time.monotonic_ns,
        sleep: Callable[[float], None] = wait_seconds,
    ) -> None:
        """Take the time from *now_ns*, in nanoseconds, and let *sleep* wait so many seconds."""
        self.deadline = deadline
        self.lateness = Delays()
        self.last_lateness = Duration(0)
        self.n_missed = 0
        self._now_ns = now_ns
        self._sleep = sleep
        self._origin = 0

    def start(self, now: TimePoint) -> None:
        """Let it be *now* at this moment; what passed outside between two runs is left out."""
        self._origin = self._now_ns() - now

    def await_instant(self, instant: TimePoint) -> None:
        """Wait until *instant*, or not at all if it is over."""
        while (left := self._origin + instant - self._now_ns()) > 0:
            self._sleep(left / SECOND)

    def finish(self, instant: TimePoint) -> None:
        """Measure how late the work of *instant* is done."""
        self.last_lateness = Duration(max(0, self._now_ns() - self._origin - instant))
        self.lateness.add(self.last_lateness)
        self.n_missed += self.last_lateness > self.deadline

"""What a performance is: one driver, or several, doing one act once."""

from collections.abc import Callable, Iterator
from typing import Protocol

__all__ = ["Performance", "Script", "VehicleGoneError"]


class Performance(Protocol):
    """One act done once; told before each step of the simulator what time it is."""

    def step(self, now: float) -> bool:
        """Do what is due and return whether the performance is over.

        Args:
            now: Time of the frame that the coming step makes, seconds; negative in the warm-up.
        """


class VehicleGoneError(Exception):
    """A vehicle that a performance drives is no longer there; this ends the performance."""


class Script:
    """A performance written as a function with `yield` wherever a step of the simulator comes.

    The function reads from top to bottom what the driver does. It sees the time as `Stage.now`,
    and what it has to give back it gives back in `finally` or a `with` block, because it is
    closed when a vehicle is gone.

    Args:
        play: Begins the play when it is first stepped.
    """

    def __init__(self, play: Callable[[], Iterator[None]]) -> None:
        self._play = play()

    def step(self, now: float) -> bool:
        """Go on to the next `yield`; over when there is none."""
        del now  # a script reads it from the stage
        return next(self._play, self) is self

"""The two kinds of knowledge process that a network is made of: sources and units.

Neither reads a clock, sleeps, or draws unseeded random numbers. Whoever runs them, usually
`dyknow.runtime.kernel`, tells them what happens, and they answer with samples. Between samples
they may put heartbeats, which those receivers get that listen to them.
"""

from collections.abc import Iterable, Iterator
from typing import Any, Protocol, runtime_checkable

from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import TimePoint

__all__ = ["ComputationalUnit", "Element", "HearsHeartbeats", "Reactive", "Source"]

Element = Sample[Any] | Heartbeat
"""What a process may put into its stream."""


class Source(Protocol):
    """A process without input streams (Heintz 2009, definition 4.3.14)."""

    def samples(self) -> Iterator[Element]:
        """Yield samples and heartbeats in order of available time; read lazily."""


class ComputationalUnit(Protocol):
    """A deterministic process from streams to a stream (definition 4.3.15).

    The unit is applied at every time at which one of its input streams has a new sample, to the
    last available sample of each (the join of definition 4.3.16).
    """

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Element]:
        """Take in the joined inputs and yield what follows from them.

        *inputs* has one sample for each input stream, in the order of the declaration: the last
        available one, or `NO_SAMPLE` while a stream has none. The new ones among them have
        `now` as their available time.
        """

    def advance(self, now: TimePoint) -> Iterable[Element]:
        """Let time pass up to and including *now* and yield what has fallen due."""

    def due(self) -> TimePoint | None:
        """Return when the unit next has something to say without new input, if ever."""


@runtime_checkable
class HearsHeartbeats(Protocol):
    """A unit that wants to know how far its input streams are complete."""

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> Iterable[Element]:
        """Take in a heartbeat of input number *at* and yield what follows from it.

        At one instant the new samples of all inputs come before their heartbeats.
        """


class Reactive:
    """What units have in common that speak only when a sample arrives."""

    def advance(self, now: TimePoint) -> Iterable[Sample[Any]]:  # noqa: ARG002, the protocol's
        """Emit nothing: time alone changes nothing."""
        return ()

    def due(self) -> TimePoint | None:
        """Never: the unit only answers to input."""
        return None

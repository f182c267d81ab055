"""The two kinds of knowledge process that a network is made of: sources and units.

Neither reads a clock, sleeps, or draws unseeded random numbers. Whoever runs them, usually
`dyknow.runtime.kernel`, tells them what happens, and they answer with samples.
"""

from collections.abc import Iterable, Iterator
from typing import Any, Protocol

from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["ComputationalUnit", "Reactive", "Source"]


class Source(Protocol):
    """A process without input streams (Heintz 2009, definition 4.3.14)."""

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield the samples in order of available time; read lazily, as time goes on."""


class ComputationalUnit(Protocol):
    """A deterministic process from streams to a stream (definition 4.3.15).

    The unit is applied at every time at which one of its input streams has a new sample, to the
    last available sample of each (the join of definition 4.3.16).
    """

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Any]]:
        """Take in the joined inputs and yield what follows from them.

        *inputs* has one sample for each input stream, in the order of the declaration: the last
        available one, or `NO_SAMPLE` while a stream has none. The new ones among them have
        `now` as their available time.
        """

    def advance(self, now: TimePoint) -> Iterable[Sample[Any]]:
        """Let time pass up to and including *now* and yield what has fallen due."""

    def due(self) -> TimePoint | None:
        """Return when the unit next has something to say without new input, if ever."""


class Reactive:
    """What units have in common that speak only when a sample arrives."""

    def advance(self, now: TimePoint) -> Iterable[Sample[Any]]:  # noqa: ARG002, the protocol's
        """Emit nothing: time alone changes nothing."""
        return ()

    def due(self) -> TimePoint | None:
        """Never: the unit only answers to input."""
        return None

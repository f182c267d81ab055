"""Knowledge processing domains: what counts as a value, a sample, a stream.

The definitions are those of Heintz (2009), *DyKnow: A Stream-Based Knowledge Processing
Middleware Framework*, sections 4.3.1, 4.3.3, 4.3.4 and 4.5.2. The program itself does not ask: it
carries whatever sources and units produce. Whoever specifies an application, or judges a run
of one, says with a domain what may be carried.
"""

from collections.abc import Callable, Container, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from dyknow.streams.sample import NO_SAMPLE, NO_VALUE, Sample
from dyknow.streams.stream import FluentStream, is_fluent_stream, join
from dyknow.streams.table import Table
from dyknow.time import TimePoint

__all__ = [
    "TIME",
    "Domain",
    "SourceFunction",
    "UnitFunction",
    "computed_stream",
    "source_stream",
    "values",
]

TIME: Final = range(1 << 63)
"""The time-points of the program: whole nanoseconds from 0 on."""

SourceFunction = Callable[[TimePoint], Sample[Any]]
"""A source as a function of time, `NO_SAMPLE` where it has nothing to say (definition 4.3.14)."""

UnitFunction = Callable[[TimePoint, tuple[Sample[Any], ...], Any], tuple[Sample[Any], Any]]
"""A computational unit as a function (definition 4.3.15).

From a time-point, a sample of each input and the state so far to a sample and the next state.
"""


@dataclass(frozen=True)
class Domain:
    """Objects, time-points and primitive values (definition 4.3.1).

    Attributes:
        objects: What the symbols of the application can stand for.
        primitives: The simple values that are neither objects nor time-points.
        time_points: The temporal domain; its order and arithmetic are those of integers.

    Raises:
        ValueError: `NO_VALUE` is among the objects, time-points or primitive values.
    """

    objects: Container[Any]
    primitives: Container[Any]
    time_points: Container[Any] = TIME

    def __post_init__(self) -> None:
        if any(_holds(part, NO_VALUE) for part in self._parts):
            raise ValueError("no value of a domain may be NO_VALUE")

    def is_simple_value(self, value: Any) -> bool:
        """Return whether *value* is an object, a time-point or a primitive (def. 4.3.2)."""
        return any(_holds(part, value) for part in self._parts)

    def is_value(self, value: Any) -> bool:
        """Return whether *value* is a value (definition 4.3.3).

        A table is the tuple of its objects' states, written as columns, an array that of its
        elements, and a mapping that of what it maps names to.
        """
        match value:
            case _ if value is NO_VALUE or self.is_simple_value(value):
                return True
            case tuple():
                return all(map(self.is_value, value))
            case Table():
                symbols = map(value.symbol, value.ids.tolist())
                return all(map(self.is_value, (*symbols, *value.columns.values())))
            case Mapping():
                return all(map(self.is_value, value.values()))
            case np.ndarray():
                return all(map(self.is_value, value.ravel().tolist()))
            case _:
                return False

    def is_sample(self, sample: Sample[Any]) -> bool:
        """Return whether *sample* is one of this domain, or `NO_SAMPLE` (definition 4.3.4)."""
        if sample is NO_SAMPLE:
            return True
        times = (sample.available_time, sample.valid_time)
        return all(_holds(self.time_points, time) for time in times) and self.is_value(
            sample.value
        )

    def is_fluent_stream(self, samples: FluentStream) -> bool:
        """Return whether *samples* are a fluent stream of this domain (definition 4.3.5)."""
        return is_fluent_stream(samples) and all(map(self.is_sample, samples))

    @property
    def _parts(self) -> Sequence[Container[Any]]:
        return self.objects, self.time_points, self.primitives


def source_stream(source: SourceFunction, times: Iterable[TimePoint]) -> FluentStream:
    """Return the stream of a generator that belongs to a source (definition 4.5.7)."""
    samples = [sample for time in times if (sample := source(time)) is not NO_SAMPLE]
    return sorted(samples, key=lambda sample: sample.available_time)


def computed_stream(unit: UnitFunction, *inputs: FluentStream) -> FluentStream:
    """Return the stream of a generator that belongs to a computational unit (def. 4.5.8).

    The unit is applied to every element of the join, beginning with the state `NO_VALUE`. Where it
    answers with `NO_SAMPLE` the stream has nothing.
    """
    state: Any = NO_VALUE
    computed: list[Sample[Any]] = []
    for joined in join(*inputs):
        sample, state = unit(joined.available_time, joined.value, state)
        if sample is not NO_SAMPLE:
            computed.append(sample)
    return computed


def values(samples: Iterable[Sample[Any]]) -> list[Any]:
    """Return the values that *samples* have, in their order (definition 4.5.5)."""
    return [sample.value for sample in samples if sample is not NO_SAMPLE]


def _holds(part: Container[Any], value: Any) -> bool:
    """Return whether *value* is in *part*; what is made of several values never is."""
    if isinstance(value, tuple | Table) or not isinstance(value, Hashable):
        return False
    if isinstance(part, range):
        return type(value) is int and value in part
    return value in part

"""One element of a fluent stream: a value, when it held, and when it became available.

Between samples a stream may also say that there is nothing more up to a valid time: a heartbeat.

The definitions are those of Heintz (2009), *DyKnow: A Stream-Based Knowledge Processing
Middleware Framework*, section 4.3.
"""

from dataclasses import dataclass
from typing import Final, Generic, TypeVar, final

from dyknow.time import Duration, TimePoint

__all__ = [
    "BEGINNING_OF_TIME",
    "END_OF_TIME",
    "NO_SAMPLE",
    "NO_VALUE",
    "Heartbeat",
    "NoValue",
    "Sample",
]

T = TypeVar("T")


@final
class NoValue:
    """The explicit absence of a value at a time; `NO_VALUE` is its only member and is false."""

    __slots__ = ()

    def __bool__(self) -> bool:
        return False

    def __repr__(self) -> str:
        return "NO_VALUE"


NO_VALUE: Final = NoValue()


@dataclass(slots=True)
class Sample(Generic[T]):
    """A value with its two times (definition 4.3.4); immutable by convention.

    Not frozen: a frozen dataclass with slots takes three times as long to make, and samples are
    made for every stream and frame.

    Attributes:
        value: What held.
        valid_time: When it held in the world.
        available_time: When the sample reached the receiver; unique within a stream.
    """

    value: T
    valid_time: TimePoint
    available_time: TimePoint

    @property
    def delay(self) -> Duration:
        """Available time minus valid time."""
        return Duration(self.available_time - self.valid_time)

    def __deepcopy__(self, memo: object) -> "Sample[T]":
        return self


BEGINNING_OF_TIME: Final = TimePoint(-(1 << 63))
"""Earlier than every valid time, also of what is dated back to before the run."""

END_OF_TIME: Final = TimePoint((1 << 63) - 1)
"""Later than every valid time: a heartbeat until then says that a stream has ended."""


@dataclass(slots=True)
class Heartbeat:
    """The promise that no later sample of a stream has a valid time up to *until*, inclusive.

    With it a silent stream does not hold up those that wait for it. A heartbeat is not a sample:
    ordinary units never see one.

    Attributes:
        until: Up to which valid time the stream is complete.
        available_time: When this was said; samples that were available before it precede it.
    """

    until: TimePoint
    available_time: TimePoint


NO_SAMPLE: Final = Sample(NO_VALUE, TimePoint(-1), TimePoint(-1))
"""What a join yields for a stream that has no sample yet; earlier than every time-point."""

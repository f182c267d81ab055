"""What a receiver requires of a stream, as a value.

The five kinds of constraint and their defaults are those of Heintz (2009), *DyKnow: A
Stream-Based Knowledge Processing Middleware Framework*, section 4.4.5; what each of them means
is definition 4.5.11, written down in `dyknow.streams.conformance`.
"""

from dataclasses import dataclass
from enum import Enum

from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = [
    "ANY_CHANGE",
    "ANY_UPDATE",
    "Approximation",
    "Change",
    "Constraint",
    "Order",
    "Policy",
    "SampleEvery",
    "Unsampled",
    "Violation",
]


class Approximation(Enum):
    """What may be done about a sample that a policy needs and that does not come."""

    NONE = "no approximation"
    MOST_RECENT = "use most recent"


class Order(Enum):
    """How the valid times of consecutive samples must relate."""

    ANY = "any order"
    MONOTONE = "monotone order"
    STRICT = "strict order"


class Unsampled(Enum):
    """How consecutive samples must differ in a stream that is not sampled."""

    ANY_UPDATE = "any update"
    ANY_CHANGE = "any change"


ANY_UPDATE = Unsampled.ANY_UPDATE
ANY_CHANGE = Unsampled.ANY_CHANGE


@dataclass(frozen=True, slots=True)
class SampleEvery:
    """Consecutive samples are exactly one period of valid time apart; implies strict order."""

    period: Duration


Change = Unsampled | SampleEvery
"""A change constraint."""


@dataclass(frozen=True, slots=True)
class Policy:
    """The constraints that a receiver puts on a stream; what is left out restricts nothing.

    Attributes:
        approximation: What to do about samples that do not come.
        change: How consecutive samples must differ.
        max_delay: The largest delay of a sample; None for any.
        start: The earliest valid time; None where the policy does not say, which means 0.
        end: The latest valid time; None for no end.
        order: How valid times must follow each other.

    Raises:
        ValueError: No stream can be required to keep these constraints together.
    """

    approximation: Approximation = Approximation.NONE
    change: Change = ANY_UPDATE
    max_delay: Duration | None = None
    start: TimePoint | None = None
    end: TimePoint | None = None
    order: Order = Order.ANY

    def __post_init__(self) -> None:
        if faults := [*self._limits(), *self._needs()]:
            raise ValueError("; ".join(faults))

    @property
    def period(self) -> Duration | None:
        """The sample period, if the stream is sampled."""
        return self.change.period if isinstance(self.change, SampleEvery) else None

    @property
    def first(self) -> TimePoint:
        """The earliest valid time, 0 where the policy does not say."""
        return self.start or TimePoint(0)

    @property
    def effective_order(self) -> Order:
        """The order, counting that a sampled stream is strictly ordered."""
        return Order.STRICT if isinstance(self.change, SampleEvery) else self.order

    def covers(self, valid_time: TimePoint) -> bool:
        """Return whether the duration constraint lets *valid_time* through."""
        return self.first <= valid_time and (self.end is None or valid_time <= self.end)

    def allows_delay(self, delay: Duration) -> bool:
        """Return whether the delay constraint lets *delay* through."""
        return self.max_delay is None or delay <= self.max_delay

    def _limits(self) -> list[str]:
        faults = []
        if self.period is not None and self.period <= 0:
            faults.append("the sample period must be positive")
        if self.max_delay is not None and self.max_delay < 0:
            faults.append("the maximal delay must not be negative")
        if self.start is not None and self.start < 0:
            faults.append("no time-point lies before 0")
        if self.end is not None and self.end < self.first:
            start, end = text_from_duration(self.first), text_from_duration(self.end)
            faults.append(f"the stream would end at {end} before it begins at {start}")
        return faults

    def _needs(self) -> list[str]:
        if self.approximation is Approximation.NONE:
            return []
        has = {
            "'sample every'": self.period is not None,
            "'from' a time 'to' a time or 'oo'": self.start is not None,
            "a finite 'max delay'": self.max_delay is not None,
        }
        missing = [what for what, there in has.items() if not there]
        return [f"'use most recent' needs {' and '.join(missing)}"] if missing else []


class Constraint(Enum):
    """The kinds of constraint, as violations name them."""

    APPROXIMATION = "approximation"
    CHANGE = "change"
    DELAY = "delay"
    DURATION = "duration"
    ORDER = "order"


@dataclass(frozen=True, slots=True)
class Violation:
    """A constraint that was not, or could not be, kept at one place of a stream.

    Attributes:
        constraint: The kind of constraint.
        valid_time: Of the sample that breaks the constraint or is missing.
        noticed_at: When it was certain.
        reason: What was expected and what came.
    """

    constraint: Constraint
    valid_time: TimePoint
    noticed_at: TimePoint
    reason: str

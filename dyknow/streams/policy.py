"""What a receiver requires of a stream, as a value.

The five kinds of constraint and their defaults are those of Heintz (2009), *DyKnow: A
Stream-Based Knowledge Processing Middleware Framework*, section 4.4.5; what each of them means
is definition 4.5.11, written down in `dyknow.streams.conformance`.
"""

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from dyknow.streams.sample import Sample
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


EXACTLY = Duration(0)
"""No deviation from the sample period."""


@dataclass(frozen=True, slots=True)
class SampleEvery:
    """Consecutive samples are one period of valid time apart; implies strict order.

    The deviation is that of Heintz, *Semantically Grounded Stream Reasoning Integrated with
    ROS*, section III. Where a longest period is given the stream counts as less
    important: under load its period may be any multiple of *period* up to *longest*.

    Attributes:
        period: The time from one valid time to the next.
        deviation: By how much that time may be shorter or longer.
        longest: The longest period that will do under load; None for *period* itself.
    """

    period: Duration
    deviation: Duration = EXACTLY
    longest: Duration | None = None

    @property
    def longest_period(self) -> Duration:
        """The longest period allowed, *period* where the constraint does not say."""
        return self.period if self.longest is None else self.longest

    def periods(self) -> range:
        """Return every period that the stream may have."""
        return range(self.period, self.longest_period + 1, self.period)

    def allows_step(self, step: int) -> bool:
        """Return whether the valid times of consecutive samples may be *step* apart."""
        times = max(1, -(-(step - self.deviation) // self.period))
        nearest = min(times * self.period, self.longest_period)
        return abs(step - nearest) <= self.deviation

    def faults(self) -> list[str]:
        """Return why no stream can be sampled like this, if none can."""
        faults = []
        period, deviation = text_from_duration(self.period), text_from_duration(self.deviation)
        if self.period <= 0:
            return ["the sample period must be positive"]
        if not 0 <= self.deviation < self.period:
            faults.append(
                f"the deviation must be at least 0 and less than the period of {period}, "
                f"found {deviation}"
            )
        if self.longest is not None and (self.longest < self.period or self.longest % self.period):
            longest = text_from_duration(self.longest)
            faults.append(
                f"the longest period must be a multiple of the period of {period}, found {longest}"
            )
        return faults


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
        if isinstance(self.change, SampleEvery):
            faults += self.change.faults()
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
        faults = [f"'use most recent' needs {' and '.join(missing)}"] if missing else []
        if isinstance(self.change, SampleEvery) and self.change.deviation:
            faults.append("'use most recent' puts samples on the grid and allows no deviation")
        return faults


class Constraint(Enum):
    """What a stream can break: a kind of constraint, or one of the rules that all streams keep."""

    APPROXIMATION = "approximation"
    CHANGE = "change"
    DELAY = "delay"
    DURATION = "duration"
    ORDER = "order"
    AVAILABILITY = "availability"
    ORIGIN = "origin"
    OMISSION = "omission"


@dataclass(frozen=True, slots=True)
class Violation:
    """A constraint that was not, or could not be, kept at one place of a stream.

    The violations of a stream are also the side stream of what was left out of it against the
    wish of its policy: nothing is dropped unseen.

    Attributes:
        constraint: What was broken.
        valid_time: Of the sample that breaks the constraint or is missing.
        noticed_at: When it was certain.
        reason: What was expected and what came.
        sample: The sample that was left out, or that is at fault; None if one is missing.
        definition: The number of the definition (Heintz 2009) that is broken.
    """

    constraint: Constraint
    valid_time: TimePoint
    noticed_at: TimePoint
    reason: str
    sample: Sample[Any] | None = field(default=None, compare=False)
    definition: str = field(default="4.5.11", kw_only=True)

"""How states are made from several streams, as a value.

A state synchronisation policy (Heintz 2009, *DyKnow: A Stream-Based Knowledge Processing
Middleware Framework*, definitions 7.8.4 and 7.8.5) has a duration, a change, an approximation and
a delay constraint and a delay before approximation. To the thesis' states at regular times this
adds its two other kinds (section 7.8, figure 7.9), states at each update of any input and states
when all inputs have been updated; linear approximation; and the choice between its basic and its
improved algorithm. In KPL the constraints read as the values of the enumerations here do.
"""

from dataclasses import dataclass
from enum import Enum

from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = ["CAPACITY", "Occasion", "Settling", "StateApproximation", "StatePolicy"]

CAPACITY = 1000
"""How many samples of one input may wait for the other inputs, unless a policy says otherwise."""


class Occasion(Enum):
    """At which valid times there are states."""

    ANY_UPDATE = "any update"
    """Whenever any input has a sample."""
    ANY_CHANGE = "any change"
    """As `any update`, without the states that are equal to the one before."""
    ALL_UPDATES = "all updates"
    """When every input has had a sample since the last state."""
    SAMPLED = "sample every"
    """At regular times, one sample period apart."""


class StateApproximation(Enum):
    """What stands in a state for an input that has no sample of exactly its valid time."""

    NONE = "no approximation"
    """Nothing: every value in a state has the valid time of the state."""
    MOST_RECENT = "use most recent"
    """The value of the sample with the highest valid time before."""
    LINEAR = "use linear"
    """The point on the line from the sample before to the sample after."""


class Settling(Enum):
    """When a state is made."""

    EARLY = "early"
    """As soon as no sample to come can change it (the improved algorithm, thesis 7.8.2)."""
    AT_MAX_DELAY = "at max delay"
    """When the maximal delay has passed, always (the basic algorithm, thesis 7.8.1)."""


@dataclass(frozen=True, slots=True)
class StatePolicy:
    """How states are made; as it stands, one for each valid time that all inputs have.

    Attributes:
        occasion: At which valid times there are states.
        period: The sample period of sampled states; None for the greatest common divisor of the
            sample periods of the inputs, which must then be sampled.
        start: The earliest valid time of a state. None leaves it to the inputs: with approximation
            and in sampled streams states begin when every input has had its first sample.
        end: The latest valid time of a state; None for no end.
        max_delay: How long after its valid time a state may be waited for; None for as long as it
            takes.
        approximation: What stands for a sample that an input does not have.
        delay_before_approximation: How long a sample that may still come is preferred to an
            approximation that is there; None for as long as it may come.
        settling: When a state is made.
        capacity: How many samples of one input may wait for the others; beyond that the earliest
            state is given up, as if the maximal delay had passed.

    Raises:
        ValueError: The constraints contradict each other, or one could have no effect.
    """

    occasion: Occasion = Occasion.ANY_UPDATE
    period: Duration | None = None
    start: TimePoint | None = None
    end: TimePoint | None = None
    max_delay: Duration | None = None
    approximation: StateApproximation = StateApproximation.NONE
    delay_before_approximation: Duration | None = None
    settling: Settling = Settling.EARLY
    capacity: int = CAPACITY

    def __post_init__(self) -> None:
        if faults := [*self._limits(), *self._delays(), *self._needs()]:
            raise ValueError("; ".join(faults))

    @property
    def is_sampled(self) -> bool:
        """Whether states come at regular times."""
        return self.occasion is Occasion.SAMPLED

    @property
    def is_approximated(self) -> bool:
        """Whether something may stand for a sample that an input does not have."""
        return self.approximation is not StateApproximation.NONE

    @property
    def is_linear(self) -> bool:
        """Whether the samples before and after stand for a sample that an input does not have."""
        return self.approximation is StateApproximation.LINEAR

    def _limits(self) -> list[str]:
        faults = []
        if self.period is not None and self.period <= 0:
            faults.append("the sample period must be positive")
        if self.start is not None and self.start < 0:
            faults.append("no time-point lies before 0")
        first = self.start or TimePoint(0)
        if self.end is not None and self.end < first:
            start, end = text_from_duration(first), text_from_duration(self.end)
            faults.append(f"the states would end at {end} before they begin at {start}")
        if self.capacity < 1:
            faults.append(f"the capacity must be at least 1, found {self.capacity}")
        return faults

    def _delays(self) -> list[str]:
        faults = []
        if self.max_delay is not None and self.max_delay < 0:
            faults.append("the maximal delay must not be negative")
        patience = self.delay_before_approximation
        if patience is None:
            return faults
        if patience < 0:
            faults.append("the delay before approximation must not be negative")
        if self.max_delay is not None and patience > self.max_delay:
            waits, ends = text_from_duration(patience), text_from_duration(self.max_delay)
            faults.append(
                f"a delay before approximation of {waits} has no effect: "
                f"the maximal delay of {ends} has passed by then"
            )
        return faults

    def _needs(self) -> list[str]:
        faults = []
        if self.period is not None and not self.is_sampled:
            faults.append(f"'{self.occasion.value}' has no sample period")
        if self.occasion is Occasion.ALL_UPDATES and not self.is_approximated:
            faults.append("'all updates' needs an approximation, such as 'use most recent'")
        if self.delay_before_approximation is not None and not self.is_approximated:
            faults.append("'delay before approximation' needs an approximation")
        if self.settling is Settling.AT_MAX_DELAY:
            if self.max_delay is None:
                faults.append("'at max delay' needs a finite 'max delay'")
            if self.delay_before_approximation is not None:
                faults.append("'at max delay' leaves 'delay before approximation' without effect")
        return faults

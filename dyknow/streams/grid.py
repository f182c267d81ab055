"""What the samplers share: available times, violations, and arithmetic on the grid."""

from typing import Any, Final

from dyknow.streams.ordering import NEVER
from dyknow.streams.policy import Constraint, SampleEvery, Violation
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = ["NOT_BEGUN", "Publisher", "next_on_grid", "refuse_foreign", "valid_time_of"]

NOT_BEGUN: Final = -2 * NEVER
"""Earlier than every time-point by more than every duration."""


class Publisher:
    """Gives samples their available times and keeps the violations of a sampled stream.

    Attributes:
        last: When the last of the samples became available that were not handed on at once.
    """

    __slots__ = ("last", "violations")

    def __init__(self) -> None:
        self.last = TimePoint(-1)
        self.violations: list[Violation] = []

    def pass_on(self, sample: Sample[Any], now: TimePoint) -> Sample[Any]:
        """Return *sample*, available now or a nanosecond after the one before."""
        if sample.available_time == now > self.last:
            self.last = now
            return sample
        return self.make(sample.value, sample.valid_time, now)

    def make(self, value: Any, valid_time: TimePoint, now: TimePoint) -> Sample[Any]:
        """Return a new sample, available now or a nanosecond after the one before."""
        self.last = now if now > self.last else TimePoint(self.last + 1)
        return Sample(value, valid_time, self.last)

    def heartbeat(self, until: int, now: TimePoint) -> Heartbeat:
        """Return a heartbeat that follows all samples handed on."""
        return Heartbeat(TimePoint(until), max(now, self.last))

    def report_missing(self, first: int, count: int, change: SampleEvery, now: TimePoint) -> None:
        """Publish that there is no sample of valid time *first* nor of the next on the grid."""
        deviation = text_from_duration(change.deviation)
        within = f", give or take {deviation}," if change.deviation else ""
        others = f" nor of the {count - 1} after it" if count > 1 else ""
        reason = f"no sample of valid time {text_from_duration(first)}{within}{others}"
        self.violations.append(Violation(Constraint.CHANGE, TimePoint(first), now, reason))

    def report(self, constraint: Constraint, sample: Sample[Any], reason: str) -> None:
        """Publish that *sample* is left out against the wish of the policy."""
        now = sample.available_time
        self.violations.append(Violation(constraint, sample.valid_time, now, reason, sample))

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        taken = self.violations[:]
        self.violations.clear()
        return taken


def next_on_grid(last: int, period: int, earliest: int) -> int:
    """Return the first time after *last*, in steps of *period*, that is not before *earliest*."""
    return last + period * max(1, -((last - earliest) // period))


def refuse_foreign(period: Duration, change: SampleEvery) -> None:
    """Check that *period* is one of those that *change* allows.

    Raises:
        ValueError: It is not.
    """
    if period not in change.periods():
        shortest, longest = (
            text_from_duration(change.period),
            text_from_duration(change.longest_period),
        )
        raise ValueError(
            f"expected a multiple of the period {shortest} up to {longest}, "
            f"found {text_from_duration(period)}"
        )


def valid_time_of(sample: Sample[Any]) -> TimePoint:
    """Return the valid time of *sample*, to sort by."""
    return sample.valid_time

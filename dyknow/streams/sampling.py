"""Streams with a regular sample period.

The constraint is `sample every` of Heintz (2009), section 4.4.5, alone or with `use most recent`.
"""

from bisect import bisect_right, insort
from collections.abc import Iterator
from typing import Any

from dyknow.streams.ordering import delay_violation
from dyknow.streams.policy import Constraint, Policy, Violation
from dyknow.streams.sample import Sample
from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = ["MostRecentSampler", "Sampler"]


class _Grid:
    """The valid times of a sampled stream, and what is published about those not met."""

    def __init__(self, policy: Policy) -> None:
        assert policy.period is not None  # whoever makes a grid has looked
        self.period: Duration = policy.period
        self.end = policy.end
        self.violations: list[Violation] = []
        self._last_available = TimePoint(-1)

    def ends_before(self, time: TimePoint) -> bool:
        return self.end is not None and time > self.end

    def sample(self, value: Any, valid_time: TimePoint, now: TimePoint) -> Sample[Any]:
        """Make a sample that is available now, or a nanosecond after the last one."""
        self._last_available = max(now, TimePoint(self._last_available + 1))
        return Sample(value, valid_time, self._last_available)

    def report_missing(self, first: TimePoint, beyond: TimePoint, now: TimePoint) -> None:
        """Publish that there is no sample from *first* up to but not including *beyond*."""
        count = -(-(beyond - first) // self.period)
        valid_time = text_from_duration(first)
        others = f" nor of the {count - 1} after it" if count > 1 else ""
        reason = f"no sample of valid time {valid_time}{others}"
        self.violations.append(Violation(Constraint.CHANGE, first, now, reason))

    def take_violations(self) -> list[Violation]:
        taken, self.violations = self.violations, []
        return taken


class Sampler:
    """Hands on the samples whose valid times are one period apart.

    The grid begins at the first sample that the policy allows. Samples off the grid are left
    out. With a maximal delay, a sample is waited for until that delay has passed, and later ones
    that have arrived already are held back meanwhile; without it, the first sample beyond the
    expected one proves that it is missing. A gap is published and the stream goes on after it.
    """

    def __init__(self, policy: Policy) -> None:
        self._policy = policy
        self._grid = _Grid(policy)
        self._expected: TimePoint | None = None
        self._held: dict[TimePoint, Any] = {}

    def push(self, sample: Sample[Any]) -> Iterator[Sample[Any]]:
        """Take in a sample; yield it and held ones if they are next."""
        if not self._policy.covers(sample.valid_time):
            return
        if not self._policy.allows_delay(sample.delay):
            self._grid.violations.append(delay_violation(sample, self._policy))
            return
        if self._expected is None:
            self._expected = sample.valid_time
        ahead = sample.valid_time - self._expected
        if ahead < 0:
            return
        if ahead % self._grid.period == 0:
            self._held.setdefault(sample.valid_time, sample.value)
        if self._policy.max_delay is None and ahead > 0:
            self._skip_to(sample.valid_time, sample.available_time)
        yield from self._next_held(sample.available_time)

    def advance(self, now: TimePoint) -> Iterator[Sample[Any]]:
        """Give up what should have come by *now*; yield what was held back for it."""
        while (due := self.due()) is not None and due <= now:
            assert self._expected is not None  # else nothing would be due
            self._skip_to(TimePoint(self._expected + self._grid.period), now)
            yield from self._next_held(now)

    def due(self) -> TimePoint | None:
        """Return when the next sample will be given up."""
        if self._expected is None or self._policy.max_delay is None:
            return None
        if self._grid.ends_before(self._expected):
            return None
        return TimePoint(self._expected + self._policy.max_delay)

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        return self._grid.take_violations()

    def _skip_to(self, time: TimePoint, now: TimePoint) -> None:
        assert self._expected is not None  # the grid has begun
        steps = -(-(time - self._expected) // self._grid.period)
        beyond = TimePoint(self._expected + steps * self._grid.period)
        self._grid.report_missing(self._expected, beyond, now)
        self._expected = beyond

    def _next_held(self, now: TimePoint) -> Iterator[Sample[Any]]:
        while self._expected in self._held:
            assert self._expected is not None  # None is never held
            yield self._grid.sample(self._held.pop(self._expected), self._expected, now)
            self._expected = TimePoint(self._expected + self._grid.period)


class MostRecentSampler:
    """Hands on one sample for each time of the grid `from + n * period`, made up if need be.

    A sample with exactly the valid time is handed on when it arrives. If none has arrived when the
    maximal delay has passed, the value with the highest valid time not after it takes its
    place. If there is no value yet, that is published as a violation. (The definition makes
    every sample available at the end of the maximal delay; those that need no approximation
    come earlier here.)
    """

    def __init__(self, policy: Policy, now: TimePoint) -> None:
        assert policy.max_delay is not None  # the policy says so itself
        self._max_delay = policy.max_delay
        self._grid = _Grid(policy)
        steps = max(0, -(-(now - self._max_delay - policy.first) // self._grid.period))
        self._next = TimePoint(policy.first + steps * self._grid.period)
        self._recent: list[Sample[Any]] = []

    def push(self, sample: Sample[Any]) -> Iterator[Sample[Any]]:
        """Take in a sample; yield it and later ones if they are next on the grid."""
        insort(self._recent, sample, key=_valid_time)
        yield from self._settle(sample.available_time, give_up=False)

    def advance(self, now: TimePoint) -> Iterator[Sample[Any]]:
        """Yield an approximation of what should have come by *now*."""
        yield from self._settle(now, give_up=True)

    def due(self) -> TimePoint | None:
        """Return when the next sample will be approximated."""
        if self._grid.ends_before(self._next):
            return None
        return TimePoint(self._next + self._max_delay)

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        return self._grid.take_violations()

    def _settle(self, now: TimePoint, *, give_up: bool) -> Iterator[Sample[Any]]:
        while (due := self.due()) is not None:
            recent = self._forget_superseded()
            is_exact = recent is not None and recent.valid_time == self._next
            if not is_exact and (due > now or not give_up):
                return
            time = self._next
            self._next = TimePoint(time + self._grid.period)
            if recent is None:
                self._grid.report_missing(time, self._next, now)
            else:
                yield self._grid.sample(recent.value, time, now)

    def _forget_superseded(self) -> Sample[Any] | None:
        """Return the most recent sample for the next time of the grid, and drop older ones."""
        at = bisect_right(self._recent, self._next, key=_valid_time)
        if at == 0:
            return None
        del self._recent[: at - 1]
        return self._recent[0]


def _valid_time(sample: Sample[Any]) -> TimePoint:
    return sample.valid_time

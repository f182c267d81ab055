"""Streams with a regular sample period in which the most recent value stands for a missing one.

The constraints are `sample every` and `use most recent` of Heintz (2009), section 4.4.5.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from typing import Any

from dyknow.streams.grid import NOT_BEGUN, Publisher, next_on_grid, refuse_foreign, valid_time_of
from dyknow.streams.ordering import NEVER, delay_violation
from dyknow.streams.policy import Constraint, Policy, SampleEvery, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import NO_SAMPLE, Heartbeat, Sample
from dyknow.time import Duration, TimePoint

__all__ = ["MostRecentSampler"]


class MostRecentSampler:
    """Hands on one sample for each time of the grid `from + n * period`, made up if need be.

    A sample with exactly the valid time is handed on when it arrives, the first if there are
    several. If none has arrived when the maximal delay has passed, or a heartbeat says that none
    will, the value with the highest valid time not after it takes its place. If there is no value
    yet, that is published as a violation. So is a sample that comes when the place it could have
    had has been filled; it still counts for what is approximated later.

    Attributes:
        period: The period in force, a multiple of the policy's.
    """

    __slots__ = (
        "_ahead",
        "_change",
        "_end",
        "_exact",
        "_heard",
        "_latest",
        "_max_delay",
        "_next",
        "_out",
        "_policy",
        "period",
    )

    def __init__(self, policy: Policy, now: TimePoint) -> None:
        assert isinstance(policy.change, SampleEvery)  # the policy says so itself
        assert policy.max_delay is not None
        self._policy = policy
        self._change = policy.change
        self._out = Publisher()
        self._end = NEVER if policy.end is None else policy.end
        self._max_delay = policy.max_delay
        self._heard = NOT_BEGUN
        # Of the samples with the highest valid time, the last to arrive and the first.
        self._latest = self._exact = NO_SAMPLE
        self._ahead: list[Sample[Any]] = []
        self.period = policy.change.period
        before = policy.first - self.period
        self._next = next_on_grid(before, self.period, now - self._max_delay)

    @property
    def violations(self) -> list[Violation]:
        """What has been noticed and not yet been taken: the same list at all times."""
        return self._out.violations

    @property
    def held(self) -> Sequence[Sample[Any]]:
        """The samples that are kept back and may be handed on later."""
        return tuple(self._ahead)

    def push(self, sample: Sample[Any]) -> Sequence[Sample[Any]]:
        """Take in a sample; yield it and later ones if they are next on the grid."""
        valid_time = sample.valid_time
        if (
            valid_time == self._next
            and valid_time <= self._end
            and not self._ahead
            and sample.available_time > self._out.last
        ):
            self._out.last = sample.available_time
            self._latest = sample
            self._next = valid_time + self.period
            return (sample,)
        return self._push(sample)

    def beat(self, heartbeat: Heartbeat) -> list[Element]:
        """Yield what a heartbeat makes certain, and a heartbeat."""
        self._heard = max(self._heard, heartbeat.until)
        settled = self.advance(heartbeat.available_time)
        until = (
            min(heartbeat.until, self._next - 1) if self._next <= self._end else heartbeat.until
        )
        return [*settled, self._out.heartbeat(until, heartbeat.available_time)]

    def advance(self, now: TimePoint) -> list[Sample[Any]]:
        """Yield an approximation of what should have come by *now*."""
        return self._settle(max(now - self._max_delay, min(self._heard, now)), now)

    def due(self) -> TimePoint | None:
        """Return when the next sample will be approximated."""
        if self._next > self._end:
            return None
        return TimePoint(self._next if self._next <= self._heard else self._next + self._max_delay)

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        return self._out.take_violations()

    def set_period(self, period: Duration, now: TimePoint) -> list[Sample[Any]]:
        """Go on from the last sample with another period; yield what has arrived for the next.

        What has been left out is not asked for again, nor what would be too late.

        Raises:
            ValueError: The policy does not allow the period.
        """
        refuse_foreign(period, self._change)
        last, following = self._next - self.period, self._next
        if last >= self._policy.first:
            earliest = max(self._latest.valid_time, now - self._max_delay)
            self._next = min(next_on_grid(last, period, earliest), max(following, last + period))
        self.period = period
        self._catch_up()
        return self._settle(NOT_BEGUN, now)

    def _push(self, sample: Sample[Any]) -> list[Sample[Any]]:
        if sample.valid_time > self._end:
            return []
        if sample.valid_time > self._next:
            self._keep_for_later(sample)
            return []
        if self._policy.first <= sample.valid_time <= self._next - self.period:
            self._check_late(sample)
        if sample.valid_time >= self._latest.valid_time:
            self._latest = self._exact = sample
        return self._settle(NOT_BEGUN, sample.available_time)

    def _keep_for_later(self, sample: Sample[Any]) -> None:
        at = bisect_right(self._ahead, sample.valid_time, key=valid_time_of)
        if at and self._ahead[at - 1].valid_time == sample.valid_time:
            self._check_repeated(sample)
        self._ahead.insert(at, sample)

    def _check_late(self, sample: Sample[Any]) -> None:
        """Publish a sample that comes when the place it could have had has been filled."""
        if sample.delay > self._max_delay:
            self._out.violations.append(delay_violation(sample, self._policy))
        else:
            self._check_repeated(sample)

    def _check_repeated(self, sample: Sample[Any]) -> None:
        """Publish a sample for whose time of the grid there is another one."""
        if (self._next - sample.valid_time) % self._change.period == 0:
            self._out.report(
                Constraint.ORDER, sample, "there is a sample of this valid time already"
            )

    def _settle(self, settled: int, now: TimePoint) -> list[Sample[Any]]:
        """Yield what has arrived for the next times, or is certain as all is up to *settled*."""
        made: list[Sample[Any]] = []
        while self._next <= self._end:
            valid_time = TimePoint(self._next)
            if self._exact.valid_time == valid_time:
                made.append(self._out.pass_on(self._exact, now))
            elif valid_time > settled:
                break
            elif self._latest is NO_SAMPLE:
                self._out.report_missing(valid_time, 1, self._change, now)
            else:
                made.append(self._out.make(self._latest.value, valid_time, now))
            self._next = valid_time + self.period
            self._catch_up()
        return made

    def _catch_up(self) -> None:
        """Let the last of the samples that lie ahead no more be the latest."""
        count = bisect_right(self._ahead, self._next, key=valid_time_of)
        if count:
            self._latest = self._ahead[count - 1]
            self._exact = self._ahead[
                bisect_left(self._ahead, self._latest.valid_time, key=valid_time_of)
            ]
            del self._ahead[:count]

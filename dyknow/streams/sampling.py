"""Streams with a regular sample period.

The constraint is `sample every` of Heintz (2009), section 4.4.5, by itself; with `use most
recent` it is that of `dyknow.streams.most_recent`.
"""

from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

from dyknow.streams.grid import NOT_BEGUN, Publisher, next_on_grid, refuse_foreign, valid_time_of
from dyknow.streams.ordering import NEVER, delay_violation
from dyknow.streams.policy import Constraint, Policy, SampleEvery, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import END_OF_TIME, Heartbeat, Sample
from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = ["Sampler"]


class Sampler:
    """Hands on the samples whose valid times are one period apart, give or take the deviation.

    The grid begins at the first sample that the policy allows, and goes on from each sample
    handed on. Samples off the grid are left out, and so are all but the first to arrive for a
    place on it. With a maximal delay, a sample is waited for until that delay has passed, and
    later ones that have arrived already are held back meanwhile; without it, the first sample
    beyond the expected one proves that it is missing. A heartbeat proves it too, except the last
    one: after the end of a stream nothing is missing.

    The stream goes on after a gap. It is published if it is longer than the longest period, and
    so is a sample that comes after its place has been given up or taken.

    Attributes:
        period: The period in force, a multiple of the policy's.
    """

    __slots__ = (
        "_change",
        "_end",
        "_gap_after",
        "_given_up",
        "_heard",
        "_held",
        "_is_smooth",
        "_last",
        "_max_delay",
        "_out",
        "_policy",
        "_seen",
        "_step",
        "_unreported",
        "_width",
        "period",
    )

    def __init__(self, policy: Policy) -> None:
        assert isinstance(policy.change, SampleEvery)  # whoever makes a sampler has looked
        self._policy = policy
        self._change = policy.change
        self._out = Publisher()
        self._end = NEVER if policy.end is None else policy.end
        self._max_delay = NEVER if policy.max_delay is None else policy.max_delay
        self._held: list[Sample[Any]] = []
        # Where the last sample was handed on or given up: the next one must be valid between
        # `_opens`, one `_step` later, and `_opens + _width`.
        self._last = NOT_BEGUN
        self._width = 2 * policy.change.deviation
        self._given_up = self._heard = self._seen = self._gap_after = NOT_BEGUN
        # Whether nothing is held back, nor handed on later than it arrived: one look at the
        # sampler instead of at all its parts, for among thousands each look is a cache miss.
        self._is_smooth = False
        self._unreported = 0
        self._take_on(policy.change.period)

    @property
    def violations(self) -> list[Violation]:
        """What has been noticed and not yet been taken: the same list at all times."""
        return self._out.violations

    @property
    def held(self) -> Sequence[Sample[Any]]:
        """The samples that are kept back and may be handed on later."""
        return tuple(self._held)

    def push(self, sample: Sample[Any]) -> Sequence[Sample[Any]]:
        """Take in a sample; yield it and held ones if they are next."""
        valid_time = sample.valid_time
        if (
            self._is_smooth
            and 0 <= valid_time - self._last - self._step <= self._width
            and sample.available_time - valid_time <= self._max_delay
            and valid_time <= self._end
        ):
            self._last = valid_time
            return (sample,)
        return self._push(sample)

    def beat(self, heartbeat: Heartbeat) -> list[Element]:
        """Give up what a heartbeat proves missing; yield what was held back, and a heartbeat."""
        self._heard = max(self._heard, heartbeat.until)
        released: list[Element] = [*self.advance(heartbeat.available_time)]
        complete = self._held[0].valid_time - 1 if self._held else NEVER
        until = min(heartbeat.until, complete)
        return [*released, self._out.heartbeat(until, heartbeat.available_time)]

    def advance(self, now: TimePoint) -> list[Sample[Any]]:
        """Give up what should have come by *now*; yield what was held back for it."""
        settled = max(now - self._max_delay, min(self._heard, now))
        released: list[Sample[Any]] = []
        while missing := self._count_missing(settled):
            self._give_up(missing, now)
            released += self._release(now)
        return released

    def due(self) -> TimePoint | None:
        """Return when the next sample will be given up."""
        if self._last == NOT_BEGUN or self._expected > self._end:
            return None
        closes = self._opens + self._width
        if closes <= self._heard:
            return TimePoint(closes) if self._is_going_on else None
        return None if self._max_delay == NEVER else TimePoint(closes + self._max_delay)

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        return self._out.take_violations()

    def set_period(self, period: Duration, now: TimePoint) -> list[Sample[Any]]:
        """Go on from the last sample with another period; yield held ones if they are next.

        What has been left out is not asked for again, nor what would be too late.

        Raises:
            ValueError: The policy does not allow the period.
        """
        refuse_foreign(period, self._change)
        last, expected = self._last, self._expected
        self._take_on(period)
        if last != NOT_BEGUN:
            earliest = max(self._seen + 1, now - self._max_delay - self._change.deviation)
            following = next_on_grid(last, period, earliest)
            self._expect(min(following, max(expected, last + period)))
        released = self._release(now)
        # At this instant another sample may come: available times must stay unique.
        self._is_smooth = False
        return released

    @property
    def _is_going_on(self) -> bool:
        """Whether anything can still come: after the end of a stream nothing is missing."""
        return bool(self._held) or self._heard < END_OF_TIME

    @property
    def _opens(self) -> int:
        return self._last + self._step

    @property
    def _expected(self) -> int:
        return self._last + self.period

    def _expect(self, valid_time: int) -> None:
        self._last = valid_time - self.period

    def _take_on(self, period: Duration) -> None:
        self.period = period
        self._step = period - self._change.deviation

    def _push(self, sample: Sample[Any]) -> Sequence[Sample[Any]]:
        valid_time = sample.valid_time
        last = max(self._last, self._given_up)
        if last < valid_time < self._opens and self._policy.allows_delay(sample.delay):
            self._seen = max(self._seen, valid_time)
            return ()
        return self._sort_in(sample)

    def _sort_in(self, sample: Sample[Any]) -> Sequence[Sample[Any]]:
        if not self._policy.covers(sample.valid_time):
            return ()
        if sample.delay > self._max_delay:
            self._out.violations.append(delay_violation(sample, self._policy))
            return ()
        if self._last == NOT_BEGUN:
            self._expect(sample.valid_time)
        if self._max_delay == NEVER:
            missing = -((self._opens + self._width - sample.valid_time) // self.period)
            self._give_up(max(0, missing), sample.available_time)
        if sample.valid_time < self._opens:
            self._leave_out(sample)
        else:
            self._hold(sample)
        return self._release(sample.available_time)

    def _leave_out(self, sample: Sample[Any]) -> None:
        """Leave out what is too near to the last sample, and publish what comes too late."""
        last = max(self._last, self._given_up)
        if sample.valid_time > last:
            self._seen = max(self._seen, sample.valid_time)
        elif self._change.deviation or self._is_on_grid(sample.valid_time, self._change.period):
            text = text_from_duration(last)
            reason = f"the stream has gone on to valid time {text} already"
            self._out.report(Constraint.ORDER, sample, reason)

    def _hold(self, sample: Sample[Any]) -> None:
        """Hold a sample back unless it lies off the grid or another holds its place."""
        valid_time = sample.valid_time
        if not self._change.deviation and not self._is_on_grid(valid_time, self.period):
            return
        at = bisect_left(self._held, valid_time, key=valid_time_of)
        if at < len(self._held) and self._held[at].valid_time == valid_time:
            self._out.report(
                Constraint.ORDER, sample, "there is a sample of this valid time already"
            )
        else:
            self._held.insert(at, sample)

    def _is_on_grid(self, valid_time: int, period: int) -> bool:
        return (valid_time - self._expected) % period == 0

    def _count_missing(self, settled: int) -> int:
        """Return for how many places nothing can come if all is known up to *settled*."""
        if self._last == NOT_BEGUN or not self._is_going_on:
            return 0
        known = min(settled, self._end + self._change.deviation)
        if self._held:
            known = min(known, self._held[0].valid_time - 1)
        return max(0, (known - self._opens - self._width) // self.period + 1)

    def _give_up(self, count: int, now: TimePoint) -> None:
        """Wait no longer for the next samples; publish them if the longest period has passed."""
        if not count:
            return
        if self._given_up < self._last:
            self._gap_after, self._unreported = self._last, 0
        self._unreported += count
        self._last += count * self.period
        self._given_up = self._last + self._change.deviation
        longest = self._gap_after + self._change.longest_period + self._change.deviation
        if self._given_up >= longest:
            first = self._expected - self._unreported * self.period
            self._out.report_missing(first, self._unreported, self._change, now)
            self._unreported = 0

    def _release(self, now: TimePoint) -> list[Sample[Any]]:
        """Take the held samples that are next, or that nobody waits for any more, and yield."""
        released: list[Sample[Any]] = []
        held = self._held
        while held and held[0].valid_time <= self._opens + self._width:
            sample = held.pop(0)
            if sample.valid_time >= self._opens:
                released.append(self._out.pass_on(sample, now))
                self._last = sample.valid_time
            else:
                self._seen = max(self._seen, sample.valid_time)
        self._is_smooth = not held and self._out.last <= now
        return released

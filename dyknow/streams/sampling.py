"""Streams with a regular sample period.

The constraint is `sample every` of Heintz (2009), section 4.4.5, alone or with `use most recent`.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from typing import Any

from dyknow.streams.ordering import NEVER, delay_violation
from dyknow.streams.policy import Constraint, Policy, SampleEvery, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import END_OF_TIME, NO_SAMPLE, Heartbeat, Sample
from dyknow.time import Duration, TimePoint, text_from_duration

__all__ = ["MostRecentSampler", "Sampler"]

_NOT_BEGUN = -2 * NEVER


class _Publisher:
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
        taken = self.violations[:]
        self.violations.clear()
        return taken


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
        "_max_delay",
        "_opens",
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
        self._out = _Publisher()
        self._end = NEVER if policy.end is None else policy.end
        self._max_delay = NEVER if policy.max_delay is None else policy.max_delay
        self._held: list[Sample[Any]] = []
        # The next sample must be valid between `_opens` and `_opens + _width`.
        self._opens = _NOT_BEGUN
        self._width = 2 * policy.change.deviation
        self._given_up = self._heard = self._seen = self._gap_after = _NOT_BEGUN
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
            0 <= valid_time - self._opens <= self._width
            and sample.available_time - valid_time <= self._max_delay
            and valid_time <= self._end
            and not self._held
            and sample.available_time > self._out.last
        ):
            self._opens = valid_time + self._step
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
        if self._opens == _NOT_BEGUN or self._expected > self._end:
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
        _refuse_foreign(period, self._change)
        last, expected = self._opens - self._step, self._expected
        has_begun = self._opens != _NOT_BEGUN
        self._take_on(period)
        if has_begun:
            earliest = max(self._seen + 1, now - self._max_delay - self._change.deviation)
            following = _next_on_grid(last, period, earliest)
            self._expect(min(following, max(expected, last + period)))
        return self._release(now)

    @property
    def _is_going_on(self) -> bool:
        """Whether anything can still come: after the end of a stream nothing is missing."""
        return bool(self._held) or self._heard < END_OF_TIME

    @property
    def _expected(self) -> int:
        return self._opens + self._change.deviation

    def _expect(self, valid_time: int) -> None:
        self._opens = valid_time - self._change.deviation

    def _take_on(self, period: Duration) -> None:
        self.period = period
        self._step = period - self._change.deviation

    def _push(self, sample: Sample[Any]) -> Sequence[Sample[Any]]:
        valid_time = sample.valid_time
        last = max(self._opens - self._step, self._given_up)
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
        if self._opens == _NOT_BEGUN:
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
        last = max(self._opens - self._step, self._given_up)
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
        at = bisect_left(self._held, valid_time, key=_valid_time)
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
        if self._opens == _NOT_BEGUN or not self._is_going_on:
            return 0
        known = min(settled, self._end + self._change.deviation)
        if self._held:
            known = min(known, self._held[0].valid_time - 1)
        return max(0, (known - self._opens - self._width) // self.period + 1)

    def _give_up(self, count: int, now: TimePoint) -> None:
        """Wait no longer for the next samples; publish them if the longest period has passed."""
        if not count:
            return
        last = self._opens - self._step
        if self._given_up < last:
            self._gap_after, self._unreported = last, 0
        self._unreported += count
        self._opens += count * self.period
        self._given_up = self._opens + self._width - self.period
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
                self._opens = sample.valid_time + self._step
            else:
                self._seen = max(self._seen, sample.valid_time)
        return released


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
        self._out = _Publisher()
        self._end = NEVER if policy.end is None else policy.end
        self._max_delay = policy.max_delay
        self._heard = _NOT_BEGUN
        # Of the samples with the highest valid time, the last to arrive and the first.
        self._latest = self._exact = NO_SAMPLE
        self._ahead: list[Sample[Any]] = []
        self.period = policy.change.period
        before = policy.first - self.period
        self._next = _next_on_grid(before, self.period, now - self._max_delay)

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
        _refuse_foreign(period, self._change)
        last, following = self._next - self.period, self._next
        if last >= self._policy.first:
            earliest = max(self._latest.valid_time, now - self._max_delay)
            self._next = min(_next_on_grid(last, period, earliest), max(following, last + period))
        self.period = period
        self._catch_up()
        return self._settle(_NOT_BEGUN, now)

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
        return self._settle(_NOT_BEGUN, sample.available_time)

    def _keep_for_later(self, sample: Sample[Any]) -> None:
        at = bisect_right(self._ahead, sample.valid_time, key=_valid_time)
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
        count = bisect_right(self._ahead, self._next, key=_valid_time)
        if count:
            self._latest = self._ahead[count - 1]
            self._exact = self._ahead[
                bisect_left(self._ahead, self._latest.valid_time, key=_valid_time)
            ]
            del self._ahead[:count]


def _next_on_grid(last: int, period: int, earliest: int) -> int:
    """Return the first time after *last*, in steps of *period*, that is not before *earliest*."""
    return last + period * max(1, -((last - earliest) // period))


def _refuse_foreign(period: Duration, change: SampleEvery) -> None:
    if period not in change.periods():
        shortest, longest = (
            text_from_duration(change.period),
            text_from_duration(change.longest_period),
        )
        raise ValueError(
            f"expected a multiple of the period {shortest} up to {longest}, "
            f"found {text_from_duration(period)}"
        )


def _valid_time(sample: Sample[Any]) -> TimePoint:
    return sample.valid_time

"""What a synchronisation knows about one of its inputs.

The categories and what they follow from are those of Heintz (2009), *DyKnow: A Stream-Based
Knowledge Processing Middleware Framework*, section 7.8.2. Besides the policy of the input, a
heartbeat can tell that no more information about a time-point will come.
"""

from enum import Enum
from typing import Any, Final

from dyknow.streams.interpolation import interpolate
from dyknow.streams.policy import Order, Policy, SampleEvery
from dyknow.streams.sample import END_OF_TIME, Sample
from dyknow.streams.state_policy import StateApproximation, StatePolicy
from dyknow.time import Duration, TimePoint

__all__ = ["FOREVER", "MISSING", "Buffer", "Category"]

FOREVER: Final = END_OF_TIME
"""Later than every time-point: what is complete up to here has ended."""

MISSING: Final = object()
"""What a buffer gives for a time-point of which it has neither a value nor an approximation."""


class Category(Enum):
    """What is known about the value of an input at a time-point."""

    EXACT = "exact"
    APPROXIMATION_FINAL = "approximation, final"
    APPROXIMATION_MORE = "approximation, more may come"
    NO_APPROXIMATION_FINAL = "no approximation, final"
    NO_APPROXIMATION_MORE = "no approximation, more may come"


class Buffer:
    """The samples of one input that are still needed, and how far the input is complete.

    An input whose policy has neither an order nor a sample period nor a maximal delay is taken
    to be in monotone order: something must tell when it has said all about a time-point.

    Attributes:
        number: The place of the input among the others, from 0.
        samples: In order of valid time, one for each valid time.
        complete: No sample to come has a valid time up to this one, as order and heartbeats tell.
        reached: The highest valid time of a sample so far, or a time-point before all others.
        heard: Up to where heartbeats have made it complete, other than the one at its end.
        has_ended: Whether a heartbeat has told its end.
        first: The lowest valid time of a sample so far, or a time-point after all others.
        late: The last time-point that was settled while a sample for it could still come.
        is_final: Whether all is known about the time-point that is to be settled next; kept by
            the synchronisation.
        max_delay: The largest delay that a sample can have, if that is known.
        period: The exact sample period, if the input has one.
    """

    __slots__ = (
        "_approximation",
        "_end",
        "_exact_needs",
        "_is_linear",
        "_keeps",
        "_lead",
        "complete",
        "first",
        "has_ended",
        "heard",
        "is_final",
        "late",
        "max_delay",
        "number",
        "period",
        "reached",
        "samples",
    )

    def __init__(self, policy: Policy, states: StatePolicy, number: int = 0) -> None:
        """Make an empty buffer of an input that keeps *policy*."""
        self.number = number
        self.samples: list[Sample[Any]] = []
        self.complete = self.reached = self.heard = TimePoint(-1)
        self.first = FOREVER
        self.late = TimePoint(-1)
        self.is_final = self.has_ended = False
        self._approximation = states.approximation
        self._is_linear = states.is_linear
        self._keeps = states.is_approximated
        self._exact_needs = FOREVER if states.is_sampled else 1
        self.expect(policy)

    @property
    def promised(self) -> TimePoint:
        """Up to where the samples so far, by order and sample period, make the input complete."""
        return TimePoint(-1) if self.reached < 0 else TimePoint(self.reached + self._lead)

    def expect(self, policy: Policy) -> None:
        """Take in that the samples to come keep *policy*, whatever the earlier ones have kept."""
        self.max_delay = policy.max_delay
        self.period = _exact_period(policy)
        self._lead = _lead(policy)
        self._end = FOREVER if policy.end is None else policy.end
        if not self.has_ended:
            reached = TimePoint(self.reached + min(self._lead, 0))
            self.complete = max(TimePoint(policy.first - 1), self.heard, reached)

    def add(self, sample: Sample[Any]) -> None:
        """Take in a sample that is in order; of two with one valid time the later one counts."""
        valid_time = sample.valid_time
        if valid_time > self.reached:
            self.samples.append(sample)
        else:
            self._insert(sample)
        self.note(valid_time)

    def note(self, valid_time: TimePoint) -> None:
        """Take in that a sample of this valid time has come, whatever becomes of it."""
        if valid_time > self.reached:
            self.reached = valid_time
            self._complete_to(TimePoint(valid_time + self._lead))
        if valid_time < self.first:  # noqa: PLR1730, `min` would take four times as long
            self.first = valid_time

    def hear(self, until: TimePoint) -> None:
        """Take in that no sample to come has a valid time up to *until*."""
        if until >= FOREVER:
            self.has_ended = True
        else:
            self.heard = max(self.heard, until)
        if self.period is not None and 0 <= self.reached <= until:
            steps = (until - self.reached) // self.period + 1
            until = TimePoint(self.reached + steps * self.period - 1)
        self._complete_to(until)

    def complete_at(self, now: TimePoint) -> TimePoint:
        """Return up to which valid time nothing is missing at *now*."""
        if self.max_delay is None:
            return self.complete
        return max(self.complete, TimePoint(now - self.max_delay))

    def settles(self, time: TimePoint) -> bool:
        """Return whether order, sample period and heartbeats tell that *time* is final."""
        if self.complete >= time and not self._is_linear:
            return True
        return self.complete >= self.needed(time)

    def needed(self, time: TimePoint) -> TimePoint:
        """Return up to where the input must be complete for all to be known about *time*.

        A sample of exactly that time is enough for a sampled state. Where states come at the valid
        times of the inputs, nothing earlier may be missing either, or states would not be
        in order.
        """
        samples = self.samples
        if not samples or (samples[-1].valid_time < time and not self._is_linear):
            return time
        at = self._place(time)
        if at and samples[at - 1].valid_time == time:
            return TimePoint(time - self._exact_needs)
        if not self._is_linear or at == 0:
            return time
        return TimePoint(samples[at].valid_time - 1) if at < len(samples) else FOREVER

    def awaited(self, time: TimePoint) -> TimePoint:
        """Return the valid time of the best sample for *time* that may still come."""
        if self.period is None or self.reached < 0:
            return time
        return TimePoint(time - (time - self.reached) % self.period)

    def category(self, time: TimePoint, now: TimePoint) -> Category:
        """Return what is known about *time* at *now*."""
        at = self._place(time)
        if at and self.samples[at - 1].valid_time == time:
            return Category.EXACT
        is_final = self.complete_at(now) >= self.needed(time)
        if self._is_approximated(at):
            return Category.APPROXIMATION_FINAL if is_final else Category.APPROXIMATION_MORE
        return Category.NO_APPROXIMATION_FINAL if is_final else Category.NO_APPROXIMATION_MORE

    def has_value(self, time: TimePoint) -> bool:
        """Return whether there is a sample of exactly *time*, or something to stand for it."""
        samples = self.samples
        if self._approximation is StateApproximation.MOST_RECENT:
            return len(samples) > 0 and samples[0].valid_time <= time
        at = self._place(time)
        return (at > 0 and samples[at - 1].valid_time == time) or self._is_approximated(at)

    def value(self, time: TimePoint) -> Any:
        """Return the value or the approximation for *time*, or `MISSING`; forget what is older."""
        samples = self.samples
        while len(samples) > 1 and samples[1].valid_time <= time:
            del samples[0]
        if not samples or samples[0].valid_time > time:
            return MISSING
        sample = samples[0]
        if not self._keeps:
            del samples[0]
            return sample.value if sample.valid_time == time else MISSING
        if self._is_linear and sample.valid_time < time:
            return interpolate(sample, samples[1], time) if len(samples) > 1 else MISSING
        return sample.value

    def forget(self, time: TimePoint) -> None:
        """Forget the samples that no time-point from *time* on needs."""
        del self.samples[: max(0, self._place(time) - 1)]

    def forget_beyond(self, time: TimePoint) -> None:
        """Forget the samples that no time-point up to *time* needs."""
        del self.samples[self._place(time) + 1 :]

    def thin_out(self, origin: TimePoint, period: Duration) -> None:
        """Forget the last sample but one if no time-point of the grid needs it any more."""
        samples = self.samples
        at = 3 if self._is_linear else 2
        if len(samples) < at or (samples[-2].valid_time - origin) % period == 0:
            return
        if _cell(samples[-at], origin, period) == _cell(samples[-1], origin, period):
            del samples[-2]

    def _is_approximated(self, at: int) -> bool:
        """Return whether a value is known between the samples before and after place *at*."""
        match self._approximation:
            case StateApproximation.NONE:
                return False
            case StateApproximation.MOST_RECENT:
                return at > 0
            case StateApproximation.LINEAR:
                return 0 < at < len(self.samples)

    def _place(self, time: TimePoint) -> int:
        """Return how many samples are valid at or before *time*; that is one or two as a rule."""
        at = 0
        for sample in self.samples:
            if sample.valid_time > time:
                break
            at += 1
        return at

    def _insert(self, sample: Sample[Any]) -> None:
        at = self._place(sample.valid_time)
        if at and self.samples[at - 1].valid_time == sample.valid_time:
            self.samples[at - 1] = sample
        else:
            self.samples.insert(at, sample)

    def _complete_to(self, time: TimePoint) -> None:
        if time >= self._end:
            self.complete = FOREVER
        elif time > self.complete:
            self.complete = time


def _exact_period(policy: Policy) -> Duration | None:
    change = policy.change
    return change.period if isinstance(change, SampleEvery) and not change.deviation else None


def _lead(policy: Policy) -> int:
    """Return how far beyond the valid time of its last sample an input is complete."""
    if isinstance(policy.change, SampleEvery):
        return policy.change.period - policy.change.deviation - 1
    if policy.order is Order.ANY and policy.max_delay is not None:
        return -FOREVER
    return 0 if policy.order is Order.STRICT else -1


def _cell(sample: Sample[Any], origin: TimePoint, period: Duration) -> int:
    """Return the number of the time-point on the grid at or after a sample."""
    return -((origin - sample.valid_time) // period)

"""Streams in order of valid time, of bounded delay and duration, without repetitions.

The constraints are those of definition 4.5.11 of Heintz (2009), except `sample every`.
"""

from typing import Any

from dyknow.streams.policy import ANY_CHANGE, Constraint, Order, Policy, Violation
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint, text_from_duration

__all__ = ["LEAST_STEP", "NEVER", "Filter", "delay_violation"]

NEVER = 1 << 63
"""Later than every time-point, longer than every duration."""

LEAST_STEP = {Order.ANY: -NEVER, Order.MONOTONE: 0, Order.STRICT: 1}
"""By how much valid times must grow from one sample to the next."""


class Filter:
    """Hands on each sample at once if the policy allows it after the last one handed on.

    Since every constraint concerns one sample or two consecutive ones, the stream made is maximal:
    no sample that was left out could be put back.

    Attributes:
        violations: What has been noticed and not yet been taken: the same list at all times.
    """

    __slots__ = (
        "_end",
        "_last",
        "_least_step",
        "_max_delay",
        "_policy",
        "_start",
        "_wants_change",
        "violations",
    )

    def __init__(self, policy: Policy) -> None:
        self.violations: list[Violation] = []
        self._policy = policy
        self._start = policy.first
        self._end = NEVER if policy.end is None else policy.end
        self._max_delay = NEVER if policy.max_delay is None else policy.max_delay
        self._least_step = LEAST_STEP[policy.order]
        self._wants_change = policy.change is ANY_CHANGE
        self._last: Sample[Any] | None = None

    @property
    def held(self) -> tuple[()]:
        """Nothing: each sample is handed on at once or left out."""
        return ()

    def push(self, sample: Sample[Any]) -> tuple[Sample[Any], ...]:
        """Take in a sample; yield it or nothing."""
        valid_time, last = sample.valid_time, self._last
        if valid_time < self._start or valid_time > self._end:
            return ()
        if sample.available_time - valid_time > self._max_delay:
            self.violations.append(delay_violation(sample, self._policy))
            return ()
        if last is not None:
            if valid_time - last.valid_time < self._least_step:
                self.violations.append(self._order_violation(sample, last.valid_time))
                return ()
            if self._wants_change and _is_repetition(last, sample):
                return ()
        self._last = sample
        return (sample,)

    def beat(self, heartbeat: Heartbeat) -> tuple[Heartbeat]:
        """Hand a heartbeat on: a filter keeps nothing back."""
        return (heartbeat,)

    def advance(self, now: TimePoint) -> tuple[Sample[Any], ...]:  # noqa: ARG002 (protocol)
        """Yield nothing: time alone changes nothing."""
        return ()

    def due(self) -> None:
        """Return None: there are no deadlines."""

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        taken = self.violations[:]
        self.violations.clear()
        return taken

    def _order_violation(self, sample: Sample[Any], last: TimePoint) -> Violation:
        order = self._policy.order.value
        reason = f"the valid time does not follow {text_from_duration(last)} in {order}"
        now = sample.available_time
        return Violation(Constraint.ORDER, sample.valid_time, now, reason, sample)


def delay_violation(sample: Sample[Any], policy: Policy) -> Violation:
    """Return the violation that a sample is, being later than *policy* allows."""
    allowed = text_from_duration(policy.max_delay or 0)
    reason = f"expected a delay of at most {allowed}, found {text_from_duration(sample.delay)}"
    return Violation(Constraint.DELAY, sample.valid_time, sample.available_time, reason, sample)


def _is_repetition(last: Sample[Any], sample: Sample[Any]) -> bool:
    return last.valid_time == sample.valid_time and are_equal(last.value, sample.value)

"""Streams in order of valid time, of bounded delay and duration, without repetitions.

The constraints are those of definition 4.5.11 of Heintz (2009), except `sample every`.
"""

from typing import Any

from dyknow.streams.policy import ANY_CHANGE, Constraint, Order, Policy, Violation
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint, text_from_duration

__all__ = ["Filter", "delay_violation"]


class Filter:
    """Hands on each sample at once if the policy allows it after the last one handed on.

    Since every constraint concerns one sample or two consecutive ones, the stream made is maximal:
    no sample that was left out could be put back.
    """

    def __init__(self, policy: Policy) -> None:
        self._policy = policy
        self._last: Sample[Any] | None = None
        self._violations: list[Violation] = []

    def push(self, sample: Sample[Any]) -> tuple[Sample[Any], ...]:
        """Take in a sample; yield it or nothing."""
        if not self._policy.covers(sample.valid_time):
            return ()
        violation = delay_violation(sample, self._policy) or self._order_violation(sample)
        if violation is not None:
            self._violations.append(violation)
            return ()
        if self._policy.change is ANY_CHANGE and self._is_repetition(sample):
            return ()
        self._last = sample
        return (sample,)

    def advance(self, now: TimePoint) -> tuple[Sample[Any], ...]:  # noqa: ARG002 (protocol)
        """Yield nothing: time alone changes nothing."""
        return ()

    def due(self) -> None:
        """Return None: there are no deadlines."""

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        taken, self._violations = self._violations, []
        return taken

    def _order_violation(self, sample: Sample[Any]) -> Violation | None:
        order = self._policy.order
        if self._last is None or order is Order.ANY or sample.valid_time > self._last.valid_time:
            return None
        if order is Order.MONOTONE and sample.valid_time == self._last.valid_time:
            return None
        reason = (
            f"the valid time does not follow {text_from_duration(self._last.valid_time)}"
            f" in {order.value}"
        )
        return Violation(Constraint.ORDER, sample.valid_time, sample.available_time, reason)

    def _is_repetition(self, sample: Sample[Any]) -> bool:
        last = self._last
        return (
            last is not None
            and last.valid_time == sample.valid_time
            and are_equal(last.value, sample.value)
        )


def delay_violation(sample: Sample[Any], policy: Policy) -> Violation | None:
    """Return the violation of a sample that is later than *policy* allows."""
    if policy.allows_delay(sample.delay):
        return None
    allowed = text_from_duration(policy.max_delay or 0)
    reason = f"expected a delay of at most {allowed}, found {text_from_duration(sample.delay)}"
    return Violation(Constraint.DELAY, sample.valid_time, sample.available_time, reason)

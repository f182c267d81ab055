"""Several streams into one stream of states.

A state holds values of several fluents at one valid time (Heintz 2009, definitions 7.8.1 to
7.8.3). Of the family of state streams in section 7.8 this is the exact one: every value in a
state has the valid time of the state, none is approximated. It is a reproducible join: which
states there are depends on valid times alone, not on when samples arrive.
"""

from collections.abc import Sequence
from typing import Any

from dyknow.streams.policy import Constraint, Policy, Violation
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.state_policy import StatePolicy
from dyknow.time import TimePoint, text_from_duration

__all__ = ["Synchronisation"]


class Synchronisation(Reactive):
    """A computational unit that makes a state when every input has a sample of its valid time.

    The value of a state is the tuple of the inputs' values. Inputs must be in monotone order;
    then a stream that has reached a valid time will not say more about earlier ones, so that a
    state some input has left out is given up, and published as a violation, as soon as that is
    certain. So is a sample that comes after its time has been given up. When an input corrects
    itself before the state is complete, the later sample counts. States come in strict order.
    """

    def __init__(
        self,
        names: Sequence[str],
        policy: StatePolicy = StatePolicy(),  # noqa: B008, a frozen value
        inputs: Sequence[Policy] = (),
    ) -> None:
        """Join as many inputs as there are *names*, by which violations call them.

        Args:
            names: What violations call the inputs.
            policy: How states are made.
            inputs: The policies that the input streams keep, in the same order; without them
                all inputs are taken to be in monotone order.

        Raises:
            ValueError: The policy asks for what the inputs do not have.
        """
        if policy != StatePolicy():
            raise ValueError("only states of common valid times can be made yet")
        if inputs and len(inputs) != len(names):
            raise ValueError(f"expected {len(names)} policies of inputs, found {len(inputs)}")
        self._names = tuple(names)
        self._pending: dict[TimePoint, dict[int, Any]] = {}
        self._reached = [TimePoint(-1)] * len(self._names)
        self._last_state = TimePoint(-1)
        self._violations: list[Violation] = []

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Take in the new samples among *inputs*; yield the states that are complete."""
        for at, sample in enumerate(inputs):
            if sample.available_time == now:
                self._take(at, sample)
        if not self._pending:
            return []
        settled = min(self._reached)
        times = sorted(time for time in self._pending if time <= settled)
        states = [self._settle(time, now) for time in times]
        return [state for state in states if state is not None]

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        taken, self._violations = self._violations, []
        return taken

    def _take(self, at: int, sample: Sample[Any]) -> None:
        if sample.valid_time < self._reached[at] or sample.valid_time <= self._last_state:
            reached = text_from_duration(self._reached[at])
            reason = f"'{self._names[at]}' is out of order: it has reached {reached}"
            self._report(Constraint.ORDER, sample.valid_time, sample.available_time, reason)
            return
        self._reached[at] = sample.valid_time
        self._pending.setdefault(sample.valid_time, {})[at] = sample.value

    def _settle(self, time: TimePoint, now: TimePoint) -> Sample[Any] | None:
        values = self._pending.pop(time)
        if len(values) < len(self._names):
            absent = [f"'{name}'" for at, name in enumerate(self._names) if at not in values]
            reason = f"no state, for want of a sample of {' and of '.join(absent)}"
            self._report(Constraint.CHANGE, time, now, reason)
            return None
        self._last_state = time
        return Sample(tuple(values[at] for at in range(len(values))), time, now)

    def _report(
        self, constraint: Constraint, valid_time: TimePoint, now: TimePoint, reason: str
    ) -> None:
        self._violations.append(Violation(constraint, valid_time, now, reason))

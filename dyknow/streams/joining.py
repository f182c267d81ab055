"""States made of whatever is there: the available joins.

Unlike the reproducible joins of `dyknow.streams.synchronisation` these wait for nothing. A state
holds, of each input, the sample with the highest valid time that has arrived (*most recent at*,
Heintz 2009, definition 4.3.11), so that it depends on delays which values meet in a state. In
return no input can hold up the others. With a sample period this is the sampling of last available
values with which section 7.8.1 of the thesis begins.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from dyknow.streams.policy import Violation
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.streams.state_policy import CAPACITY, Occasion, Settling, StatePolicy
from dyknow.streams.state_reports import StateReports, SynchronisationCounts
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint

__all__ = ["Latest"]

AT_EACH_ARRIVAL = StatePolicy()
"""A state whenever a sample arrives."""

_WITHOUT_EFFECT: Mapping[str, Any] = {
    "max_delay": None,
    "delay_before_approximation": None,
    "settling": Settling.EARLY,
    "capacity": CAPACITY,
}
"""What a policy must leave as it is, since it would have no effect here."""


class Latest:
    """A computational unit that makes states of the latest values of its inputs at once.

    When a sample arrives (`any update`), when it changes a value (`any change`), or when each
    input has had one since the last state (`all updates`), the state of the highest valid time so
    far is made, from the first instant on at which every input has a value; a better value for
    the same valid time makes another state of it. Valid times are in monotone order.

    With `sample every` the state of each time-point of the grid is made at that time-point, with
    `NO_VALUE` for inputs that have said nothing; the first one when an input has a value.

    A sample with a lower valid time than the last one of its input is published as a violation and
    left out.

    Attributes:
        names: What violations call the inputs.
        policy: When states are made.
    """

    def __init__(self, names: Sequence[str], policy: StatePolicy = AT_EACH_ARRIVAL) -> None:
        """Join as many inputs as there are *names*.

        Of *policy* the occasion, the sample period, the start and the end have a meaning here;
        that it uses most recent values goes without saying, and may be said.

        Raises:
            ValueError: The policy asks for something else, or for a grid without a period.
        """
        if not names:
            raise ValueError("a join needs at least one input")
        if faults := _faults(policy):
            raise ValueError("; ".join(faults))
        self.names = tuple(names)
        self.policy = policy
        self._latest: list[Sample[Any] | None] = [None] * len(names)
        self._updated = [False] * len(names)
        self._last: Sample[Any] | None = None
        self._grid_time: TimePoint | None = None
        self._reports = StateReports(self.names)

    @property
    def counts(self) -> SynchronisationCounts:
        """What has happened so far."""
        return self._reports.counts

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Sample[Any]]:
        """Take in the new samples among *inputs*; yield a state if they give occasion for one."""
        has_news = False
        for at, sample in enumerate(inputs):
            if sample.available_time == now and self._take(at, sample):
                has_news = True
        if self.policy.is_sampled:
            self._begin(now)
            return []
        return self._state_of_arrival(now) if has_news else []

    def advance(self, now: TimePoint) -> list[Sample[Any]]:
        """Yield the states of the grid that have fallen due."""
        made = []
        while (due := self.due()) is not None and due <= now:
            made.append(self._state_of_grid(due, now))
            assert self.policy.period is not None  # else nothing would be due
            self._grid_time = TimePoint(due + self.policy.period)
        return made

    def due(self) -> TimePoint | None:
        """Return the next time-point of the grid, if there is one."""
        time = self._grid_time
        return None if time is None or not self._covers(time) else time

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        return self._reports.take()

    def _take(self, at: int, sample: Sample[Any]) -> bool:
        """Keep a sample if it is the latest of its input; return whether it is."""
        last = self._latest[at]
        if last is not None and sample.valid_time < last.valid_time:
            self._reports.out_of_order(at, sample, last.valid_time)
            return False
        self._latest[at] = sample
        self._updated[at] = True
        return True

    def _state_of_arrival(self, now: TimePoint) -> list[Sample[Any]]:
        latest = [sample for sample in self._latest if sample is not None]
        if len(latest) < len(self._latest):
            return []
        time = max(sample.valid_time for sample in latest)
        state = Sample(tuple(sample.value for sample in latest), time, now)
        if not self._covers(time) or not self._is_wanted(state):
            return []
        self._updated = [False] * len(latest)
        self._last = state
        self.counts.states += 1
        return [state]

    def _is_wanted(self, state: Sample[Any]) -> bool:
        if self.policy.occasion is Occasion.ALL_UPDATES:
            return all(self._updated)
        is_change = self.policy.occasion is Occasion.ANY_CHANGE
        return not (is_change and self._last and are_equal(self._last.value, state.value))

    def _begin(self, now: TimePoint) -> None:
        """Start the grid at its first time-point at or after the first arrival."""
        if self._grid_time is None:
            assert self.policy.period is not None  # a sampled policy without one is refused
            start = self.policy.start or TimePoint(0)
            steps = max(0, -((start - now) // self.policy.period))
            self._grid_time = TimePoint(start + steps * self.policy.period)

    def _state_of_grid(self, time: TimePoint, now: TimePoint) -> Sample[Any]:
        absent = [at for at, sample in enumerate(self._latest) if sample is None]
        if absent:
            self._reports.incomplete(absent, time, now)
        values = [NO_VALUE if sample is None else sample.value for sample in self._latest]
        self.counts.states += 1
        return Sample(tuple(values), time, now)

    def _covers(self, time: TimePoint) -> bool:
        start, end = self.policy.start or 0, self.policy.end
        return start <= time and (end is None or time <= end)


def _faults(policy: StatePolicy) -> list[str]:
    """Return what the policy asks for that an available join does not do."""
    faults = []
    if policy.is_linear or replace(policy, **_WITHOUT_EFFECT) != policy:
        faults.append(
            "a join of the latest values waits for nothing and looks at nothing later: only "
            "'use most recent', the change and the duration can be constrained"
        )
    if policy.is_sampled and policy.period is None:
        faults.append("states of the latest values need a sample period of their own")
    return faults

"""Several streams into one stream of states.

A state holds values of several fluents at one valid time (Heintz 2009, *DyKnow: A Stream-Based
Knowledge Processing Middleware Framework*, definitions 7.8.1 to 7.8.3); which states there are,
and when they are made, is up to a `StatePolicy`. The algorithm is the improved one of section
7.8.2 with its five categories of inputs or, where the policy asks for it, the basic one of
section 7.8.1.

These joins are reproducible: as long as no delay of the policy runs out and the inputs keep their
own policies, states depend on valid times alone, not on when samples arrive. (Of an input that
says the same valid time twice, what it had said last when the state was made counts; an input in
strict order does no such thing.) Joins that take what is there are in `dyknow.streams.joining`.

Where we differ from the thesis: an input that promises neither order nor maximal delay is taken to
be in monotone order; the delay before approximation counts from the valid time of the sample that
is waited for, as the last remark on the thesis' example has it, not from that of the state; and
no state is made before its valid time has come.
"""

from collections.abc import Sequence
from math import gcd
from typing import Any

from dyknow.streams.policy import Policy, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.streams.state_buffers import FOREVER, MISSING, Buffer
from dyknow.streams.state_policy import Occasion, StatePolicy
from dyknow.streams.state_reports import StateReports, SynchronisationCounts
from dyknow.streams.state_times import Grid, Updates
from dyknow.streams.state_waiting import Waiting
from dyknow.streams.values import are_equal
from dyknow.time import Duration, TimePoint

__all__ = ["Synchronisation"]

_COMMON_TIMES = StatePolicy()
"""A state for each valid time that all inputs have, once it is certain that they have it."""


class Synchronisation:
    """A computational unit that makes states out of its inputs, as a policy says.

    The value of a state is the tuple of the inputs' values. States come in strict order. A state
    is made as soon as all is known about its valid time: every input has a sample of it, or
    promises (by its order, its sample period, its maximal delay or a heartbeat) that no better
    one will come; or when a delay of the policy has passed.

    A sampled state is always made, if need be with `NO_VALUE`, and what is missing is published
    as a violation. A state at the valid time of an input is made only if every other input has
    a value or an approximation; otherwise it is given up, and that is published. So are samples
    that come too late or out of order. When times have been passed over without a state, a
    heartbeat says so.

    Without a maximal delay a silent input makes the samples of the others wait. When more of
    one input wait than the policy's capacity, states are given up as if the delay had passed.

    Attributes:
        names: What violations call the inputs.
        policy: How states are made.
        buffers: What is known of each input.
    """

    def __init__(
        self,
        names: Sequence[str],
        policy: StatePolicy = _COMMON_TIMES,
        inputs: Sequence[Policy] = (),
    ) -> None:
        """Join as many inputs as there are *names*.

        Args:
            names: What violations call the inputs.
            policy: How states are made.
            inputs: The policies that the input streams keep, in the same order; without them
                all inputs are taken to be in monotone order.

        Raises:
            ValueError: The policy asks for what the inputs do not have.
        """
        kept = tuple(inputs) or (Policy(),) * len(names)
        if not names:
            raise ValueError("a synchronisation needs at least one input")
        if len(kept) != len(names):
            raise ValueError(f"expected {len(names)} policies of inputs, found {len(kept)}")
        self.names = tuple(names)
        self.policy = policy
        self.buffers = tuple(Buffer(each, policy, at) for at, each in enumerate(kept))
        self._grid = _grid(self.names, policy, kept) if policy.is_sampled else None
        self._times: Grid | Updates = self._grid or Updates()
        self._waiting = Waiting(policy, self.buffers)
        self._reports = StateReports(self.names)
        self._begins = policy.start or TimePoint(0)
        self._ends = TimePoint(FOREVER - 1) if policy.end is None else policy.end
        self._settled = self._said = TimePoint(self._begins - 1)
        self._last: Sample[Any] | None = None
        self._has_begun = policy.start is not None or not policy.is_approximated
        self._crowded: Buffer | None = None
        self._capacity = policy.capacity
        self._waiting.begin(self._times.current)

    @property
    def time(self) -> TimePoint | None:
        """The valid time that is to be settled next, if one is known."""
        return None if self._waiting.time == FOREVER else self._waiting.time

    @property
    def counts(self) -> SynchronisationCounts:
        """What has happened so far."""
        return self._reports.counts

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Element]:
        """Take in the new samples among *inputs*; yield the states that can be made."""
        for sample, buffer in zip(inputs, self.buffers, strict=True):
            if sample.available_time == now:
                self._take(buffer, sample)
        return self._settle(now)

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> list[Element]:
        """Take in how far an input is complete; yield what follows, maybe a heartbeat."""
        buffer = self.buffers[at]
        buffer.hear(heartbeat.until)
        self._waiting.look_at(buffer)
        made = self._settle(now)
        complete = self._complete()
        if complete > self._said:
            self._said = complete
            made.append(Heartbeat(complete, now))
        return made

    def expect(self, at: int, policy: Policy) -> None:
        """Take in that from now on input number *at*, from 0, keeps another policy.

        What has been settled because the old policy excluded better samples stays settled.
        """
        self.buffers[at].expect(policy)
        self._waiting.begin(self._times.current)

    def advance(self, now: TimePoint) -> list[Element]:
        """Yield the states for which there is no more waiting at *now*."""
        return self._settle(now)

    def due(self) -> TimePoint | None:
        """Return when the next state will have been waited for long enough, if ever."""
        if self._waiting.time <= self._ends:
            return self._waiting.due()
        begins = FOREVER if self._grid is None else self._grid.begins(self.buffers)
        return None if begins == FOREVER else begins

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        return self._reports.take()

    def _take(self, buffer: Buffer, sample: Sample[Any]) -> None:
        valid_time = sample.valid_time
        if valid_time <= buffer.complete:
            self._reports.out_of_order(buffer.number, sample, max(buffer.reached, buffer.heard))
            return
        waiting, times = self._waiting, self._times
        if self._settled < valid_time <= self._ends:
            buffer.add(sample)
            times.note(buffer, valid_time)
            if len(buffer.samples) > self._capacity:
                self._crowd(buffer, sample.available_time)
        else:
            self._take_outside(buffer, sample)
        if valid_time > waiting.newest:  # noqa: PLR1730, `max` would take four times as long
            waiting.newest = valid_time
        if times.current != waiting.time:
            waiting.turn_to(times.current)
        elif not buffer.is_final:
            waiting.look_at(buffer)

    def _take_outside(self, buffer: Buffer, sample: Sample[Any]) -> None:
        """Take in a sample that is not for a state to come, but may serve to approximate one."""
        valid_time = sample.valid_time
        is_beyond = valid_time > self._ends
        if not is_beyond and valid_time <= buffer.late:
            self._reports.late(buffer.number, sample, self._settled)
        elif self._begins <= valid_time <= self._ends and self._times.has(valid_time):
            self._reports.repeated(buffer.number, sample)
        if self.policy.is_linear or (self.policy.is_approximated and not is_beyond):
            buffer.add(sample)
            buffer.forget(self._settled)
            buffer.forget_beyond(self._ends)
        else:
            buffer.note(valid_time)

    def _settle(self, now: TimePoint) -> list[Element]:
        made: list[Element] = []
        waiting, times, ends = self._waiting, self._times, self._ends
        if waiting.time == FOREVER and self._grid is not None:
            self._begin(self._grid, now)
        while waiting.time <= ends and (waiting.is_over(now) or self._is_crowded(now)):
            made.extend(self._state(waiting.time, now))
            times.move_on()
            waiting.turn_to(times.current)
        if self._settled > self._said:
            self._said = self._settled
            made.append(Heartbeat(self._settled, now))
        return made

    def _begin(self, grid: Grid, now: TimePoint) -> None:
        """Start the grid where the inputs do, if that is known by now."""
        if grid.begins(self.buffers) > now:
            return
        self._begins = grid.begin(self.buffers)
        self._settled = TimePoint(self._begins - 1)
        self._said = max(self._said, self._settled)
        for buffer in self.buffers:
            buffer.forget(self._begins)
        self._waiting.turn_to(grid.current)

    def _state(self, time: TimePoint, now: TimePoint) -> tuple[Sample[Any], ...]:
        """Settle a valid time; return its state, if there is to be one."""
        is_early = self._waiting.n_open > 0 and self._is_early(time, now)
        values = [buffer.value(time) for buffer in self.buffers]
        missing = [at for at, value in enumerate(values) if value is MISSING]
        self._settled = time
        if missing and not self._fill(values, missing, now):
            return ()
        self._has_begun = True
        if self.policy.is_linear:
            self._report_gaps(values, missing, now)
        state = Sample(tuple(values), time, now)
        if not self._is_wanted(state):
            return ()
        self._said = time
        self._last = state
        self.counts.states += 1
        self.counts.early += is_early
        return (state,)

    def _is_early(self, time: TimePoint, now: TimePoint) -> bool:
        """Return whether a better state could come; mark the inputs that were not complete."""
        is_early = False
        for buffer in self.buffers:
            if buffer.complete < time:
                is_early = is_early or buffer.complete_at(now) < buffer.needed(time)
                buffer.late = time
        return is_early

    def _fill(self, values: list[Any], missing: list[int], now: TimePoint) -> bool:
        """Put `NO_VALUE` for what is missing of a sampled state; report what is missing."""
        if self._grid is not None:
            self._reports.incomplete(missing, self._settled, now)
            for at in missing:
                values[at] = NO_VALUE
        elif self._has_begun:
            self._reports.given_up(missing, self._settled, now)
        return self._grid is not None

    def _report_gaps(self, values: Sequence[Any], missing: Sequence[int], now: TimePoint) -> None:
        """Report inputs that have values before and after, but none that lies between."""
        for at, value in enumerate(values):
            if value is NO_VALUE and at not in missing:
                ends = [sample.value for sample in self.buffers[at].samples[:2]]
                if not any(end is NO_VALUE for end in ends):
                    self._reports.not_interpolated(at, self._settled, now, type(ends[0]))

    def _is_wanted(self, state: Sample[Any]) -> bool:
        """Return whether the policy wants a state after the last one."""
        last = self._last
        if last is None:
            return True
        match self.policy.occasion:
            case Occasion.ANY_CHANGE:
                return not are_equal(last.value, state.value)
            case Occasion.ALL_UPDATES:
                return all(b.samples[0].valid_time > last.valid_time for b in self.buffers)
            case _:
                return True

    def _is_crowded(self, now: TimePoint) -> bool:
        """Return whether too many samples of an input wait; report it."""
        crowded = self._crowded
        if crowded is None or len(crowded.samples) <= self._capacity:
            self._crowded = None
            return False
        self._reports.crowded(crowded.number, self._waiting.time, now, self._capacity)
        return True

    def _crowd(self, buffer: Buffer, now: TimePoint) -> None:
        """Note that too many samples wait; before states have begun, forget the oldest."""
        if self._waiting.time != FOREVER:
            self._crowded = buffer
            return
        buffer.forget(max(self._complete(), TimePoint(0)))
        if len(buffer.samples) > self._capacity:
            oldest = buffer.samples.pop(0)
            self._reports.unused(buffer.number, oldest, now, self._capacity)

    def _complete(self) -> TimePoint:
        """Return up to which valid time it is certain that no state will come."""
        if self._grid is not None and self._waiting.is_vain:
            return FOREVER
        if self._waiting.time != FOREVER and self._grid is not None:
            complete = TimePoint(self._waiting.time - 1)
        elif self._grid is not None:
            complete = max(TimePoint(min(b.first, b.complete + 1) - 1) for b in self.buffers)
        else:
            complete = min(buffer.complete for buffer in self.buffers)
            complete = min(complete, TimePoint(self._waiting.time - 1))
        return FOREVER if complete >= self._ends else complete


def _grid(names: Sequence[str], policy: StatePolicy, inputs: Sequence[Policy]) -> Grid:
    """Return the grid of a sampled synchronisation; its period may follow from the inputs'."""
    if policy.period is not None:
        return Grid(policy.start, policy.period)
    unsampled = [name for name, each in zip(names, inputs, strict=True) if each.period is None]
    if unsampled:
        raise ValueError(
            f"states without a sample period of their own need inputs that are sampled, "
            f"'{unsampled[0]}' is not"
        )
    periods = [each.period for each in inputs if each.period is not None]
    return Grid(policy.start, Duration(gcd(*periods)))

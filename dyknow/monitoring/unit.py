"""The computational unit that makes verdicts out of states.

It corresponds to the stream reasoning engine of Heintz, 'Semantically grounded stream reasoning
integrated with ROS', sections VI.6 and VII, steps 12 and 13.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from dyknow.errors import FeatureError
from dyknow.monitoring.reading import StateReader
from dyknow.mtl.groups import FormulaGroup
from dyknow.mtl.syntax import Verdict
from dyknow.streams.policy import Constraint, Violation
from dyknow.streams.process import Element, Reactive
from dyknow.streams.sample import END_OF_TIME, Heartbeat, Sample
from dyknow.time import TimePoint

__all__ = ["Decision", "FormulaUnit", "OnGap"]


class OnGap(Enum):
    """What becomes of an evaluation when a state is missing, or is not as it should be."""

    END = "end"
    """It ends, and what is not decided by then never will be."""

    CONTINUE = "continue"
    """It goes on with the states there are: the last state holds on until the next one."""


@dataclass(frozen=True, slots=True)
class Decision:
    """A formula has been decided.

    Attributes:
        formula: The name of the formula.
        verdict: True or false.
        decided_at: The valid time of the state that decides it.
        known_at: When that state was available.
    """

    formula: str
    verdict: Verdict
    decided_at: TimePoint
    known_at: TimePoint


class FormulaUnit(Reactive):
    """A computational unit from states to the verdicts on a group of formulas.

    For each formula that a state decides a sample `{"formula": NAME, "verdict": "true"}`, or
    `"false"`, is emitted, valid at the time of that state; with each state goes a heartbeat. When
    the evaluation has to end, the verdict of what is not decided is `"undecided"`. When there is
    nothing left to decide, a heartbeat says that nothing more will come.

    What `note` was told of counts at the first state or heartbeat from its valid time on.

    Attributes:
        group: The formulas.
        on_gap: What to do about a state that is missing or unfit.
        decisions: The verdicts so far, in the order in which they came.
        gaps: How many states were missing or unfit, as far as they count already.
        ended_by: What ended the evaluation; None if nothing did.
        on_decided: Is told of each verdict, once.
        on_over: Is called when there is nothing left to decide.
    """

    def __init__(self, group: FormulaGroup, reader: StateReader, on_gap: OnGap) -> None:
        """Evaluate the formulas of *group* in the states that *reader* reads."""
        self.group = group
        self.on_gap = on_gap
        self.decisions: list[Decision] = []
        self.gaps = 0
        self.ended_by: Violation | None = None
        self.on_decided: Callable[[Decision], object] = lambda _decision: None
        self.on_over: Callable[[], object] = lambda: None
        self._reader = reader
        self._reached = TimePoint(-1)
        self._last_gap = TimePoint(-1)
        self._noted: list[Violation] = []
        self._own: list[Violation] = []

    @property
    def is_over(self) -> bool:
        """Whether there is nothing left to decide."""
        return self.ended_by is not None or len(self.decisions) == len(self.group)

    @property
    def pending(self) -> Violation | None:
        """What will end the evaluation with the next state, if it is known already."""
        return self._noted[0] if self._noted and self.on_gap is OnGap.END else None

    def note(self, violation: Violation) -> None:
        """Take in that states are not as their policy says from some valid time on."""
        if not self.is_over:
            self._noted.append(violation)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Sequence[Element]:
        """Evaluate the formulas in the new state and emit the verdicts that it brings about."""
        (state,) = inputs
        if self.is_over:
            return ()
        gap = self._gap_up_to(state.valid_time)
        if gap is not None:
            return self._end(gap, state.valid_time, now)
        try:
            values = self._reader.read(state.value, state.valid_time)
            decided = self.group.step(state.valid_time, values)
        except FeatureError as fault:
            return self._leave_out(state, str(fault), now)
        self._reached = state.valid_time
        samples = [self._decide(name, each, now) for name, each in decided.items()]
        return [*samples, self._heartbeat(now)]

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> Sequence[Element]:  # noqa: ARG002, the protocol's
        """Hand on how far the states are complete, unless one is missing by then."""
        if self.is_over:
            return ()
        gap = self._gap_up_to(heartbeat.until)
        if gap is not None:
            return self._end(gap, max(gap.valid_time, TimePoint(self._reached + 1)), now)
        self._reached = max(self._reached, heartbeat.until)
        return [self._heartbeat(now)]

    def take_violations(self) -> list[Violation]:
        """Return the states that were unfit since this was last asked."""
        taken, self._own = self._own, []
        return taken

    def _decide(self, formula: str, verdict: Verdict, now: TimePoint) -> Sample[Any]:
        decision = Decision(formula, verdict, self._reached, now)
        self.decisions.append(decision)
        self.on_decided(decision)
        return _sample(formula, verdict, self._reached, now)

    def _gap_up_to(self, time: TimePoint) -> Violation | None:
        """Count what was noted up to a valid time; return the first that is to end all."""
        if not self._noted:
            return None
        counting = [each for each in self._noted if each.valid_time <= time]
        self._noted = [each for each in self._noted if each.valid_time > time]
        self.gaps += len(counting)
        self._last_gap = max([self._last_gap, *(each.valid_time for each in counting)])
        return counting[0] if counting and self.on_gap is OnGap.END else None

    def _leave_out(self, state: Sample[Any], reason: str, now: TimePoint) -> Sequence[Element]:
        """Publish that a state is unfit, unless that has been published with the state."""
        time = self._reached = state.valid_time
        if self._last_gap == time:
            return [self._heartbeat(now)]
        self.gaps += 1
        gap = Violation(Constraint.APPROXIMATION, time, now, reason, state, definition="7.8.1")
        self._own.append(gap)
        return self._end(gap, time, now) if self.on_gap is OnGap.END else [self._heartbeat(now)]

    def _end(self, gap: Violation, time: TimePoint, now: TimePoint) -> Sequence[Element]:
        self.ended_by = gap
        verdicts = self.group.verdicts.items()
        samples = [_sample(n, v, time, now) for n, v in verdicts if v is Verdict.UNDECIDED]
        return [*samples, self._heartbeat(now)]

    def _heartbeat(self, now: TimePoint) -> Heartbeat:
        """Say how far verdicts are complete; tell whoever waits for it that all is over."""
        if not self.is_over:
            return Heartbeat(self._reached, now)
        self.on_over()
        return Heartbeat(END_OF_TIME, now)


def _sample(name: str, verdict: Verdict, time: TimePoint, now: TimePoint) -> Sample[Any]:
    return Sample({"formula": name, "verdict": verdict.name.lower()}, time, now)

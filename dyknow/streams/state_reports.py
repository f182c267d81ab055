"""What goes wrong in a synchronisation: violations with their reasons, and how many there are."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from dyknow.streams.policy import Constraint, Violation
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["StateReports", "SynchronisationCounts"]

_Sample = Sample[object]


@dataclass(slots=True)
class SynchronisationCounts:
    """What has happened in a synchronisation.

    Attributes:
        states: How many states were made.
        early: How many of them were made because a delay had passed, while better samples
            could still come.
        incomplete: How many of them have no value of some input.
        given_up: How many valid times have no state for want of a sample.
        crowded: How many times a state was made or given up because too many samples waited.
        late: How many samples came after a state that they were meant for.
        out_of_order: How many samples broke the order of their stream, or its heartbeats.
    """

    states: int = 0
    early: int = 0
    incomplete: int = 0
    given_up: int = 0
    crowded: int = 0
    late: int = 0
    out_of_order: int = 0


class StateReports:
    """Writes the violations of one synchronisation and counts them.

    Attributes:
        counts: What has happened so far.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self.counts = SynchronisationCounts()
        self._names = tuple(names)
        self._violations: list[Violation] = []

    def take(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""
        taken, self._violations = self._violations, []
        return taken

    def out_of_order(self, at: int, sample: _Sample, reached: TimePoint) -> None:
        """Note a sample of input *at* that comes after the input had got further."""
        self.counts.out_of_order += 1
        reason = (
            f"{self._quoted([at])} is out of order: it has reached {text_from_duration(reached)}"
        )
        self._left_out(Constraint.ORDER, sample, reason)

    def repeated(self, at: int, sample: _Sample) -> None:
        """Note another sample for a valid time whose state has been made with the first."""
        self.counts.out_of_order += 1
        reason = f"{self._quoted([at])} is out of order: the state of that time has been made"
        self._left_out(Constraint.ORDER, sample, reason)

    def late(self, at: int, sample: _Sample, settled: TimePoint) -> None:
        """Note a sample that should have been in states that were made or given up without it."""
        self.counts.late += 1
        delay = text_from_duration(sample.delay)
        reason = (
            f"{self._quoted([at])} is late by {delay}: "
            f"states up to {text_from_duration(settled)} were made without it"
        )
        self._left_out(Constraint.DELAY, sample, reason)

    def given_up(self, missing: Iterable[int], time: TimePoint, now: TimePoint) -> None:
        """Note that there is no state at *time*."""
        self.counts.given_up += 1
        reason = f"no state, for want of a sample of {self._quoted(missing)}"
        self._report(Constraint.CHANGE, time, now, reason)

    def incomplete(self, missing: Iterable[int], time: TimePoint, now: TimePoint) -> None:
        """Note that the state at *time* has no value of some inputs."""
        self.counts.incomplete += 1
        reason = f"no value of {self._quoted(missing)}"
        self._report(Constraint.APPROXIMATION, time, now, reason)

    def crowded(self, at: int, time: TimePoint, now: TimePoint, capacity: int) -> None:
        """Note that a state is not waited for any longer, since too many samples wait."""
        self.counts.crowded += 1
        reason = (
            f"not waited for any longer: more than {capacity} samples of {self._quoted([at])} "
            f"wait for other inputs"
        )
        self._report(Constraint.DELAY, time, now, reason)

    def unused(self, at: int, sample: _Sample, now: TimePoint, capacity: int) -> None:
        """Note that a sample was forgotten before the first state, since too many wait."""
        self.counts.crowded += 1
        reason = (
            f"forgotten: more than {capacity} samples of {self._quoted([at])} wait for the first "
            f"sample of another input"
        )
        self._violations.append(
            Violation(Constraint.DELAY, sample.valid_time, now, reason, sample)
        )

    def not_interpolated(self, at: int, time: TimePoint, now: TimePoint, kind: type) -> None:
        """Note that there is no value between two values of an input."""
        reason = f"values of {self._quoted([at])} cannot be interpolated, found {kind.__name__}"
        self._report(Constraint.APPROXIMATION, time, now, reason)

    def _quoted(self, inputs: Iterable[int]) -> str:
        return " and of ".join(f"'{self._names[at]}'" for at in inputs)

    def _left_out(self, constraint: Constraint, sample: _Sample, reason: str) -> None:
        self._violations.append(
            Violation(constraint, sample.valid_time, sample.available_time, reason, sample)
        )

    def _report(
        self, constraint: Constraint, valid_time: TimePoint, now: TimePoint, reason: str
    ) -> None:
        self._violations.append(Violation(constraint, valid_time, now, reason, definition="7.8.4"))

"""Figures about a stream, kept while it runs at a small and constant price.

No list of samples or delays is kept: delays are counted in 64 bins of equal width, and when one
does not fit, the width doubles and neighbouring bins become one. A percentile is therefore too
long by at most a thirty-second part of the largest delay, and never longer than that one.
"""

from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from dyknow.streams.policy import Violation
from dyknow.streams.sample import Sample
from dyknow.time import SECOND, Duration, TimePoint

__all__ = ["Delays", "Statistics", "Tally"]

_NONE = Duration(0)
_N_BINS = 64
_WIDTH = 1_000


@dataclass(frozen=True, slots=True)
class Statistics:
    """What is known about a stream at one moment.

    Attributes:
        samples: How many samples it has had.
        rate: Samples per second of valid time; 0 before the second sample.
        mean_delay: The mean of available time minus valid time.
        delay_99: The delay that 99 of 100 samples do not exceed.
        largest_delay: The largest delay; 0 if none was positive.
        violations: How often the policy could not be kept.
        late: How many samples were left out against the wish of the policy, being too late or
            out of order; each of them is in a violation.
        heartbeats: How often the stream said that there is nothing more up to a valid time.
    """

    samples: int = 0
    rate: float = 0.0
    mean_delay: Duration = _NONE
    delay_99: Duration = _NONE
    largest_delay: Duration = _NONE
    violations: int = 0
    late: int = 0
    heartbeats: int = 0


class Delays:
    """How long things took: their number, sum, largest, and distribution.

    Attributes:
        samples: How many delays have been added.
        total: Their sum.
        largest: The largest of them, or 0.
    """

    __slots__ = ("_bins", "_width", "largest", "samples", "total")

    def __init__(self) -> None:
        self.samples = 0
        self.total = 0
        self.largest = 0
        self._bins = [0] * _N_BINS
        self._width = _WIDTH

    @property
    def mean(self) -> Duration:
        """The mean delay to the nearest nanosecond, 0 if there is none."""
        return Duration(round(self.total / self.samples) if self.samples else 0)

    def add(self, delay: int) -> None:
        """Count one delay; those that are not positive count as 0 in the distribution."""
        self.samples += 1
        self.total += delay
        if delay > 0:
            if delay > self.largest:
                self._let_in(delay)
            self._bins[delay // self._width] += 1

    def percentile(self, percent: float) -> Duration:
        """Return a delay that *percent* of all do not exceed."""
        left = self.samples * (1 - percent / 100)
        for at in range(_N_BINS - 1, -1, -1):
            left -= self._bins[at]
            if left < 0:
                return Duration(min((at + 1) * self._width, self.largest))
        return Duration(0)

    def _let_in(self, delay: int) -> None:
        self.largest = delay
        while delay >= self._width * _N_BINS:
            self._widen()

    def _widen(self) -> None:
        pairs = zip(self._bins[::2], self._bins[1::2], strict=True)
        self._bins = [one + other for one, other in pairs] + [0] * (_N_BINS // 2)
        self._width *= 2


class Tally(Delays):
    """The running figures of one stream.

    Attributes:
        first: The valid time of its first sample.
        last: The valid time of its last sample.
        violations: How often its policy could not be kept.
        late: How many samples were left out against the wish of the policy.
        heartbeats: How often it said that there is nothing more.
    """

    __slots__ = ("first", "heartbeats", "last", "late", "violations")

    def __init__(self) -> None:
        super().__init__()
        self.first: TimePoint | None = None
        self.last = TimePoint(0)
        self.violations = 0
        self.late = 0
        self.heartbeats = 0

    @property
    def statistics(self) -> Statistics:
        """The figures as they stand."""
        return Statistics(
            samples=self.samples,
            rate=self._rate,
            mean_delay=self.mean,
            delay_99=self.percentile(99),
            largest_delay=Duration(self.largest),
            violations=self.violations,
            late=self.late,
            heartbeats=self.heartbeats,
        )

    def note(self, sample: Sample[Any]) -> None:
        """Count a sample."""
        valid_time = sample.valid_time
        if self.first is None:
            self.first = valid_time
        self.last = valid_time
        # As in `add`, which is not called because this is done for every sample of every stream.
        delay = sample.available_time - valid_time
        self.samples += 1
        self.total += delay
        if delay > 0:
            if delay > self.largest:
                self._let_in(delay)
            self._bins[delay // self._width] += 1

    def note_violation(self, violation: Violation) -> None:
        """Count a violation."""
        self.violations += 1
        self.late += violation.sample is not None

    def copy(self) -> "Tally":
        """Return a tally that goes on from the same figures."""
        return deepcopy(self)

    @property
    def _rate(self) -> float:
        span = 0 if self.first is None else self.last - self.first
        return (self.samples - 1) * SECOND / span if span > 0 else 0.0

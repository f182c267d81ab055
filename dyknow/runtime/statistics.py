"""Figures about a stream, kept while it runs at a small and constant price.

No list of samples or delays is kept: delays are counted in 64 bins of equal width, and when one
does not fit, the width doubles and neighbouring bins become one. A percentile is therefore too
long by at most a thirty-second part of the largest delay.

Most samples of a generator reach its receivers as they are. So the delays are counted once, by
the generator, and a stream counts only what is different: what it leaves out and what it makes.
"""

import math
from dataclasses import dataclass
from typing import Any, Protocol

from dyknow.streams.sample import Sample
from dyknow.time import SECOND, Duration, TimePoint

__all__ = ["Delays", "Figures", "Statistics"]

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

    @classmethod
    def of(cls, figures: "Figures") -> "Statistics":
        """Return the figures of a stream as they stand."""
        delays, first, last = figures.delays, figures.first, figures.last
        span = 0 if first is None or last is None else last.valid_time - first
        return cls(
            samples=delays.samples,
            rate=(delays.samples - 1) * SECOND / span if span > 0 else 0.0,
            mean_delay=delays.mean,
            delay_99=delays.percentile(99),
            largest_delay=Duration(delays.largest),
            violations=figures.violations,
            late=figures.late,
            heartbeats=figures.heartbeats,
        )


class Figures(Protocol):
    """What the statistics of a stream are made of."""

    @property
    def delays(self) -> "Delays":
        """The delays of its samples."""

    @property
    def first(self) -> TimePoint | None:
        """The valid time of its first sample."""

    @property
    def last(self) -> Sample[Any] | None:
        """Its last sample."""

    @property
    def violations(self) -> int:
        """How often the policy could not be kept."""

    @property
    def late(self) -> int:
        """How many samples were left out against the wish of the policy."""

    @property
    def heartbeats(self) -> int:
        """How many heartbeats there were."""


class Delays:
    """How long things took: their number, sum, largest, and distribution.

    Attributes:
        samples: How many delays have been added.
        total: Their sum.
        largest: The largest of them, or 0.
        bins: How many delays are above 0, by their size in widths.
        width: Of a bin, in nanoseconds.
    """

    __slots__ = ("bins", "largest", "samples", "total", "width")

    def __init__(self) -> None:
        self.samples = 0
        self.total = 0
        self.largest = 0
        self.bins = [0] * _N_BINS
        self.width = _WIDTH

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
            self.bins[delay // self.width] += 1

    def percentile(self, percent: float) -> Duration:
        """Return a delay that *percent* of all do not exceed."""
        rank = max(1, math.ceil(self.samples * percent / 100))
        counted = self.samples - sum(self.bins)  # those without a delay are in no bin
        for at, number in enumerate(self.bins):
            if counted >= rank:
                return Duration(min(at * self.width, self.largest))
            counted += number
        return Duration(self.largest)

    def copy(self) -> "Delays":
        """Return the same figures once more."""
        return self.plus(Delays())

    def plus(self, other: "Delays") -> "Delays":
        """Return the figures of both together."""
        return self._combined(other, 1)

    def minus(self, other: "Delays") -> "Delays":
        """Return the figures without those of *other*, which are part of them.

        The largest delay is then known only as well as the bins tell it.
        """
        rest = self._combined(other, -1)
        highest = max((at for at in range(_N_BINS) if rest.bins[at]), default=-1)
        rest.largest = min(self.largest, (highest + 1) * rest.width)
        return rest

    def _combined(self, other: "Delays", sign: int) -> "Delays":
        both = Delays()
        both.samples = self.samples + sign * other.samples
        both.total = self.total + sign * other.total
        both.largest = max(self.largest, other.largest)
        both.width = max(self.width, other.width)
        for part, weight in ((self, 1), (other, sign)):
            step = both.width // part.width
            for at, count in enumerate(part.bins):
                both.bins[at // step] += weight * count
        return both

    def _let_in(self, delay: int) -> None:
        self.largest = delay
        while delay >= self.width * _N_BINS:
            pairs = zip(self.bins[::2], self.bins[1::2], strict=True)
            self.bins = [one + other for one, other in pairs] + [0] * (_N_BINS // 2)
            self.width *= 2

"""Adapters: what turns the samples of a generator into a stream that keeps a policy, online.

Thesis section 4.5.4 (Heintz 2009) leaves open which of several satisfying streams is made. These
adapters hand on each sample as soon as the policy lets them, so that no sample could be added
to what they have handed on. What the policy cannot have is published as a `Violation`, never
raised and never passed over in silence: a sample that comes too late or out of order, and a
sample that is missing under `sample every`. What the policy does not ask for (valid times outside
the duration, repetitions under `any change`, samples off the grid) is left out without a word.
"""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol, runtime_checkable

from dyknow.streams.most_recent import MostRecentSampler
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import Approximation, Policy, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.sampling import Sampler
from dyknow.time import Duration, TimePoint

__all__ = ["Adapter", "ReportsViolations", "VariesPeriod", "adapter_for"]

START = TimePoint(0)


@runtime_checkable
class ReportsViolations(Protocol):
    """An adapter or a unit that cannot always do what is asked of it."""

    def take_violations(self) -> list[Violation]:
        """Return the violations noticed since this was last asked."""


class Adapter(ReportsViolations, Protocol):
    """Makes a stream that keeps a policy from whatever arrives.

    Samples are pushed in order of available time. At one instant, `push` comes before
    `advance`: a sample that arrives at a deadline has met it.
    """

    @property
    def violations(self) -> list[Violation]:
        """What has been noticed and not yet been taken: the same list at all times."""

    @property
    def held(self) -> Sequence[Sample[Any]]:
        """The samples that are kept back and may be handed on later."""

    def push(self, sample: Sample[Any]) -> Sequence[Sample[Any]]:
        """Take in a sample at its available time and yield what can be handed on."""

    def beat(self, heartbeat: Heartbeat) -> Iterable[Element]:
        """Take in a heartbeat; yield what is certain now, then a heartbeat of the stream made.

        At one instant, `push` comes before `beat`.
        """

    def advance(self, now: TimePoint) -> Iterable[Sample[Any]]:
        """Let time pass up to and including *now* and yield what has fallen due."""

    def due(self) -> TimePoint | None:
        """Return the next deadline, if there is one; no sample brings it nearer."""


@runtime_checkable
class VariesPeriod(Protocol):
    """An adapter whose sample period can be changed while it works.

    Attributes:
        period: The period in force.
    """

    period: Duration

    def set_period(self, period: Duration, now: TimePoint) -> Iterable[Sample[Any]]:
        """Go on with another of the periods that the policy allows; yield what falls due.

        Raises:
            ValueError: The policy does not allow the period.
        """


def adapter_for(policy: Policy, now: TimePoint = START) -> Adapter | None:
    """Return an adapter that begins its work at *now*; None if *policy* restricts nothing."""
    if policy == Policy():
        return None
    if policy.approximation is Approximation.MOST_RECENT:
        return MostRecentSampler(policy, now)
    if policy.period is not None:
        return Sampler(policy)
    return Filter(policy)

"""How a stream begins: fresh, with samples of the past, or in the place of another one."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from dyknow.errors import PolicyNotSupportedError
from dyknow.runtime.cache import CachedStream
from dyknow.runtime.generators import StreamGenerator
from dyknow.runtime.statistics import Figures
from dyknow.streams.adapter import Adapter, adapter_for
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import Approximation, Policy
from dyknow.streams.process import Element
from dyknow.streams.sample import BEGINNING_OF_TIME, END_OF_TIME, Heartbeat, Sample
from dyknow.time import TimePoint, text_from_duration

__all__ = ["Beginning", "Begun", "beginning", "check_past", "continuation"]


@dataclass(slots=True)
class Beginning:
    """What a stream begins with.

    Attributes:
        begin: The first time-point at which something is handed on.
        adapter: Makes the stream.
        waiting: What the adapter has handed on already and will be available later.
        older: What the adapter is to be told before what arrives.
        predecessor: The stream whose figures the new one goes on from.
    """

    begin: TimePoint
    adapter: Adapter
    waiting: Sequence[Element] = ()
    older: Sequence[Element] = ()
    predecessor: Figures | None = None


class Begun(Figures, Protocol):
    """A stream that another one can continue."""

    @property
    def waiting(self) -> Sequence[Element]:
        """What the adapter has handed on already and will be available later."""

    @property
    def held(self) -> Sequence[Sample[Any]]:
        """What the adapter keeps back."""

    @property
    def older(self) -> Sequence[Element]:
        """What the adapter is still to be told before what arrives."""


def check_past(past: CachedStream, policy: Policy, begin: TimePoint) -> None:
    """Raise an error if a stream under *policy* would lack samples that are not held any more."""
    if policy.start is not None:
        earliest = _earliest(policy.start, policy, begin)
        if past.lost_until >= earliest:
            raise PolicyNotSupportedError(
                past.label,
                f"the stream would begin at {text_from_duration(earliest)}, and of the samples "
                f"since then only the last {past.size} are held",
            )


def beginning(
    generator: StreamGenerator, policy: Policy, begin: TimePoint, past: CachedStream | None = None
) -> Beginning:
    """Return what a stream begins with that takes no other's place.

    If the policy says from when on the stream is wanted, it begins with those samples of the
    *past* that can still be in time; else with the next sample.
    """
    adapter, older = _adapter(policy, begin), list[Element]()
    if policy.start is not None and past is not None:
        earliest = _earliest(policy.start, policy, begin)
        _let_know_value(adapter, policy, past, earliest)
        older.extend(past.between(earliest, END_OF_TIME))
    return Beginning(begin, adapter, older=[*older, *_promise(generator, begin)])


def continuation(
    generator: StreamGenerator, policy: Policy, begin: TimePoint, other: Begun
) -> Beginning:
    """Return what a stream begins with that goes on under *policy* where *other* ends.

    What the other stream has yet to hand on or has held back is not lost, nothing is handed on
    twice, and the order of valid times goes on across the change. What it has left out is not
    asked for again.
    """
    coming = [element for element in other.waiting if isinstance(element, Sample)]
    last = coming[-1] if coming else other.last
    unsettled = [*other.held, *other.older]
    if policy.approximation is Approximation.MOST_RECENT:
        after = BEGINNING_OF_TIME if last is None else TimePoint(last.valid_time + 1)
        earliest = _earliest(max(policy.first, after), policy, begin)
        adapter = _adapter(policy, TimePoint(earliest + (policy.max_delay or 0)))
        _let_know_value(adapter, policy, generator, earliest)
        unsettled = _known_from(earliest, generator, unsettled)
    else:
        adapter = _adapter(policy, begin)
        if last is not None:
            wanted = _next_wanted(generator, policy, begin, unsettled)
            _tell_silently(adapter, _before(wanted, last, policy, begin))
    older = [*unsettled, *_promise(generator, begin)]
    return Beginning(begin, adapter, other.waiting, older, other)


def _adapter(policy: Policy, begin: TimePoint) -> Adapter:
    return adapter_for(policy, begin) or Filter(policy)


def _earliest(wanted: TimePoint, policy: Policy, begin: TimePoint) -> TimePoint:
    """Return the first valid time from *wanted* on that can still be in time."""
    if policy.max_delay is None:
        return wanted
    return max(wanted, TimePoint(begin - policy.max_delay))


def _promise(generator: StreamGenerator, begin: TimePoint) -> list[Heartbeat]:
    """Return the last heartbeat once more, if there was one."""
    until = generator.complete_until
    return [] if until == BEGINNING_OF_TIME else [Heartbeat(until, begin)]


def _known_from(
    earliest: TimePoint, generator: StreamGenerator, unsettled: list[Element]
) -> list[Element]:
    """Return all samples valid from *earliest* on that are known, and what else is unsettled."""
    known = [
        sample
        for sample in generator.samples
        if sample.valid_time >= earliest and not any(sample is other for other in unsettled)
    ]
    return [*known, *unsettled]


def _let_know_value(adapter: Adapter, policy: Policy, past: CachedStream, time: TimePoint) -> None:
    """Let an adapter that approximates know the value that held before *time*."""
    known = past.find_at_or_before(TimePoint(time - 1))
    if policy.approximation is Approximation.MOST_RECENT and known is not None:
        _tell_silently(adapter, known)


def _next_wanted(
    generator: StreamGenerator, policy: Policy, begin: TimePoint, unsettled: list[Element]
) -> TimePoint:
    """Return the first valid time that can still come, or that is unsettled."""
    passed = [
        sample.valid_time
        for sample in generator.samples
        if not any(sample is other for other in unsettled)
    ]
    return _earliest(TimePoint(max([generator.lost_until, *passed]) + 1), policy, begin)


def _before(wanted: TimePoint, last: Sample[Any], policy: Policy, begin: TimePoint) -> Sample[Any]:
    """Return the sample after which the first one valid from *wanted* on would be the next.

    That is *last*, or where it would have come to by steps of the policy's period. It has no
    delay, so that it counts whatever delay the policy allows.
    """
    steps = 0
    if policy.period is not None:
        steps = max(0, -((last.valid_time - wanted) // policy.period) - 1)
    valid_time = TimePoint(last.valid_time + steps * (policy.period or 0))
    return Sample(last.value, valid_time, min(valid_time, TimePoint(begin - 1)))


def _tell_silently(adapter: Adapter, sample: Sample[Any]) -> None:
    """Push a sample that is neither to be handed on nor a violation."""
    for _ in adapter.push(sample):
        pass
    adapter.take_violations()

"""Whether a recorded stream is one of those that its policy allows to make of its provider's.

Definitions 4.5.9 to 4.5.11 of Heintz (2009) leave open which one is made. Written down naively
they stand in `dyknow.streams.conformance`; here they are decided in one pass over the streams,
sample by sample, so that every breach has its place:

- a sample that the provider has not given, or not yet, or that was handed on before (4.5.9)
- a sample that would have fitted in and was left out, or that was held back without need (4.5.10);
  what could only be put in later than it was available does not count, since the definition
  would have no maximal streams then
- a constraint that is not kept (4.5.11)
"""

from bisect import bisect_left, bisect_right, insort
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise
from typing import Any

from dyknow.judging.declared import DeclaredStream
from dyknow.judging.judgement import Breach, Definition
from dyknow.judging.wording import deviation, short, times
from dyknow.streams.conformance import violations
from dyknow.streams.policy import Approximation, Constraint, Policy, SampleEvery, Violation
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint

__all__ = ["TermBreaches", "extended", "policy_breaches"]

Samples = Sequence[Sample[Any]]


def extended(samples: Samples, policy: Policy, until: TimePoint) -> list[Sample[Any]]:
    """Return the samples that a stream may be made of, up to the time *until* (def. 4.5.10).

    Without approximation these are the provider's. With `use most recent` there are, for each time
    of the grid, the samples of exactly that valid time which come in time, or else an
    approximation at the end of the maximal delay.
    """
    if policy.approximation is Approximation.NONE:
        return [sample for sample in samples if sample.available_time <= until]
    assert policy.period is not None  # the policy says so itself
    assert policy.max_delay is not None
    last = until if policy.end is None else min(until, policy.end)
    made: list[Sample[Any]] = []
    arrived: list[Sample[Any]] = []
    arrivals = iter(samples)
    head = next(arrivals, None)
    for time in range(policy.first, last + 1, policy.period):
        deadline = TimePoint(time + policy.max_delay)
        while head is not None and head.available_time <= min(deadline, until):
            insort(arrived, head, key=_valid_time)
            head = next(arrivals, None)
        made.extend(_at_time(arrived, TimePoint(time), deadline))
    return sorted((each for each in made if each.available_time <= until), key=_available_time)


def _at_time(
    arrived: list[Sample[Any]], time: TimePoint, deadline: TimePoint
) -> Iterator[Sample[Any]]:
    """Yield what may stand for a time of the grid; forget what is older than the most recent."""
    first = bisect_left(arrived, time, key=_valid_time)
    if first < len(arrived) and arrived[first].valid_time == time:
        del arrived[:first]
        for sample in arrived:
            if sample.valid_time != time:
                return
            yield sample
    elif first > 0:
        del arrived[: first - 1]
        yield Sample(arrived[0].value, time, deadline)


class TermBreaches:
    """Finds where a recorded stream is not one that its term allows.

    Args:
        stream: The term.
        recorded: The samples of the stream, in strict order of available time.
        provider: Those of its provider, alike.
        adapted: What the adapter of the policy makes of the provider's samples: as soon as it
            hands a sample on, the stream must have it.
        published: What was published of the stream: a gap that was is no breach.
        until: The end of the execution.
    """

    def __init__(
        self,
        stream: DeclaredStream,
        recorded: Samples,
        provider: Samples,
        adapted: Samples,
        published: Collection[Violation],
        until: TimePoint,
    ) -> None:
        self._missing = _missing_times(published)
        self._stream = stream
        self._policy = stream.policy
        self._recorded = recorded
        self._adapted = {sample.valid_time: sample for sample in adapted}
        self._extended = extended(provider, stream.policy, until)
        self._by_valid_time: dict[TimePoint, list[Sample[Any]]] = {}
        self._by_available_time: dict[TimePoint, list[Sample[Any]]] = {}
        for sample in self._extended:
            self._by_valid_time.setdefault(sample.valid_time, []).append(sample)
            self._by_available_time.setdefault(sample.available_time, []).append(sample)
        self._used: set[int] = set()

    def all(self) -> list[Breach]:
        """Return all breaches in order of available time."""
        found = [breach for sample in self._recorded for breach in self._origin(sample)]
        found.extend(self._left_out())
        return sorted(found, key=lambda breach: breach.available_time or 0)

    def _origin(self, sample: Sample[Any]) -> Iterator[Breach]:
        """Yield a breach if *sample* has no origin of its own, or was held back."""
        candidates = self._by_valid_time.get(sample.valid_time, [])
        same = [each for each in candidates if are_equal(each.value, sample.value)]
        unused = [each for each in same if id(each) not in self._used]
        in_time = [each for each in unused if each.available_time <= sample.available_time]
        if in_time:
            yield from self._held_back(self._use(in_time[0]), sample)
        elif unused:
            expected, found = deviation(self._use(unused[0]), sample)
            yield self._at(sample, Definition.SUBSTREAM, f"{expected} at the earliest", found)
        elif same:
            yield self._at(sample, Definition.SUBSTREAM, "each sample once", "the sample again")
        else:
            yield self._stranger(sample, candidates)

    def _use(self, origin: Sample[Any]) -> Sample[Any]:
        self._used.add(id(origin))
        return origin

    def _held_back(self, origin: Sample[Any], sample: Sample[Any]) -> Iterator[Breach]:
        prompt = origin
        if self._policy.period is not None:
            prompt = self._adapted.get(sample.valid_time, sample)
        if sample.available_time > prompt.available_time:
            expected, found = deviation(prompt, sample)
            yield self._at(sample, Definition.TERM, expected, found)

    def _stranger(self, sample: Sample[Any], candidates: Samples) -> Breach:
        """Return the breach that *sample* is, and take it for the sample it resembles."""
        near = self._by_available_time.get(sample.available_time, [])
        moved = [each for each in near if are_equal(each.value, sample.value)]
        for origin in (*candidates, *moved):
            if id(origin) not in self._used:
                expected, found = deviation(self._use(origin), sample)
                return self._at(sample, Definition.SUBSTREAM, expected, found)
        wanted = f"a sample of '{self._stream.provider}'"
        if self._policy.approximation is Approximation.MOST_RECENT:
            wanted += " or an approximation"
        return self._at(sample, Definition.SUBSTREAM, wanted, short(sample.value))

    def _left_out(self) -> Iterator[Breach]:
        """Yield a breach for each sample that would fit into the stream and is not there."""
        available_times = [sample.available_time for sample in self._recorded]
        for sample in self._extended:
            if id(sample) in self._used:
                continue
            at = bisect_right(available_times, sample.available_time)
            before = self._recorded[at - 1] if at > 0 else None
            after = self._recorded[at] if at < len(self._recorded) else None
            if after is None and not self._has_been_due(sample):
                continue
            if self._fits(before, sample, after):
                wanted = f"the sample {times(sample)}: {short(sample.value)}"
                yield self._at(sample, Definition.TERM, wanted, "it left out")

    def _has_been_due(self, sample: Sample[Any]) -> bool:
        """Return whether *sample* had to be handed on before the execution ended."""
        if self._policy.period is None:
            return True
        adapted = self._adapted.get(sample.valid_time)
        return adapted is not None and are_equal(adapted.value, sample.value)

    def _fits(
        self, before: Sample[Any] | None, sample: Sample[Any], after: Sample[Any] | None
    ) -> bool:
        """Return whether a stream keeps its policy no less with *sample* between two others."""
        if violations([sample], self._policy):
            return False
        follows = before is None or self._may_follow(before, sample)
        precedes = after is None or self._may_follow(sample, after)
        if before is None or after is None or self._may_follow(before, after):
            return follows and precedes
        is_between = before.valid_time < sample.valid_time < after.valid_time
        return is_between and (follows or precedes or self._is_on_grid(before, sample))

    def _is_on_grid(self, before: Sample[Any], sample: Sample[Any]) -> bool:
        """Return whether whole periods lie between two samples of a sampled stream."""
        match self._policy.change:
            case SampleEvery(period, deviation=0):
                return (sample.valid_time - before.valid_time) % period == 0
            case _:
                return False

    def _may_follow(self, before: Sample[Any], sample: Sample[Any]) -> bool:
        kept = Policy(change=self._policy.change, order=self._policy.order)
        if not violations([before, sample], kept):
            return True
        at = bisect_right(self._missing, before.valid_time)
        is_published = at < len(self._missing) and self._missing[at] < sample.valid_time
        return is_published and self._is_on_grid(before, sample)

    def _at(
        self, sample: Sample[Any], definition: Definition, expected: str, found: str
    ) -> Breach:
        return Breach.at(self._stream.topic, definition, sample, expected, found)


def policy_breaches(
    stream: DeclaredStream, recorded: Samples, published: Collection[Violation]
) -> Iterator[Breach]:
    """Yield where a stream does not keep its policy (def. 4.5.11) and nothing says so.

    That samples are missing under `sample every` is no breach if it was published.
    """
    missing = _missing_times(published)
    times_before = {
        sample.available_time: before.valid_time for before, sample in pairwise(recorded)
    }
    for violation in violations(recorded, stream.policy):
        before = times_before.get(violation.noticed_at, violation.valid_time)
        at = bisect_right(missing, before)
        is_gap = violation.constraint is Constraint.CHANGE and stream.policy.period is not None
        if is_gap and at < len(missing) and missing[at] < violation.valid_time:
            continue
        unpublished = " and no violation published" if is_gap else ""
        yield Breach(
            stream.topic,
            Definition.POLICY,
            f"'{violation.constraint.value}' to be kept",
            violation.reason + unpublished,
            violation.valid_time,
            violation.noticed_at,
        )


def _missing_times(published: Collection[Violation]) -> list[TimePoint]:
    """Return the valid times of which it was published that there is no sample, in order."""
    return sorted(each.valid_time for each in published if each.constraint is Constraint.CHANGE)


def _valid_time(sample: Sample[Any]) -> TimePoint:
    return sample.valid_time


def _available_time(sample: Sample[Any]) -> TimePoint:
    return sample.available_time

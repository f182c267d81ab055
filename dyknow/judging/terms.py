"""Whether a recorded stream is one of those that its policy allows to make of its provider's.

What is allowed stands in `dyknow.streams.conformance` and what that rests on: definitions 4.5.9 to
4.5.11 of Heintz (2009), which leave open which of several streams is made. Here each sample is
traced to the one it comes from, so that a breach is told by what is wrong with the sample, and
what is wrong with one does not hide what is wrong with others. Beyond the definitions, a stream
is in time: adapters hand on what a policy lets through as soon as that is certain, and not
before.
"""

from bisect import bisect_right
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise
from typing import Any

from dyknow.judging.declared import DeclaredStream
from dyknow.judging.judgement import Breach, Definition
from dyknow.judging.wording import deviation, short, times
from dyknow.runtime.generators import ANYTHING
from dyknow.streams.approximation import extend
from dyknow.streams.conformance import violations
from dyknow.streams.maximality import omissions
from dyknow.streams.policy import Approximation, Constraint, Policy, SampleEvery, Violation
from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint

__all__ = ["TermBreaches", "may_vary", "policy_breaches"]

Samples = Sequence[Sample[Any]]


def may_vary(policy: Policy) -> bool:
    """Return whether a stream may have had another period for a while, because of the load."""
    return isinstance(policy.change, SampleEvery) and policy.change.longest is not None


class TermBreaches:
    """Finds where a recorded stream is not one that its term allows.

    Args:
        stream: The term.
        recorded: The samples of the stream, in strict order of available time.
        provider: Those of its provider, alike.
        adapted: What the adapter of the policy makes of the provider's samples: as soon as it
            hands a sample on, the stream must have it.
        until: The end of the execution.
    """

    def __init__(
        self,
        stream: DeclaredStream,
        recorded: Samples,
        provider: Samples,
        adapted: Samples,
        until: TimePoint,
    ) -> None:
        self._stream = stream
        self._policy = stream.policy
        self._recorded = recorded
        self._provider = provider
        self._adapted = {sample.valid_time: sample for sample in adapted}
        self._until = until
        self._by_valid_time: dict[TimePoint, list[Sample[Any]]] = {}
        self._by_available_time: dict[TimePoint, list[Sample[Any]]] = {}
        for sample in extend(provider, stream.policy, until):
            self._by_valid_time.setdefault(sample.valid_time, []).append(sample)
            self._by_available_time.setdefault(sample.available_time, []).append(sample)
        self._used: dict[int, TimePoint] = {}

    def all(self) -> list[Breach]:
        """Return all breaches in order of available time."""
        found = [breach for sample in self._recorded for breach in self._origin(sample)]
        found.extend(self._left_out())
        return sorted(found, key=lambda breach: breach.available_time or 0)

    def _origin(self, sample: Sample[Any]) -> Iterator[Breach]:
        """Yield a breach if *sample* has no origin of its own, or came out of time."""
        candidates = self._by_valid_time.get(sample.valid_time, [])
        same = [each for each in candidates if are_equal(each.value, sample.value)]
        unused = [each for each in same if id(each) not in self._used]
        in_time = [each for each in unused if each.available_time <= sample.available_time]
        if in_time:
            yield from self._out_of_time(self._use(in_time[-1], sample), sample)
        elif unused:
            expected, found = deviation(self._use(unused[0], sample), sample)
            yield self._at(sample, Definition.SUBSTREAM, f"{expected} at the earliest", found)
        elif same:
            yield self._at(sample, Definition.SUBSTREAM, "each sample once", "the sample again")
        else:
            yield self._stranger(sample, candidates)

    def _use(self, origin: Sample[Any], sample: Sample[Any]) -> Sample[Any]:
        self._used[id(origin)] = sample.available_time
        return origin

    def _out_of_time(self, origin: Sample[Any], sample: Sample[Any]) -> Iterator[Breach]:
        prompt = origin
        if self._policy.period is not None:
            prompt = self._adapted.get(sample.valid_time, sample)
        is_hasty = sample.available_time < prompt.available_time and not may_vary(self._policy)
        if sample.available_time > prompt.available_time or is_hasty:
            expected, found = deviation(prompt, sample)
            yield self._at(sample, Definition.TERM, expected, found)

    def _stranger(self, sample: Sample[Any], candidates: Samples) -> Breach:
        """Return the breach that *sample* is, and take it for the sample it resembles."""
        near = self._by_available_time.get(sample.available_time, [])
        moved = [each for each in near if are_equal(each.value, sample.value)]
        for origin in (*candidates, *moved):
            if id(origin) not in self._used:
                expected, found = deviation(self._use(origin, sample), sample)
                return self._at(sample, Definition.SUBSTREAM, expected, found)
        wanted = f"a sample of '{self._stream.provider}'"
        if self._policy.approximation is Approximation.MOST_RECENT:
            wanted += " or an approximation"
        return self._at(sample, Definition.SUBSTREAM, wanted, short(sample.value))

    def _left_out(self) -> Iterator[Breach]:
        """Yield a breach for each sample that would fit into the stream and is not there."""
        repaired = self._repaired()
        for sample in (*self._late_beginning(repaired), *self._omissions(repaired)):
            wanted = f"the sample {times(sample)}: {short(sample.value)}"
            yield self._at(sample, Definition.TERM, wanted, "it left out")

    def _repaired(self) -> list[Sample[Any]]:
        """Return the stream as it would be if every sample were what it comes from."""
        origins = (each for group in self._by_valid_time.values() for each in group)
        used = [
            Sample(each.value, each.valid_time, max(each.available_time, self._used[id(each)]))
            for each in origins
            if id(each) in self._used
        ]
        repaired: list[Sample[Any]] = []
        for sample in sorted(used, key=lambda each: each.available_time):
            if repaired and sample.available_time <= repaired[-1].available_time:
                sample.available_time = TimePoint(repaired[-1].available_time + 1)
            repaired.append(sample)
        return repaired

    def _late_beginning(self, repaired: Samples) -> Iterator[Sample[Any]]:
        """Yield where a sampled stream has to begin, if it begins later.

        By the definition it might begin anywhere; adapters begin as soon as there is a sample.
        """
        first = next(iter(self._adapted.values()), None)
        if self._policy.period is None or first is None:
            return
        if not repaired or repaired[0].valid_time > first.valid_time:
            yield first

    def _omissions(self, repaired: Samples) -> Iterator[Sample[Any]]:
        """Yield what else could be added."""
        is_sampled = self._policy.period is not None
        is_sound = all(
            each.constraint is Constraint.CHANGE and is_sampled
            for each in violations(repaired, self._policy)
        )
        if is_sound and (repaired or not is_sampled):
            beginning = {id(each) for each in self._late_beginning(repaired)}
            for sample in omissions(repaired, self._provider, self._policy, self._until):
                if id(sample) not in beginning and self._has_been_due(sample, repaired):
                    yield sample

    def _has_been_due(self, sample: Sample[Any], repaired: Samples) -> bool:
        """Return whether *sample* had to be there when the execution ended.

        A sampled stream may still have been waiting for what comes before it.
        """
        is_last = not repaired or sample.valid_time > repaired[-1].valid_time
        return not is_last or self._policy.period is None or sample.valid_time in self._adapted

    def _at(
        self, sample: Sample[Any], definition: Definition, expected: str, found: str
    ) -> Breach:
        return Breach.at(self._stream.topic, definition, sample, expected, found)


def policy_breaches(
    stream: DeclaredStream, recorded: Samples, published: Collection[Violation]
) -> Iterator[Breach]:
    """Yield where a stream does not keep its policy (def. 4.5.11) and nothing says so.

    That samples are missing under `sample every` is no breach if it was published. A policy that
    says nothing restricts nothing, not to times after 0 either.
    """
    if stream.policy == ANYTHING:
        return
    missing = sorted(each.valid_time for each in published if each.constraint is Constraint.CHANGE)
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

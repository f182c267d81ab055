"""What a stream has left out although its policy would have let it through.

A stream is maximal (Heintz 2009, definition 4.5.10) if no sample of the extended stream could be
added to it, at whatever available time, without breaking the policy. That two samples could be
added together but neither alone can only happen under `any change`, with two that take turns
between two of the stream: a b, where it could be a b a b. `dyknow.streams.conformance` says
where this departs from the letter of the definition.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from dyknow.streams.approximation import ExtendedSample, extended_samples
from dyknow.streams.content import Contents
from dyknow.streams.ordering import LEAST_STEP, NEVER
from dyknow.streams.policy import ANY_CHANGE, Order, Policy, SampleEvery
from dyknow.streams.sample import Sample
from dyknow.streams.stream import FluentStream
from dyknow.time import TimePoint

__all__ = ["omissions"]


def omissions(
    part: FluentStream, whole: FluentStream, policy: Policy, until: TimePoint
) -> list[Sample[Any]]:
    """Return samples of the extended stream that could be added to *part*, in its order.

    None is returned if and only if *part* is maximal. *part* is a substream of the extended
    stream that satisfies *policy*, except that samples may be missing under `sample every`: what
    lies in such a gap is returned too.
    """
    extended = [
        one
        for one in extended_samples(whole, policy, until)
        if one.due <= until
        and policy.covers(one.sample.valid_time)
        and policy.allows_delay(one.sample.delay)
    ]
    if isinstance(policy.change, SampleEvery):
        found = _Sampled(part, policy.change, policy).omissions(extended)
    elif policy.change is ANY_CHANGE:
        found = _Changing(part, [one.sample for one in extended], policy).omissions()
    else:
        found = _updates(part, [one.sample for one in extended], policy)
    return sorted(found, key=lambda sample: sample.available_time)


class _Sampled:
    """A stream with a sample period, in which every valid time has its place."""

    def __init__(self, part: FluentStream, change: SampleEvery, policy: Policy) -> None:
        self._part = part
        self._valid_times = [sample.valid_time for sample in part]
        self._change = change
        self._max_delay = _max_delay(policy)

    def omissions(self, extended: Sequence[ExtendedSample]) -> list[Sample[Any]]:
        """Return, of each valid time that has been left out, the first sample."""
        found: dict[TimePoint, Sample[Any]] = {}
        for one in extended:
            if self._could_be_added(one.sample):
                found.setdefault(one.sample.valid_time, one.sample)
        return list(found.values())

    def _could_be_added(self, sample: Sample[Any]) -> bool:
        at = bisect_left(self._valid_times, sample.valid_time)
        before = self._part[at - 1] if at else None
        after = self._part[at] if at < len(self._part) else None
        if after is not None and after.valid_time == sample.valid_time:
            return False
        first = -1 if before is None else before.available_time
        last = NEVER if after is None else after.available_time
        return (
            self._fits(before, sample, after)
            and _place(first, sample, last, self._max_delay) is not None
        )

    def _fits(
        self, before: Sample[Any] | None, sample: Sample[Any], after: Sample[Any] | None
    ) -> bool:
        change, aim = self._change, self._change.longest_period
        step = aim if before is None else sample.valid_time - before.valid_time
        rest = aim if after is None else after.valid_time - sample.valid_time
        if before is None or after is None:
            return abs(step - aim) <= change.deviation >= abs(rest - aim)
        if change.allows_step(step + rest):
            return change.longest is None and change.allows_step(step) and change.allows_step(rest)
        nearest = max(1, (step + aim // 2) // aim) * aim
        return abs(step - nearest) <= change.deviation and rest >= aim - change.deviation


def _updates(part: FluentStream, whole: FluentStream, policy: Policy) -> list[Sample[Any]]:
    """Return, of each content that is in *whole* more often than in *part*, one that fits in."""
    contents = Contents()
    given: dict[int, list[Sample[Any]]] = {}
    made: dict[int, list[TimePoint]] = {}
    for sample in whole:
        given.setdefault(contents.number(sample), []).append(sample)
    for sample in part:
        made.setdefault(contents.number(sample), []).append(sample.available_time)
    places = _Places(part, policy)
    spare = (_spare(samples, made.get(number, [])) for number, samples in given.items())
    return [sample for sample in spare if sample is not None and places.have_room(sample)]


def _spare(given: FluentStream, made: Sequence[TimePoint]) -> Sample[Any] | None:
    """Return the earliest of *given*, which say the same, that is not needed for those *made*."""
    if len(given) <= len(made):
        return None
    at = len(made)
    while at and made[at - 1] >= given[at].available_time:
        at -= 1
    return given[at]


class _Places:
    """Where samples could be added to a stream without regard to those it repeats."""

    def __init__(self, part: FluentStream, policy: Policy) -> None:
        self._times = [sample.available_time for sample in part]
        self._valid_times = [sample.valid_time for sample in part]
        self._order = policy.order
        self._max_delay = _max_delay(policy)

    def have_room(self, sample: Sample[Any]) -> bool:
        """Return whether *sample* fits in at some available time."""
        first, last = int(sample.available_time), sample.valid_time + self._max_delay
        if self._order is not Order.ANY:
            begin = bisect_left(self._valid_times, sample.valid_time)
            end = bisect_right(self._valid_times, sample.valid_time)
            if self._order is Order.STRICT and begin < end:
                return False
            first = max(first, self._times[begin - 1] + 1) if begin else first
            last = min(last, self._times[end] - 1) if end < len(self._times) else last
        return self._next_free(first) <= last

    def _next_free(self, time: int) -> int:
        at = bisect_left(self._times, time)
        while at < len(self._times) and self._times[at] == time:
            at, time = at + 1, time + 1
        return time


_Said = tuple[int, Sample[Any]]
"""A sample, and the number of what it says."""


class _Changing:
    """A stream under `any change` and the stream out of which it is made, in the same order."""

    def __init__(self, part: FluentStream, whole: FluentStream, policy: Policy) -> None:
        contents = Contents()
        self._given = [(contents.number(sample), sample) for sample in whole]
        self._made = [(contents.number(sample), sample) for sample in part]
        self._least_step = LEAST_STEP[policy.order]
        self._max_delay = _max_delay(policy)

    def omissions(self) -> list[Sample[Any]]:
        """Return the samples that could be added; none if the order is another one already."""
        first, last = self._first_origins(), self._last_origins()
        if len(first) < len(self._made):
            return []
        found: set[int] = set()
        gaps = zip([-1, *first], [*last, len(self._given)], strict=True)
        for (before, after), (begin, end) in zip(self._neighbours(), gaps, strict=True):
            found.update(self._in_gap(before, after, range(begin + 1, end)))
        return [self._given[at][1] for at in sorted(found)]

    def _first_origins(self) -> list[int]:
        """Return the first positions, in order, from which the samples of the stream can come."""
        return list(self._origins(iter(range(len(self._given))), self._made))

    def _last_origins(self) -> list[int]:
        """Return the last positions, in order, from which the samples of the stream can come."""
        backwards = reversed(range(len(self._given)))
        return list(self._origins(backwards, self._made[::-1]))[::-1]

    def _origins(self, positions: Iterator[int], made: list[_Said]) -> Iterator[int]:
        """Yield the next of *positions* for each sample, until there is none for one of them."""
        for one in made:
            origin = next((at for at in positions if self._is_origin(at, one)), None)
            if origin is not None:
                yield origin

    def _is_origin(self, at: int, made: _Said) -> bool:
        number, sample = self._given[at]
        return number == made[0] and sample.available_time <= made[1].available_time

    def _neighbours(self) -> Iterator[tuple[_Said | None, _Said | None]]:
        return pairwise([None, *self._made, None])

    def _in_gap(
        self, before: _Said | None, after: _Said | None, candidates: range
    ) -> Iterator[int]:
        """Yield which of *candidates* could be added, alone or in pairs, between two samples."""
        alone = [at for at in candidates if self._fits(before, self._given[at], after)]
        yield from alone
        if not alone and before is not None and after is not None:
            yield from self._taking_turns(before, after, candidates)

    def _taking_turns(self, before: _Said, after: _Said, candidates: range) -> Iterator[int]:
        """Yield the positions of a repetition of *after* and one of *before* that follows it."""
        positions = iter(candidates)
        one = next((at for at in positions if self._given[at][0] == after[0]), None)
        other = next((at for at in positions if self._given[at][0] == before[0]), None)
        if one is None or other is None or not self._may_follow(before, after):
            return
        first, second, limit = self._given[one][1], self._given[other][1], after[1].available_time
        place = _place(before[1].available_time, first, limit, self._max_delay)
        if place is None or not self._may_follow(after, before):
            return
        if _place(place, second, limit, self._max_delay) is not None:
            yield from (one, other)

    def _fits(self, before: _Said | None, one: _Said, after: _Said | None) -> bool:
        if before is not None and not self._may_follow(before, one):
            return False
        if after is not None and not self._may_follow(one, after):
            return False
        first = -1 if before is None else before[1].available_time
        last = NEVER if after is None else after[1].available_time
        return _place(first, one[1], last, self._max_delay) is not None

    def _may_follow(self, before: _Said, one: _Said) -> bool:
        step = one[1].valid_time - before[1].valid_time
        return step >= self._least_step and before[0] != one[0]


def _place(before: int, sample: Sample[Any], after: int, max_delay: int) -> int | None:
    """Return the first time between two others at which *sample* can become available in time."""
    place = max(before + 1, sample.available_time)
    return place if place <= min(after - 1, sample.valid_time + max_delay) else None


def _max_delay(policy: Policy) -> int:
    return NEVER if policy.max_delay is None else policy.max_delay

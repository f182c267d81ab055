"""States by their definition, streams to make them from, and what a unit makes of streams."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from hypothesis import strategies as st

from dyknow.streams.interpolation import interpolate
from dyknow.streams.policy import Order, Policy, SampleEvery
from dyknow.streams.process import ComputationalUnit, Element, HearsHeartbeats
from dyknow.streams.sample import END_OF_TIME, NO_SAMPLE, NO_VALUE, Heartbeat, Sample
from dyknow.streams.state_policy import Occasion, Settling, StateApproximation, StatePolicy
from dyknow.streams.values import are_equal
from dyknow.time import Duration, TimePoint

__all__ = [
    "Given",
    "delayed_again",
    "given_inputs",
    "naive_states",
    "run_synchronisation",
    "samples_of",
    "state_policies",
    "timeless_states",
]


@dataclass
class Given:
    """A finished stream, with heartbeats, and the policy that it keeps."""

    policy: Policy
    elements: list[Element] = field(default_factory=list)


def samples_of(elements: Sequence[Element]) -> list[Sample[Any]]:
    """Return what is not a heartbeat."""
    return [element for element in elements if isinstance(element, Sample)]


def run_synchronisation(
    unit: ComputationalUnit, streams: Sequence[list[Element]], until: TimePoint, tick: int = 0
) -> list[Element]:
    """Apply a unit to finished streams with heartbeats, one instant after another.

    At each instant come samples, then heartbeats, then alarms. With *tick*, the unit is also told
    the time at every multiple of it.
    """
    arrivals = {element.available_time for given in streams for element in given}
    ticks = set(range(0, until + 1, tick)) if tick else set()
    pending = sorted(time for time in arrivals | ticks if time <= until)
    last = [NO_SAMPLE] * len(streams)
    produced: list[Element] = []
    while True:
        due = unit.due()
        times = [*pending[:1], *([due] if due is not None and due <= until else [])]
        if not times:
            return produced
        now = TimePoint(min(times))
        if pending and pending[0] == now:
            pending.pop(0)
            produced.extend(_tell(unit, now, streams, last))
        produced.extend(unit.advance(now))


def _tell(
    unit: ComputationalUnit,
    now: TimePoint,
    streams: Sequence[list[Element]],
    last: list[Sample[Any]],
) -> Iterator[Element]:
    beats: list[tuple[int, Heartbeat]] = []
    has_news = False
    for at, given in enumerate(streams):
        for element in given:
            if element.available_time != now:
                continue
            if isinstance(element, Heartbeat):
                beats.append((at, element))
            else:
                last[at], has_news = element, True
    if has_news:
        yield from unit.push(now, tuple(last))
    assert isinstance(unit, HearsHeartbeats)
    for at, heartbeat in beats:
        yield from unit.beat(now, at, heartbeat)


def timeless_states(
    streams: Sequence[Given], policy: StatePolicy
) -> list[tuple[TimePoint, tuple[Any, ...]]]:
    """Return valid times and values of the states of complete streams, whenever they came.

    This is what reproducible joins make when no delay runs out.
    """
    states: list[tuple[TimePoint, tuple[Any, ...]]] = []
    samples = [samples_of(given.elements) for given in streams]
    for time in _times(streams, policy):
        values = tuple(_value(given, time, policy.approximation) for given in samples)
        if any(value is None for value in values):
            if not policy.is_sampled:
                continue
            values = tuple(NO_VALUE if value is None else value for value in values)
        if not states or _is_wanted(samples, policy, states[-1], (time, values)):
            states.append((time, values))
    return states


def _times(streams: Sequence[Given], policy: StatePolicy) -> Iterator[TimePoint]:
    samples = [samples_of(given.elements) for given in streams]
    valid_times = sorted({sample.valid_time for given in samples for sample in given})
    first = policy.start
    if policy.is_sampled:
        if first is None:
            if not all(samples):
                return
            first = max(min(sample.valid_time for sample in given) for given in samples)
        assert policy.period is not None
        last = max([-1, *valid_times, min(_promised(given) for given in streams)])
        last = last if policy.end is None else policy.end
        valid_times = [TimePoint(time) for time in range(first, last + 1, policy.period)]
    for time in valid_times:
        if time >= (first or 0) and (policy.end is None or time <= policy.end):
            yield time


def _promised(given: Given) -> int:
    """Return up to where the samples of a finished stream tell that there are no others."""
    last = max((sample.valid_time for sample in samples_of(given.elements)), default=-1)
    change = given.policy.change
    return last + change.period - 1 if isinstance(change, SampleEvery) and last >= 0 else last - 1


def _value(given: list[Sample[Any]], time: TimePoint, approximation: StateApproximation) -> Any:
    before = [sample for sample in given if sample.valid_time <= time]
    after = [sample for sample in given if sample.valid_time > time]
    # Of several samples of one valid time the last one to become available counts.
    last = max(before, key=lambda s: (s.valid_time, s.available_time), default=None)
    if last is None or last.valid_time == time:
        return None if last is None else last.value
    match approximation:
        case StateApproximation.NONE:
            return None
        case StateApproximation.MOST_RECENT:
            return last.value
        case StateApproximation.LINEAR:
            following = min(after, key=lambda s: (s.valid_time, -s.available_time), default=None)
            return None if following is None else interpolate(last, following, time)


def _is_wanted(
    streams: Sequence[list[Sample[Any]]],
    policy: StatePolicy,
    last: tuple[TimePoint, tuple[Any, ...]],
    state: tuple[TimePoint, tuple[Any, ...]],
) -> bool:
    if policy.occasion is Occasion.ANY_CHANGE:
        return not are_equal(last[1], state[1])
    if policy.occasion is Occasion.ALL_UPDATES:
        return all(any(last[0] < s.valid_time <= state[0] for s in given) for given in streams)
    return True


def naive_states(
    streams: Sequence[Given], policy: StatePolicy, until: TimePoint
) -> list[Sample[Any]]:
    """Return the states with their available times, trying every nanosecond up to *until*.

    At each instant everything is looked up again in what has become available by then: the
    categories of all inputs, whether the state is ripe, and its values. Streams must keep their
    policies.
    """
    naive = _Naive(streams, policy)
    for now in range(until + 1):
        while naive.settle_next(TimePoint(now)):
            pass
    return naive.states


class _Naive:
    def __init__(self, streams: Sequence[Given], policy: StatePolicy) -> None:
        self.states: list[Sample[Any]] = []
        self._streams = streams
        self._policy = policy
        self._settled = TimePoint(-1) if policy.start is None else TimePoint(policy.start - 1)
        # What came too late for a time that was settled does not bring that time back.

    def settle_next(self, now: TimePoint) -> bool:
        time = self._next_time(now)
        if time is None or (self._policy.end is not None and time > self._policy.end):
            return False
        if not self._has_come(time, now) or not self._is_ripe(time, now):
            return False
        self._settled = time
        values = tuple(self._value(given, time, now) for given in self._streams)
        if any(value is None for value in values):
            if not self._policy.is_sampled:
                return True
            values = tuple(NO_VALUE if value is None else value for value in values)
        state = (time, values)
        last = (self.states[-1].valid_time, self.states[-1].value) if self.states else None
        known = [_known(given, now) for given in self._streams]
        if last is None or _is_wanted(known, self._policy, last, state):
            self.states.append(Sample(values, time, now))
        return True

    def _next_time(self, now: TimePoint) -> TimePoint | None:
        known = [_known(given, now) for given in self._streams]
        if not self._policy.is_sampled:
            later = [s.valid_time for given in known for s in given]
            return min((time for time in later if time > self._settled), default=None)
        assert self._policy.period is not None
        start = self._policy.start
        if start is None:
            firsts = [min((s.valid_time for s in given), default=None) for given in known]
            if any(first is None for first in firsts):
                return None
            start = max(first for first in firsts if first is not None)
            certain = all(
                _complete(given, now) >= first - 1
                for given, first in zip(self._streams, firsts, strict=True)
                if first is not None
            )
            if not certain:
                return None
        if self._settled < start:
            return start
        return TimePoint(self._settled + self._policy.period)

    def _has_come(self, time: TimePoint, now: TimePoint) -> bool:
        known = [_known(given, now) for given in self._streams]
        if any(s.valid_time >= time for given in known for s in given):
            return True
        past = [
            Given(given.policy, [e for e in given.elements if e.available_time <= now])
            for given in self._streams
        ]
        beats = [e.until for given in past for e in given.elements if isinstance(e, Heartbeat)]
        policy = self._policy
        is_patient = policy.max_delay is None and policy.delay_before_approximation is None
        return time <= now and (
            policy.end is not None
            or all(time <= _promised(given) for given in past)
            or any(time <= until < END_OF_TIME for until in beats)
            or (not is_patient and any(_complete(given, now) < END_OF_TIME for given in past))
        )

    def _is_ripe(self, time: TimePoint, now: TimePoint) -> bool:
        policy = self._policy
        if policy.max_delay is not None and now >= time + policy.max_delay:
            return True
        if policy.settling is Settling.AT_MAX_DELAY:
            return False
        return all(self._is_settled(given, time, now) for given in self._streams)

    def _is_settled(self, given: Given, time: TimePoint, now: TimePoint) -> bool:
        known, complete = _known(given, now), _complete(given, now)
        is_exact = any(s.valid_time == time for s in known)
        patience = self._policy.delay_before_approximation
        needed = time
        if is_exact:
            needed = -1 if self._policy.is_sampled else time - 1
        elif self._policy.is_linear and any(s.valid_time < time for s in known):
            after = [s.valid_time for s in known if s.valid_time > time]
            needed = min(after) - 1 if after else END_OF_TIME
        if complete >= needed:
            return True
        if patience is None or self._value(given, time, now) is None:
            return False
        return now >= _awaited(given, time, now) + patience

    def _value(self, given: Given, time: TimePoint, now: TimePoint) -> Any:
        return _value(_known(given, now), time, self._policy.approximation)


def _known(given: Given, now: TimePoint) -> list[Sample[Any]]:
    return [s for s in samples_of(given.elements) if s.available_time <= now]


def _complete(given: Given, now: TimePoint) -> int:
    policy, change = given.policy, given.policy.change
    valid_times = [s.valid_time for s in _known(given, now)]
    beats = [element for element in given.elements if isinstance(element, Heartbeat)]
    heard = [beat.until for beat in beats if beat.available_time <= now]
    complete = max([policy.first - 1, *heard])
    if isinstance(change, SampleEvery):
        if valid_times:
            # The next sample lies on the grid, beyond the last one and what was heard.
            last = max(valid_times)
            steps = max(0, complete - last) // change.period + 1
            complete = max(complete, last + steps * change.period - 1)
    elif policy.order is Order.STRICT:
        complete = max([complete, *valid_times])
    elif policy.order is Order.MONOTONE or policy.max_delay is None:
        complete = max([complete, *(time - 1 for time in valid_times)])
    if policy.max_delay is not None:
        complete = max(complete, now - policy.max_delay)
    has_ended = policy.end is not None and complete >= policy.end
    return END_OF_TIME if has_ended else complete


def _awaited(given: Given, time: TimePoint, now: TimePoint) -> int:
    known = [s.valid_time for s in _known(given, now)]
    if isinstance(given.policy.change, SampleEvery) and known:
        return time - (time - max(known)) % given.policy.change.period
    return time


_ORDERED = st.sampled_from([Policy(), Policy(order=Order.MONOTONE), Policy(order=Order.STRICT)])


@st.composite
def given_inputs(draw: st.DrawFn, *, is_ended: bool = False, has_repeats: bool = False) -> Given:
    """Draw a stream that keeps a policy: ordered, sampled, or with a maximal delay alone.

    With *is_ended* its last element says that it has ended; with *has_repeats* a stream in
    monotone order may say one valid time several times.
    """
    kind = draw(st.sampled_from(["ordered", "sampled", "delayed", "bounded"]))
    policy = draw(_ORDERED)
    gaps = st.integers(0 if has_repeats and policy.order is not Order.STRICT else 1, 7)
    valid_times = draw(st.lists(gaps, max_size=6).map(_sums))
    max_delay = None
    if kind == "sampled":
        period = Duration(draw(st.integers(2, 7)))
        start = draw(st.integers(0, 7))
        valid_times = [start + n * period for n in range(len(valid_times))]
        max_delay = draw(st.none() | st.just(Duration(12)))
        policy = Policy(change=SampleEvery(period), max_delay=max_delay)
    elif kind == "delayed":
        max_delay = Duration(draw(st.integers(0, 12)))
        policy = Policy(max_delay=max_delay)
        valid_times = sorted(set(valid_times))
    if kind == "bounded" and valid_times:
        end = TimePoint(valid_times[-1] + draw(st.integers(0, 3)))
        policy = Policy(order=Order.STRICT, start=TimePoint(valid_times[0]), end=end)
        valid_times = sorted(set(valid_times))
    values = draw(
        st.lists(st.integers(0, 3), min_size=len(valid_times), max_size=len(valid_times))
    )
    delays = draw(_delays(len(valid_times), 12 if max_delay is None else max_delay))
    samples = _available(valid_times, values, delays, in_order=kind != "delayed")
    if max_delay is not None:
        samples = [sample for sample in samples if sample.delay <= max_delay]
    elements = draw(_with_heartbeats(samples))
    if is_ended:
        elements.append(Heartbeat(END_OF_TIME, TimePoint(_last_time(elements) + 1)))
    return Given(policy, elements)


@st.composite
def delayed_again(draw: st.DrawFn, given: Given) -> Given:
    """Draw the same stream with other delays and other heartbeats; it has ended, too."""
    samples = samples_of(given.elements)
    limit = 12 if given.policy.max_delay is None else given.policy.max_delay
    valid_times = [sample.valid_time for sample in samples]
    values = [sample.value for sample in samples]
    policy = given.policy
    in_order = policy.effective_order is not Order.ANY or policy.max_delay is None
    delays = draw(_delays(len(samples), limit))
    again = _available(valid_times, values, delays, in_order=in_order)
    if any(sample.delay > limit for sample in again):
        again = samples
    elements = draw(_with_heartbeats(again))
    elements.append(Heartbeat(END_OF_TIME, TimePoint(_last_time(elements) + 1)))
    return Given(given.policy, elements)


@st.composite
def state_policies(draw: st.DrawFn, *, is_patient: bool = False) -> StatePolicy:
    """Draw a state policy; with *is_patient* one without delays of its own."""
    approximation = draw(st.sampled_from(StateApproximation))
    occasions = set(Occasion)
    if approximation is StateApproximation.NONE:
        occasions.remove(Occasion.ALL_UPDATES)
    occasion = draw(st.sampled_from(sorted(occasions, key=str)))
    start = draw(st.none() | st.integers(0, 12).map(TimePoint))
    length = draw(st.none() | st.integers(0, 30))
    max_delay = None if is_patient else draw(st.none() | st.integers(0, 20).map(Duration))
    settling, patience = Settling.EARLY, None
    if max_delay is not None and draw(st.integers(0, 3)) == 0:
        settling = Settling.AT_MAX_DELAY
    elif not is_patient and approximation is not StateApproximation.NONE:
        longest = 20 if max_delay is None else max_delay
        patience = draw(st.none() | st.integers(0, longest).map(Duration))
    is_sampled = occasion is Occasion.SAMPLED
    return StatePolicy(
        occasion,
        period=Duration(draw(st.integers(2, 9))) if is_sampled else None,
        start=start,
        end=None if length is None else TimePoint((start or 0) + length),
        max_delay=max_delay,
        approximation=approximation,
        delay_before_approximation=patience,
        settling=settling,
    )


def _sums(gaps: list[int]) -> list[int]:
    return [sum(gaps[: at + 1]) for at in range(len(gaps))]


def _delays(size: int, longest: int) -> st.SearchStrategy[list[int]]:
    return st.lists(st.integers(0, longest), min_size=size, max_size=size)


def _available(
    valid_times: Sequence[int], values: Sequence[Any], delays: Sequence[int], *, in_order: bool
) -> list[Sample[Any]]:
    """Return samples with unique available times, in the given order or as they arrive."""
    samples: list[Sample[Any]] = []
    taken = -1
    rows = list(zip(valid_times, values, delays, strict=True))
    if not in_order:
        rows.sort(key=lambda row: row[0] + row[2])
    for valid_time, value, delay in rows:
        taken = max(taken + 1, valid_time + delay)
        samples.append(Sample(value, TimePoint(valid_time), TimePoint(taken)))
    return samples


@st.composite
def _with_heartbeats(draw: st.DrawFn, samples: list[Sample[Any]]) -> list[Element]:
    """Put true heartbeats after some of the samples."""
    elements: list[Element] = []
    for at, sample in enumerate(samples):
        elements.append(sample)
        following = samples[at + 1 :]
        if following and draw(st.integers(0, 3)) == 0:
            until = min(later.valid_time for later in following) - 1 - draw(st.integers(0, 2))
            latest = following[0].available_time - 1
            beat = min(sample.available_time + draw(st.integers(0, 3)), latest)
            if until >= 0 and beat >= sample.available_time:
                elements.append(Heartbeat(TimePoint(until), TimePoint(beat)))
    return elements


def _last_time(elements: Sequence[Element]) -> int:
    return max((element.available_time for element in elements), default=-1)

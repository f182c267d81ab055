"""Adapters make streams that keep the policy, or say why they cannot."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.adapter import VariesPeriod, adapter_for
from dyknow.streams.approximation import extend
from dyknow.streams.conformance import is_substream, satisfies, term_violations
from dyknow.streams.ordering import Filter
from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Constraint,
    Order,
    Policy,
    SampleEvery,
)
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.stream import is_fluent_stream, most_recent_at
from dyknow.time import TimePoint
from tests.support.interpretations import content, interpretations
from tests.support.policies import (
    adapted,
    adapted_elements,
    approximating_policies,
    heartbeats,
    lengthened,
    policies,
    streams,
)
from tests.support.streams import ms, text

END = ms(400)
"""After the last sample and every deadline of the streams and policies drawn."""


def test_a_policy_that_restricts_nothing_needs_no_adapter():
    """A stream with an empty policy is the generator's own."""
    assert adapter_for(Policy()) is None


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.data())
def test_what_comes_out_is_what_the_term_allows_or_the_violation_is_published(data):
    """Only places of a sampled stream can be missing, and each of them is published."""
    given_stream, policy = data.draw(streams()), data.draw(policies())
    beats, periods = data.draw(heartbeats(given_stream)), data.draw(lengthened(policy))

    made, published = adapted([*given_stream, *beats], policy, END, periods)

    assert is_fluent_stream(made)
    assert is_substream(made, given_stream)
    reported = {id(violation.sample) for violation in published}
    for violation in term_violations(made, given_stream, policy, END):
        if violation.constraint is Constraint.OMISSION:
            assert periods or id(violation.sample) in reported
            continue
        assert violation.constraint is Constraint.CHANGE
        assert policy.period is not None
        before = max(s.valid_time for s in made if s.valid_time < violation.valid_time)
        assert any(before < p.valid_time < violation.valid_time for p in published)


@settings(derandomize=True, deadline=None, max_examples=120)
@given(st.data())
def test_with_approximation_what_comes_out_is_what_the_term_allows(data):
    """The grid is filled from the first value on, and nothing needs an excuse."""
    given_stream, policy = data.draw(streams()), data.draw(approximating_policies())
    beats, periods = data.draw(heartbeats(given_stream)), data.draw(lengthened(policy))

    made, published = adapted([*given_stream, *beats], policy, END, periods)

    assert is_fluent_stream(made)
    assert is_substream(made, extend(given_stream, policy, END))
    broken = term_violations(made, given_stream, policy, END)
    assert not broken or (periods and {b.constraint for b in broken} == {Constraint.OMISSION})
    missing = {p.constraint for p in published if p.sample is None}
    assert missing <= {Constraint.CHANGE}


_FEW = st.integers(0, 4).map(TimePoint)
_SMALL_STREAMS = st.lists(
    st.tuples(st.integers(0, 5), st.integers(0, 4), st.sampled_from("ab")),
    max_size=3,
    unique_by=lambda one: one[0],
).map(
    lambda drawn: [
        Sample(value, TimePoint(min(valid, now)), TimePoint(now))
        for now, valid, value in sorted(drawn)
    ]
)


@st.composite
def _small_policies(draw):
    period = draw(st.integers(1, 3))
    sampled = SampleEvery(period, draw(st.integers(0, period - 1)))
    if draw(st.booleans()):
        return Policy(
            approximation=Approximation.MOST_RECENT,
            change=SampleEvery(period),
            max_delay=draw(st.integers(0, 2)),
            start=draw(_FEW),
            end=TimePoint(4),
        )
    return Policy(
        change=draw(st.sampled_from([Policy().change, ANY_CHANGE, sampled])),
        max_delay=draw(st.none() | st.integers(0, 4)),
        start=draw(st.none() | _FEW),
        order=draw(st.sampled_from(Order)),
    )


@settings(derandomize=True, deadline=None, max_examples=120)
@given(_SMALL_STREAMS, _small_policies())
def test_what_comes_out_is_one_of_the_streams_of_the_definition(given_stream, policy):
    """By trying everything: the stream made is among the interpretations of its term."""
    made, published = adapted(given_stream, policy, TimePoint(9))

    whole = extend(given_stream, policy, TimePoint(9))
    if policy.period is None or not published:
        assert content(made) in interpretations(whole, policy, 9)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.data())
def test_a_sample_the_policy_asks_for_is_handed_on_or_carried_by_a_violation(data):
    """Nothing is dropped unseen: neither late samples nor repetitions of a place on the grid."""
    given_stream = data.draw(streams())
    policy = data.draw(policies() | approximating_policies())
    made, published = adapted([*given_stream, *data.draw(heartbeats(given_stream))], policy, END)

    reported = {id(violation.sample) for violation in published}
    handed_on = [(sample.valid_time, sample.value) for sample in made]
    for sample in given_stream:
        if id(sample) in reported or not _is_asked_for(sample, given_stream, policy):
            continue
        assert (sample.valid_time, sample.value) in handed_on
        if policy.change is not ANY_CHANGE:
            handed_on.remove((sample.valid_time, sample.value))


def _is_asked_for(sample, given_stream, policy):
    if not policy.covers(sample.valid_time):
        return False
    match policy.change:
        case SampleEvery(period, deviation=0):
            firsts = (s.valid_time for s in given_stream if _could_be_first(s, policy))
            is_approximated = policy.approximation is Approximation.MOST_RECENT
            first = policy.first if is_approximated else next(firsts, sample.valid_time)
            return (sample.valid_time - first) % period == 0
        case SampleEvery():
            return False
        case _:
            return True


def _could_be_first(sample, policy):
    return policy.covers(sample.valid_time) and policy.allows_delay(sample.delay)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), approximating_policies())
def test_with_approximation_the_values_are_those_of_the_definition(given_stream, policy):
    """The grid is filled as definition 4.5.10 says, at the latest when the delay has passed."""
    until = END if policy.end is not None else ms(300)
    made, _ = adapted(given_stream, policy, until)

    delay = policy.max_delay or 0
    times = [sample.valid_time for sample in made]
    expected = range(policy.first, min(until, policy.end or until) + 1, policy.period or 1)
    assert times == [time for time in expected if time in times]
    assert satisfies(made, policy)
    for sample in made:
        query = TimePoint(sample.valid_time + delay)
        best = most_recent_at(given_stream, sample.valid_time, query)
        firsts = [s for s in given_stream if s.valid_time == sample.valid_time]
        exact = [s for s in firsts if s.available_time <= query]
        assert sample.value == (exact[0] if exact else best).value


@settings(derandomize=True, deadline=None, max_examples=80)
@given(streams(), policies() | approximating_policies(), st.integers(1, 50))
def test_the_output_does_not_depend_on_how_often_time_is_advanced(given_stream, policy, tick):
    """Asking an adapter more often than at its deadlines changes nothing."""
    made, _ = adapted(given_stream, policy, ms(150))

    adapter = adapter_for(policy) or Filter(policy)
    often = []
    arrivals = {sample.available_time: sample for sample in given_stream}
    for now in sorted({*arrivals, *range(0, ms(150) + 1, ms(1))}):
        if now > ms(150):
            break
        if now in arrivals:
            often.extend(adapter.push(arrivals[now]))
        if now % tick == 0 or adapter.due() is not None:
            often.extend(adapter.advance(TimePoint(now)))
    assert text(often) == text(made)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.data())
def test_the_heartbeats_that_come_out_are_true(data):
    """What an adapter promises about its stream holds, whatever comes and whatever the period."""
    given_stream = data.draw(streams())
    policy = data.draw(policies() | approximating_policies())
    beats, periods = data.draw(heartbeats(given_stream)), data.draw(lengthened(policy))

    made, _ = adapted_elements([*given_stream, *beats], policy, END, periods)

    promised = now = -1
    for element in made:
        assert element.available_time >= now
        now = element.available_time
        if isinstance(element, Heartbeat):
            promised = max(promised, element.until)
        else:
            assert element.valid_time > promised
    assert sum(isinstance(element, Heartbeat) for element in made) == len(beats)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.data())
def test_heartbeats_change_when_samples_come_and_not_which(data):
    """A stream with heartbeats is the stream without them, only earlier."""
    given_stream = data.draw(streams())
    policy = data.draw(
        policies().filter(lambda p: not getattr(p.change, "deviation", 0))
        | approximating_policies().filter(lambda p: p.end is not None)
    )

    made, _ = adapted([*given_stream, *data.draw(heartbeats(given_stream))], policy, END)

    plain, _ = adapted(given_stream, policy, END)
    assert [(s.valid_time, s.value) for s in made] == [(s.valid_time, s.value) for s in plain]
    assert all(
        one.available_time <= other.available_time for one, other in zip(made, plain, strict=True)
    )


def _approximating(*, period, delay):
    return Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(period)),
        max_delay=ms(delay),
        start=ms(0),
    )


@pytest.mark.parametrize("now", [0, 999, 1000, 1001])
def test_a_late_subscriber_is_not_sent_what_it_missed(now):
    """An adapter that begins in the middle begins with the first grid point it can meet."""
    policy = _approximating(period=100, delay=20)

    adapter = adapter_for(policy, ms(now))

    assert adapter is not None
    assert adapter.due() == ms(max(20, -(-(now - 20) // 100) * 100 + 20))


def test_only_sampled_streams_can_be_given_another_period():
    """Whoever governs the load asks an adapter whether its period varies."""
    assert isinstance(adapter_for(_approximating(period=100, delay=20)), VariesPeriod)
    assert isinstance(adapter_for(Policy(change=SampleEvery(ms(100)))), VariesPeriod)
    assert not isinstance(adapter_for(Policy(max_delay=ms(100))), VariesPeriod)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), policies() | approximating_policies())
def test_no_sample_brings_the_deadline_nearer(given_stream, policy):
    """Whoever has planned to come back at a deadline need not look again for each sample."""
    adapter = adapter_for(policy) or Filter(policy)
    for sample in given_stream:
        adapter.advance(TimePoint(sample.available_time - 1))
        before = adapter.due()
        adapter.push(sample)
        after = adapter.due()
        assert before is None or after is None or before <= after

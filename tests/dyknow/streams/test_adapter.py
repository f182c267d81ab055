"""Adapters make streams that keep the policy, or say why they cannot."""

from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.adapter import adapter_for
from dyknow.streams.conformance import extend, is_substream, keeps, violations
from dyknow.streams.policy import Approximation, Constraint, Policy, SampleEvery
from dyknow.streams.stream import is_fluent_stream, most_recent_at
from tests.support.policies import adapted, approximating_policies, policies, streams
from tests.support.streams import ms, text

END = ms(400)
"""After the last sample and every deadline of the streams and policies drawn."""


def test_a_policy_that_restricts_nothing_needs_no_adapter():
    """A stream with an empty policy is the generator's own."""
    assert adapter_for(Policy()) is None


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), policies())
def test_what_comes_out_keeps_the_policy_or_the_violation_is_published(given_stream, policy):
    """Only the sample period can be broken, by gaps, and each gap is published."""
    made, published = adapted(given_stream, policy, END)

    broken = violations(made, policy)
    assert {violation.constraint for violation in broken} <= {Constraint.CHANGE}
    for violation in broken:
        last = max(s.valid_time for s in made if s.valid_time < violation.valid_time)
        assert policy.period is not None
        assert any(p.valid_time == last + policy.period for p in published)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), policies())
def test_what_comes_out_is_a_substream_of_what_goes_in(given_stream, policy):
    """An adapter that does not approximate delays and leaves out; it makes up nothing."""
    made, _ = adapted(given_stream, policy, END)

    assert is_fluent_stream(made)
    assert is_substream(made, given_stream)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(streams(size=6), policies().filter(lambda policy: policy.period is None))
def test_no_sample_could_be_added_to_what_comes_out(given_stream, policy):
    """By brute force over all selections: none that keeps the policy contains the one made."""
    made, _ = adapted(given_stream, policy, END)

    for size in range(len(made) + 1, len(given_stream) + 1):
        for selection in map(list, combinations(given_stream, size)):
            contains = all(any(sample is other for other in selection) for sample in made)
            assert not (contains and keeps(selection, policy))


@settings(derandomize=True, deadline=None, max_examples=80)
@given(streams(), policies())
def test_a_sample_the_policy_wants_is_handed_on_or_reported(given_stream, policy):
    """Of a stream that is not sampled, nothing within the duration is lost unseen."""
    if policy.period is not None:
        return
    made, published = adapted(given_stream, policy, END)

    wanted = [sample for sample in given_stream if policy.covers(sample.valid_time)]
    seen = {id(sample) for sample in made}
    reported = {violation.noticed_at for violation in published}
    lost = [s for s in wanted if id(s) not in seen and s.available_time not in reported]
    assert all(
        any(o.valid_time == s.valid_time and o.value == s.value for o in made) for s in lost
    )


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), approximating_policies())
def test_with_approximation_the_values_are_those_of_the_definition(given_stream, policy):
    """The grid is filled as definition 4.5.10 says, at the latest when the delay has passed."""
    until = END if policy.end is not None else ms(300)
    made, published = adapted(given_stream, policy, until)

    expected = extend(given_stream, policy, until)
    delay = policy.max_delay or 0
    expected = [sample for sample in expected if sample.available_time <= until]
    late = [sample for sample in made if sample.valid_time + delay > until]
    on_time = [sample for sample in made if sample.valid_time + delay <= until]
    assert keeps(made, policy)
    assert is_fluent_stream(made)
    assert [s.valid_time for s in on_time] == [s.valid_time for s in expected]
    assert all(any(g.valid_time == s.valid_time for g in given_stream) for s in late)
    for sample in on_time:
        best = most_recent_at(given_stream, sample.valid_time, sample.available_time)
        assert sample.value == best.value
    missing = {violation.constraint for violation in published if violation.sample is None}
    assert missing <= {Constraint.CHANGE}


@settings(derandomize=True, deadline=None, max_examples=80)
@given(streams(), policies() | approximating_policies(), st.integers(1, 50))
def test_the_output_does_not_depend_on_how_often_time_is_advanced(given_stream, policy, tick):
    """Asking an adapter more often than at its deadlines changes nothing."""
    made, _ = adapted(given_stream, policy, ms(150))

    adapter = adapter_for(policy)
    if adapter is None:
        return
    often = []
    arrivals = {sample.available_time: sample for sample in given_stream}
    for now in sorted({*arrivals, *range(0, ms(150) + 1, ms(1))}):
        if now > ms(150):
            break
        if now in arrivals:
            often.extend(adapter.push(arrivals[now]))
        if now % tick == 0 or adapter.due() is not None:
            often.extend(adapter.advance(ms(now / ms(1))))
    assert text(often) == text(made)


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

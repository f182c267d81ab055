"""Policies that a process cannot serve are refused with a reason."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.conformance import satisfies
from dyknow.streams.policy import ANY_CHANGE, Approximation, Order, Policy, SampleEvery
from dyknow.streams.refusal import refusal
from dyknow.streams.sample import Sample
from tests.support.policies import adapted, approximating_policies, samplings
from tests.support.streams import ms


def _every(period, deviation=0, longest=None):
    return Policy(
        change=SampleEvery(ms(period), ms(deviation), None if longest is None else ms(longest))
    )


def _recent(start):
    return Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(70)),
        max_delay=ms(20),
        start=ms(start),
    )


@pytest.mark.parametrize(
    ("offered", "wanted", "reason"),
    [
        (
            _every(100),
            _every(250),
            "the process gives a sample every 100, a sample every 250 cannot be picked out of it",
        ),
        (
            _every(100),
            _every(50),
            "the process gives a sample every 100, a sample every 50 cannot be picked out of it",
        ),
        (
            _every(100, 10),
            _every(100),
            (
                "the process gives a sample every 100 deviation 10, "
                "a sample every 100 cannot be picked out of it"
            ),
        ),
        (
            _every(100, longest=300),
            _every(200),
            "the process gives a sample every 300, a sample every 200 cannot be picked out of it",
        ),
        (
            Policy(max_delay=ms(200)),
            Policy(max_delay=ms(100)),
            "the process needs a delay of up to 200, the policy allows at most 100",
        ),
        (
            Policy(start=ms(500)),
            Policy(end=ms(400)),
            "the process gives nothing before 500, the policy ends at 400",
        ),
        (
            Policy(end=ms(500)),
            Policy(start=ms(501)),
            "the process gives nothing after 500, the policy begins at 501",
        ),
        (
            Policy(start=ms(500)),
            _recent(400),
            "the process gives nothing before 500 to approximate the value at 400",
        ),
        (
            Policy(order=Order.MONOTONE),
            Policy(order=Order.STRICT),
            "the process may give several samples of one valid time, the policy allows one",
        ),
    ],
)
def test_a_policy_that_cannot_be_kept_is_refused(offered, wanted, reason):
    """The reason says what the process promises and what the policy wants."""
    assert refusal(offered, wanted) == reason


@pytest.mark.parametrize(
    ("offered", "wanted"),
    [
        (Policy(), _every(70)),
        (_every(100), _every(300)),
        (_every(100), _every(250, 50)),
        (_every(100, 10), _every(200, 20)),
        (_every(100, 10), _every(500, 60)),
        (_every(100, longest=300), _every(600)),
        (_every(100, longest=300), _every(100, longest=300)),
        (_every(100), _recent(0)),
        (Policy(max_delay=ms(200)), _recent(0)),
        (Policy(end=ms(200)), _recent(300)),
        (Policy(max_delay=ms(100)), Policy(max_delay=ms(100))),
        (_every(100), Policy(order=Order.STRICT, change=ANY_CHANGE)),
        (Policy(order=Order.MONOTONE), _every(100)),
    ],
)
def test_a_policy_that_can_be_kept_or_is_not_promised_against_is_served(offered, wanted):
    """What a process does not promise is not held against a policy."""
    assert refusal(offered, wanted) is None


@st.composite
def _kept(draw, offered):
    """Draw a stream that keeps the promise *offered*, without end as far as can be seen."""
    assert isinstance(offered.change, SampleEvery)
    period = draw(st.sampled_from(list(offered.change.periods())))
    deviation = offered.change.deviation
    valid, now, samples = int(offered.first), -1, []
    for value in range(12):
        delay = draw(st.integers(0, 3)) * (offered.max_delay or 0) // 3
        now = max(now + 1, valid + delay)
        samples.append(Sample(value, ms(0) + valid, ms(0) + now))
        valid += period + draw(st.sampled_from([-1, 0, 1])) * deviation
    return samples


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.data())
def test_what_is_not_refused_is_kept(data):
    """Of a process that keeps its promise, an adapter makes a stream without violations."""
    promises = st.builds(Policy, change=samplings(), max_delay=st.sampled_from([None, 0, ms(30)]))
    orders = st.sampled_from(Order)
    offered = data.draw(promises)
    wanted = data.draw(promises | st.builds(Policy, order=orders) | approximating_policies())
    is_in_time = offered.max_delay is not None or wanted.max_delay is None
    if refusal(offered, wanted) is not None or not is_in_time:
        return
    given_stream = data.draw(_kept(offered))

    made, published = adapted(given_stream, wanted, given_stream[-1].available_time)

    assert satisfies(made, wanted)
    is_approximated = wanted.approximation is Approximation.MOST_RECENT
    assert is_approximated or published == []

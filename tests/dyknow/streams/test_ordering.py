"""Streams that are not sampled, as text."""

import pytest

from dyknow.streams.policy import ANY_CHANGE, Order, Policy
from tests.support.policies import adapted
from tests.support.streams import ms, stream, text


@pytest.mark.parametrize(
    ("policy", "expected", "n_published"),
    [
        (Policy(change=ANY_CHANGE), "0:a 20:b 10:c@25 20:d@30 50:e@90", 0),
        (Policy(order=Order.MONOTONE), "0:a 20:b 20:b@21 20:d@30 50:e@90", 2),
        (Policy(order=Order.STRICT), "0:a 20:b 50:e@90", 4),
        (Policy(max_delay=ms(15)), "0:a 20:b 20:b@21 10:c@25 20:d@30", 2),
        (Policy(start=ms(15), end=ms(30)), "20:b 20:b@21 20:d@30", 0),
    ],
)
def test_a_filter_hands_on_what_the_policy_allows(policy, expected, n_published):
    """What comes late or out of order is published, what is not asked for is left out."""
    samples = stream("0:a 20:b 20:b@21 10:c@25 20:d@30 10:c@40 50:e@90")
    if policy.change is ANY_CHANGE:
        samples = stream("0:a 20:b 20:b@21 10:c@25 20:d@30 50:e@90 50:e@91")

    made, published = adapted(samples, policy, ms(1000))

    assert text(made) == expected
    assert len(published) == n_published


def test_the_samples_handed_on_are_those_that_came():
    """A filter makes no copies."""
    samples = stream("0:a 5:b")

    made, _ = adapted(samples, Policy(order=Order.STRICT), ms(10))

    assert all(one is other for one, other in zip(made, samples, strict=True))


def test_a_violation_says_what_came_before():
    """The reason names the valid time that was not followed."""
    _, (violation,) = adapted(stream("5:a 3:b@6"), Policy(order=Order.MONOTONE), ms(10))

    assert violation.reason == "the valid time does not follow 5 in monotone order"

"""Policies as values."""

import pytest

from dyknow.streams.policy import Approximation, Order, Policy, SampleEvery
from dyknow.time import Duration, TimePoint


def test_an_empty_policy_restricts_nothing():
    """What a policy leaves out is unrestricted."""
    policy = Policy()

    assert policy.covers(TimePoint(0))
    assert policy.covers(TimePoint(10**18))
    assert policy.allows_delay(Duration(10**18))
    assert policy.effective_order is Order.ANY


def test_a_sampled_stream_is_strictly_ordered():
    """A sample period implies strict order (thesis, section 4.4.5)."""
    assert Policy(change=SampleEvery(Duration(5))).effective_order is Order.STRICT


def test_to_alone_begins_at_0():
    """Without `from`, the duration begins with the first time-point."""
    policy = Policy(end=TimePoint(10))

    assert policy.covers(TimePoint(0))
    assert policy.covers(TimePoint(10))
    assert not policy.covers(TimePoint(11))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"change": SampleEvery(Duration(0))}, "the sample period must be positive"),
        ({"max_delay": Duration(-1)}, "the maximal delay must not be negative"),
        ({"start": TimePoint(-1)}, "no time-point lies before 0"),
        (
            {"start": TimePoint(2_000_000), "end": TimePoint(1_000_000)},
            "the stream would end at 1 before it begins at 2",
        ),
        (
            {"approximation": Approximation.MOST_RECENT, "start": TimePoint(0)},
            "'use most recent' needs 'sample every' and a finite 'max delay'",
        ),
    ],
)
def test_a_policy_that_no_stream_can_keep_is_refused(arguments, message):
    """Contradictions are found when the policy is made, with a message that says what is wrong."""
    with pytest.raises(ValueError, match=r".") as caught:
        Policy(**arguments)

    assert str(caught.value) == message

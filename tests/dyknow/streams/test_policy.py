"""Policies as values."""

import pytest

from dyknow.streams.policy import (
    Approximation,
    Constraint,
    Order,
    Policy,
    SampleEvery,
    Violation,
)
from dyknow.streams.sample import Sample
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
        (
            {"change": SampleEvery(Duration(2_000_000), Duration(2_000_000))},
            "the deviation must be at least 0 and less than the period of 2, found 2",
        ),
        (
            {"change": SampleEvery(Duration(2_000_000), longest=Duration(3_000_000))},
            "the longest period must be a multiple of the period of 2, found 3",
        ),
        (
            {"change": SampleEvery(Duration(2_000_000), longest=Duration(0))},
            "the longest period must be a multiple of the period of 2, found 0",
        ),
        (
            {
                "approximation": Approximation.MOST_RECENT,
                "change": SampleEvery(Duration(2), Duration(1)),
                "max_delay": Duration(0),
                "start": TimePoint(0),
            },
            "'use most recent' puts samples on the grid and allows no deviation",
        ),
    ],
)
def test_a_policy_that_no_stream_can_keep_is_refused(arguments, message):
    """Contradictions are found when the policy is made, with a message that says what is wrong."""
    with pytest.raises(ValueError, match=r".") as caught:
        Policy(**arguments)

    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("change", "steps"),
    [
        (SampleEvery(Duration(5)), {5}),
        (SampleEvery(Duration(5), Duration(2)), {3, 4, 5, 6, 7}),
        (SampleEvery(Duration(5), longest=Duration(15)), {5, 10, 15}),
        (SampleEvery(Duration(5), Duration(1), Duration(10)), {4, 5, 6, 9, 10, 11}),
        (SampleEvery(Duration(3), Duration(2), Duration(6)), {1, 2, 3, 4, 5, 6, 7, 8}),
    ],
)
def test_a_sample_period_allows_steps(change, steps):
    """Any multiple of the period up to the longest, give or take the deviation."""
    assert {step for step in range(-20, 40) if change.allows_step(step)} == steps
    assert list(change.periods())[-1] == change.longest_period


def test_violations_are_alike_if_they_say_the_same():
    """The sample that is carried does not take part in the comparison; it may be a table."""
    facts = (Constraint.DELAY, TimePoint(1), TimePoint(5), "too late")
    one = Violation(*facts, Sample("a", TimePoint(1), TimePoint(5)))

    assert one == Violation(*facts)
    assert len({one, Violation(*facts)}) == 1
    assert one.definition == "4.5.11"

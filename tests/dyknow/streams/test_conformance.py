"""What policies mean: the examples of Heintz (2009), sections 4.5.1 and 4.5.4."""

import pytest

from dyknow.streams.conformance import extend, is_substream, keeps, violations
from dyknow.streams.policy import (
    ANY_CHANGE,
    Approximation,
    Constraint,
    Order,
    Policy,
    SampleEvery,
)
from tests.support.streams import ms, stream, text

POSITIONS = stream("200:p1@250 300:p2@325 400:p3@430 500:p4@505")
"""The stream f1 of example 4.5.1."""


def test_example_4_5_4_a_substream_may_be_later_and_have_less():
    """Both samples of f5 are in f1 with an earlier available time."""
    assert is_substream(stream("300:p2@345 400:p3@460"), POSITIONS)
    assert not is_substream(stream("300:p2@300"), POSITIONS)
    assert not is_substream(stream("300:p1@345"), POSITIONS)


def test_example_4_5_5_a_policy_is_kept_or_not():
    """The positions are 100 apart, and the first one is 50 late."""
    assert keeps(POSITIONS, Policy(change=SampleEvery(ms(100))))
    assert not keeps(POSITIONS, Policy(max_delay=ms(40)))


def test_example_4_5_6_a_stream_of_every_second_position():
    """Every second position, a little later, is a substream and keeps the policy."""
    f = stream("200:p1@280 400:p3@480")

    assert is_substream(f, POSITIONS)
    assert keeps(f, Policy(change=SampleEvery(ms(200))))


@pytest.mark.parametrize(
    ("samples", "policy", "constraint"),
    [
        ("0:a 100:b 250:c", Policy(change=SampleEvery(ms(100))), Constraint.CHANGE),
        ("0:a 0:a@1", Policy(change=ANY_CHANGE), Constraint.CHANGE),
        ("0:a 5:b@20", Policy(max_delay=ms(10)), Constraint.DELAY),
        ("0:a 20:b", Policy(start=ms(5)), Constraint.DURATION),
        ("0:a 20:b", Policy(end=ms(5)), Constraint.DURATION),
        ("5:a 3:b@6", Policy(order=Order.MONOTONE), Constraint.ORDER),
        ("5:a 5:b@6", Policy(order=Order.STRICT), Constraint.ORDER),
    ],
)
def test_every_constraint_can_be_violated(samples, policy, constraint):
    """A violation names the kind of constraint that is broken."""
    assert [violation.constraint for violation in violations(stream(samples), policy)] == [
        constraint
    ]


@pytest.mark.parametrize(
    ("samples", "policy"),
    [
        ("0:a 0:b@1 1:b", Policy(change=ANY_CHANGE)),
        ("0:a 10:b@20", Policy(max_delay=ms(10))),
        ("5:a 10:b", Policy(start=ms(5), end=ms(10))),
        ("5:a 5:b@6", Policy(order=Order.MONOTONE)),
        ("5:a 3:b@6 3:b@7", Policy()),
    ],
)
def test_limits_belong_to_what_is_allowed(samples, policy):
    """A sample exactly at a limit keeps the policy."""
    assert keeps(stream(samples), policy)


def test_a_violation_says_where_and_why():
    """Place and reason are for the person who must find the fault."""
    (violation,) = violations(stream("0:a 100:b 250:c@260"), Policy(change=SampleEvery(ms(100))))

    assert violation.valid_time == ms(250)
    assert violation.noticed_at == ms(260)
    assert violation.reason == "expected the sample with valid time 200"


def test_extending_puts_the_most_recent_value_on_each_grid_point():
    """Definition 4.5.10: values at the grid, available at the end of the maximal delay."""
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(100)),
        max_delay=ms(80),
        start=ms(1050),
        end=ms(1250),
    )
    speed = stream("1000:s1@1010 1100:s2@1110 1200:s3@1280 1300:s4@1320")

    extended = extend(speed, policy, ms(5000))

    assert text(extended) == "1050:s1@1130 1150:s2@1230 1250:s3@1330"
    assert text(extend(speed, Policy(), ms(0))) == text(speed)

"""From constraints as written to policies as values."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.kpl.parser import parse_policy, parse_specification
from dyknow.kpl.policies import policy_from_constraints, text_from_policy
from dyknow.streams.policy import (
    ANY_CHANGE,
    ANY_UPDATE,
    Approximation,
    Order,
    Policy,
    SampleEvery,
)
from dyknow.time import Duration
from tests.support.streams import ms


def _policy(text):
    (declaration,) = parse_specification(f"stream s = a {text}").declarations
    return policy_from_constraints(declaration.stream.constraints)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", Policy()),
        ("with any update, any order, no approximation, max delay oo", Policy()),
        ("with any change, monotone order", Policy(change=ANY_CHANGE, order=Order.MONOTONE)),
        ("with strict order, max delay 1 s", Policy(order=Order.STRICT, max_delay=ms(1000))),
        ("with from 3", Policy(start=ms(3))),
        ("with to 5", Policy(end=ms(5))),
        ("with to oo", Policy()),
        ("with from 3 to 5", Policy(start=ms(3), end=ms(5))),
        (
            "with sample every 10, use most recent, max delay 0, from 0 to oo",
            Policy(
                approximation=Approximation.MOST_RECENT,
                change=SampleEvery(ms(10)),
                max_delay=ms(0),
                start=ms(0),
            ),
        ),
    ],
)
def test_each_constraint_says_its_part_of_the_policy(text, expected):
    """What is left out has the defaults of the thesis."""
    assert _policy(text) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("with any change, sample every 3", "two change constraints, 'any change' and 'sample"),
        ("with from 1, to 3", "two duration constraints, 'from 1' and 'to 3'"),
        ("with sample every 0", "the sample period must be positive"),
    ],
)
def test_constraints_that_contradict_each_other_are_refused(text, message):
    """At most one constraint of each kind, and all of them possible together."""
    with pytest.raises(ValueError, match=message):
        _policy(text)


PERIODS = st.builds(
    lambda period, times, deviation: SampleEvery(
        Duration(period), Duration(deviation % period), Duration(period * times) if times else None
    ),
    st.integers(1, 10**10),
    st.integers(0, 5),
    st.integers(0, 10**9),
)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    change=st.sampled_from([ANY_UPDATE, ANY_CHANGE]) | PERIODS,
    order=st.sampled_from(Order),
    max_delay=st.none() | st.integers(0, 10**12),
    start=st.none() | st.integers(0, 10**12),
    length=st.none() | st.integers(0, 10**12),
    approximation=st.sampled_from(Approximation),
)
def test_a_policy_has_a_text_that_means_it(change, order, max_delay, start, length, approximation):
    """Writing and reading a policy gives the same policy."""
    end = None if length is None else (start or 0) + length
    try:
        policy = Policy(approximation, change, max_delay, start, end, order)
    except ValueError:
        policy = Policy(Approximation.NONE, change, max_delay, start, end, order)

    assert policy_from_constraints(parse_policy(text_from_policy(policy))) == policy

"""From constraints as written to policies as values."""

import pytest

from dyknow.kpl.parser import parse_specification
from dyknow.kpl.policies import policy_from_constraints
from dyknow.streams.policy import ANY_CHANGE, Approximation, Order, Policy, SampleEvery
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

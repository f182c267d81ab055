"""What has been left out of a stream."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.maximality import omissions
from dyknow.streams.policy import ANY_CHANGE, ANY_UPDATE, Order, Policy, SampleEvery
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from tests.support.interpretations import satisfying
from tests.support.streams import ms, stream, text

END = TimePoint(10**18)


@pytest.mark.parametrize(
    ("part", "whole", "policy", "expected"),
    [
        ("0:a 20:c", "0:a 10:b 20:c", Policy(), "10:b"),
        ("0:a 20:c", "0:a 10:b 20:c", Policy(order=Order.STRICT), "10:b"),
        ("0:a 20:c", "0:a 10:b@21 20:c", Policy(order=Order.STRICT), ""),
        ("0:a 20:c", "0:a 10:b@21 20:c", Policy(), "10:b@21"),
        ("0:a 20:c@30", "0:a 10:b@21 20:c", Policy(order=Order.STRICT), "10:b@21"),
        ("0:a 20:c@30", "0:a 10:b@21 20:c", Policy(max_delay=ms(10), order=Order.STRICT), ""),
        ("0:a", "0:a 0:a@5", Policy(), "0:a@5"),
        ("0:a", "0:a 0:a@5", Policy(change=ANY_CHANGE), ""),
        ("0:a 0:b@9", "0:a 0:a@5 0:b@9", Policy(change=ANY_CHANGE), ""),
        ("0:a 0:b@9", "0:a 0:b@5 0:a@7 0:b@9", Policy(change=ANY_CHANGE), "0:b@5 0:a@7"),
        ("0:a 100:b", "0:a 50:x 100:b", Policy(change=SampleEvery(ms(100))), ""),
        ("0:a 100:b", "0:a 100:b 200:c", Policy(change=SampleEvery(ms(100))), "200:c"),
        ("100:b", "0:a 100:b", Policy(change=SampleEvery(ms(100))), "0:a"),
        ("0:a 140:c", "0:a 70:b 140:c", Policy(change=SampleEvery(ms(100), ms(40))), "70:b"),
        ("0:a 140:c", "0:a 50:b 140:c", Policy(change=SampleEvery(ms(100), ms(40))), ""),
        ("", "50:b", Policy(change=SampleEvery(ms(100))), "50:b"),
        ("0:a 200:c", "0:a 100:b 200:c", Policy(change=SampleEvery(ms(100), longest=ms(200))), ""),
        ("0:a", "0:a 100:b 200:c", Policy(change=SampleEvery(ms(100), longest=ms(200))), "200:c"),
    ],
)
def test_what_could_be_added_is_left_out(part, whole, policy, expected):
    """A sample is left out if the stream would keep its policy with it."""
    assert text(omissions(stream(part), stream(whole), policy, ms(1000))) == expected


@st.composite
def _cases(draw):
    times = draw(st.lists(st.integers(0, 5), max_size=3, unique=True).map(sorted))
    whole = [
        Sample(draw(st.sampled_from("ab")), TimePoint(draw(st.integers(0, min(4, now)))), now)
        for now in map(TimePoint, times)
    ]
    period = draw(st.integers(1, 3))
    sampled = SampleEvery(period, draw(st.integers(0, period - 1)))
    start = draw(st.none() | st.integers(0, 4))
    policy = Policy(
        change=draw(st.sampled_from([ANY_UPDATE, ANY_CHANGE, sampled])),
        max_delay=draw(st.none() | st.integers(0, 4)),
        start=start,
        end=draw(st.none() | st.integers(0, 3).map(lambda length: (start or 0) + length)),
        order=draw(st.sampled_from(Order)),
    )
    return whole, policy


@settings(derandomize=True, deadline=None, max_examples=150)
@given(_cases(), st.randoms(use_true_random=False))
def test_what_is_maximal_is_so_by_trying_everything(case, random):
    """A stream has no omissions if and only if no satisfying stream contains it."""
    whole, policy = case
    allowed = satisfying(whole, policy, 8)
    inner = sorted((sorted(one) for one in allowed if all(now <= 6 for now, _, _ in one)), key=str)
    for part in random.sample(inner, min(12, len(inner))):
        samples = [Sample(value, valid, now) for now, valid, value in part]
        is_largest = not any(set(part) < other for other in allowed)
        assert (not omissions(samples, whole, policy, END)) == is_largest


@pytest.mark.parametrize(
    "policy",
    [
        Policy(max_delay=ms(100)),
        Policy(order=Order.MONOTONE),
        Policy(change=ANY_CHANGE),
        Policy(change=SampleEvery(ms(10))),
    ],
)
def test_one_sample_out_of_many_is_found(policy):
    """Long streams can be judged: time grows with their length, not with its square."""
    rng = np.random.default_rng(1)
    whole = [
        Sample(int(value), ms(10 * at), ms(10 * at + 3))
        for at, value in enumerate(rng.integers(0, 3, 20_000))
    ]
    part = whole[:12_345] + whole[12_346:]

    found = omissions(part, whole, policy, END)

    assert found == [whole[12_345]]
    assert omissions(whole, whole, policy, END) == []

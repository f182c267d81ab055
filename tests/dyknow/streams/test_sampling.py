"""Sampled streams, as text."""

import pytest

from dyknow.streams.policy import Approximation, Constraint, Policy, SampleEvery
from tests.support.policies import adapted
from tests.support.streams import ms, stream, text


def _most_recent(delay, *, end=400):
    return Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(100)),
        max_delay=ms(delay),
        start=ms(0),
        end=ms(end),
    )


@pytest.mark.parametrize(
    ("given", "delay", "expected"),
    [
        ("0:a 40:b 80:c 120:d 160:e 200:f", 0, "0:a 100:c 200:f 300:f 400:f"),
        ("0:a 100:b@130", 50, "0:a 100:b@130 200:b@250 300:b@350 400:b@450"),
        ("0:a 100:b@151", 50, "0:a 100:a@150 200:b@250 300:b@350 400:b@450"),
        ("0:a 100:b@150", 50, "0:a 100:b@150 200:b@250 300:b@350 400:b@450"),
        ("0:a 200:c 100:b@240", 150, "0:a 100:b@240 200:c@240+1 300:c@450 400:c@550"),
        ("150:x", 0, "200:x 300:x 400:x"),
        ("", 0, ""),
    ],
)
def test_the_most_recent_value_fills_the_grid(given, delay, expected):
    """Exact samples come when they arrive, others are made up when the delay has passed."""
    made, _ = adapted(stream(given), _most_recent(delay), ms(1000))

    assert text(made) == expected


def test_a_grid_point_without_any_value_is_published():
    """Before the first sample there is nothing to approximate with."""
    _, published = adapted(stream("150:x"), _most_recent(0), ms(1000))

    assert [(v.constraint, v.valid_time, v.reason) for v in published] == [
        (Constraint.CHANGE, ms(0), "no sample of valid time 0"),
        (Constraint.CHANGE, ms(100), "no sample of valid time 100"),
    ]


@pytest.mark.parametrize(
    ("given", "expected", "missing"),
    [
        ("0:a 40:b 80:c 100:d 200:e", "0:a 100:d 200:e", []),
        ("30:a 100:b 130:c", "30:a 130:c", []),
        ("0:a 120:b 200:c", "0:a 200:c", ["no sample of valid time 100"]),
        ("0:a 400:b", "0:a 400:b", ["no sample of valid time 100 nor of the 2 after it"]),
    ],
)
def test_without_approximation_only_samples_on_the_grid_are_handed_on(given, expected, missing):
    """The grid begins at the first sample; a gap is published and the stream goes on."""
    made, published = adapted(stream(given), Policy(change=SampleEvery(ms(100))), ms(1000))

    assert text(made) == expected
    assert [violation.reason for violation in published] == missing


def test_with_a_maximal_delay_a_sample_that_overtook_another_is_held_back():
    """The sample of 200 waits for that of 100, as long as this can still come in time."""
    policy = Policy(change=SampleEvery(ms(100)), max_delay=ms(150), end=ms(200))

    made, published = adapted(stream("0:a 200:c 100:b@240"), policy, ms(1000))

    assert text(made) == "0:a 100:b@240 200:c@240+1"
    assert published == []


def test_with_a_maximal_delay_a_sample_that_does_not_come_is_given_up():
    """When the delay has passed, the gap is published and what was held back follows."""
    policy = Policy(change=SampleEvery(ms(100)), max_delay=ms(150), end=ms(200))

    made, published = adapted(stream("0:a 200:c"), policy, ms(1000))

    assert text(made) == "0:a 200:c@250"
    assert [(v.valid_time, v.noticed_at) for v in published] == [(ms(100), ms(250))]


def test_a_sample_later_than_the_maximal_delay_is_published():
    """It is not handed on, and both the delay and the gap are known."""
    policy = Policy(change=SampleEvery(ms(100)), max_delay=ms(50), end=ms(100))

    made, published = adapted(stream("0:a 100:b@151"), policy, ms(1000))

    assert text(made) == "0:a"
    assert [v.constraint for v in published] == [Constraint.CHANGE, Constraint.DELAY]

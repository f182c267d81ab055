"""Streams filled with the most recent value, as text."""

import pytest

from dyknow.streams.policy import Approximation, Constraint, Policy, SampleEvery
from dyknow.streams.sample import Heartbeat
from tests.support.policies import adapted, adapted_elements
from tests.support.streams import ms, stream, text


def _most_recent(delay, *, end=400):
    return Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(100)),
        max_delay=ms(delay),
        start=ms(0),
        end=ms(end),
    )


def _beat(until, now):
    return Heartbeat(ms(until), ms(now))


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


def test_a_late_sample_is_on_the_violation_stream():
    """It still counts for what is approximated after it."""
    made, published = adapted(stream("0:a 80:b@170 100:c@180"), _most_recent(50, end=200), ms(500))

    assert text(made) == "0:a 100:a@150 200:c@250"
    assert [(text([v.sample]), v.constraint) for v in published if v.sample is not None] == [
        ("80:b@170", Constraint.DELAY),
        ("100:c@180", Constraint.DELAY),
    ]


def test_a_heartbeat_makes_an_approximation_certain():
    """The most recent value cannot change any more, so it is handed on at once."""
    made, _ = adapted_elements(
        [*stream("0:a"), _beat(220, 230)], _most_recent(90, end=300), ms(1000)
    )

    assert text(made[:3]) == "0:a 100:a@190 200:a@230"
    assert made[3] == _beat(220, 230)
    assert text(made[4:]) == "300:a@390"


def test_a_heartbeat_tells_the_future():
    """What is certain before its time is handed on at its time."""
    made, _ = adapted([*stream("0:a"), _beat(250, 10)], _most_recent(90, end=300), ms(1000))

    assert text(made) == "0:a 100:a 200:a 300:a@390"


def test_under_load_the_period_can_be_lengthened_and_shortened():
    """A shorter period begins with the first time that is not too late."""
    policy = Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(100), longest=ms(400)),
        max_delay=ms(20),
        start=ms(0),
        end=ms(1300),
    )
    given = stream(" ".join(f"{time}:{time // 100}" for time in range(0, 1400, 50)))

    made, published = adapted(given, policy, ms(2000), {ms(250): ms(400), ms(1190): ms(100)})

    assert text(made) == "0:0 100:1 200:2 600:6 1000:10 1200:12 1300:13"
    assert published == []

"""Sampled streams, as text."""

import pytest

from dyknow.streams.most_recent import MostRecentSampler
from dyknow.streams.policy import Approximation, Constraint, Policy, SampleEvery
from dyknow.streams.sample import END_OF_TIME, Heartbeat
from dyknow.streams.sampling import Sampler
from tests.support.policies import adapted, adapted_elements
from tests.support.streams import ms, stream, text


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


@pytest.mark.parametrize(
    ("given", "expected", "missing"),
    [
        ("0:a 40:b 80:c 120:d 160:e 200:f", "0:a 80:c 160:e", []),
        ("0:a 49:b 151:c", "0:a 151:c", ["no sample of valid time 100, give or take 50,"]),
        ("0:a 150:b 300:c 350:d", "0:a 150:b 300:c 350:d", []),
        ("0:a 320:b", "0:a 320:b", ["no sample of valid time 100, give or take 50, nor of the 1"]),
    ],
)
def test_a_deviation_lets_through_what_is_near_enough(given, expected, missing):
    """With a period of 100 and a deviation of 50, the next sample is 50 to 150 later."""
    policy = Policy(change=SampleEvery(ms(100), ms(50)))

    made, published = adapted(stream(given), policy, ms(1000))

    assert text(made) == expected
    assert [violation.reason.removesuffix(" after it") for violation in published] == missing


def test_what_is_held_back_is_handed_on_when_the_next_sample_is_given_up():
    """The first of those that are near enough then is taken."""
    policy = Policy(change=SampleEvery(ms(100), ms(20)), max_delay=ms(100), end=ms(400))

    made, published = adapted(stream("0:a 190:b@200 210:c 300:d"), policy, ms(1000))

    assert text(made) == "0:a 190:b@220 300:d"
    assert [(v.valid_time, v.noticed_at) for v in published] == [
        (ms(100), ms(220)),
        (ms(400), ms(520)),
    ]


def test_a_late_sample_is_on_the_violation_stream():
    """What comes when its place has been given up, or taken, is carried by a violation."""
    given = stream("0:a 200:c 100:b@240 300:d 300:e@310")

    made, published = adapted(given, Policy(change=SampleEvery(ms(100))), ms(1000))

    assert text(made) == "0:a 200:c 300:d"
    assert [(text([v.sample]), v.reason) for v in published if v.sample is not None] == [
        ("100:b@240", "the stream has gone on to valid time 200 already"),
        ("300:e@310", "the stream has gone on to valid time 300 already"),
    ]


def _beat(until, now):
    return Heartbeat(ms(until), ms(now))


def test_a_heartbeat_proves_that_a_sample_is_missing():
    """What was held back for it is not held any longer."""
    policy = Policy(change=SampleEvery(ms(100)), max_delay=ms(500))

    made, published = adapted_elements([*stream("0:a 200:c"), _beat(150, 210)], policy, ms(300))

    assert text(made[:2]) == "0:a 200:c@210"
    assert made[2:] == [_beat(150, 210)]
    assert [(v.valid_time, v.noticed_at) for v in published] == [(ms(100), ms(210))]


def test_after_the_end_of_a_stream_nothing_is_missing():
    """The last heartbeat proves gaps before what is held back, and no others."""
    policy = Policy(change=SampleEvery(ms(100)), max_delay=ms(500))
    end = Heartbeat(END_OF_TIME, ms(250))

    made, published = adapted_elements([*stream("0:a 200:c"), end], policy, ms(5000))

    assert text(made[:-1]) == "0:a 200:c@250"
    assert made[-1] == end
    assert [violation.valid_time for violation in published] == [ms(100)]


_LENGTHENED = Policy(change=SampleEvery(ms(100), longest=ms(400)))


def test_under_load_the_period_can_be_lengthened_and_shortened():
    """Each period begins at the last sample; what has been left out is not asked for again."""
    given = stream(" ".join(f"{time}:{time // 100}" for time in range(0, 1500, 100)))
    periods = {ms(250): ms(400), ms(1150): ms(100)}

    made, published = adapted(given, _LENGTHENED, ms(2000), periods)

    assert text(made) == "0:0 100:1 200:2 600:6 1000:10 1200:12 1300:13 1400:14"
    assert published == []


def test_a_gap_no_longer_than_the_longest_period_is_no_violation():
    """A process that slows down keeps a policy that allows it."""
    made, published = adapted(stream("0:a 300:b 700:c 1200:d"), _LENGTHENED, ms(2000))

    assert text(made) == "0:a 300:b 700:c 1200:d"
    assert [violation.reason for violation in published] == [
        "no sample of valid time 800 nor of the 3 after it"
    ]


@pytest.mark.parametrize(
    ("period", "message"),
    [
        (150, "expected a multiple of the period 100 up to 400, found 150"),
        (500, "expected a multiple of the period 100 up to 400, found 500"),
        (0, "expected a multiple of the period 100 up to 400, found 0"),
    ],
)
def test_only_the_periods_of_the_policy_can_be_in_force(period, message):
    """Whoever governs the load asks for what the receiver has agreed to."""
    sampler = Sampler(_LENGTHENED)
    recent = MostRecentSampler(
        Policy(
            approximation=Approximation.MOST_RECENT,
            change=_LENGTHENED.change,
            max_delay=ms(20),
            start=ms(0),
        ),
        ms(0),
    )

    for one in (sampler, recent):
        with pytest.raises(ValueError, match=message):
            one.set_period(ms(period), ms(0))
        assert one.period == ms(100)

"""The stream that a policy is applied to."""

from hypothesis import given, settings

from dyknow.streams.approximation import extend, extended_samples
from dyknow.streams.policy import Approximation, Policy, SampleEvery
from tests.support.interpretations import naive_extend
from tests.support.policies import approximating_policies, policies, streams
from tests.support.streams import ms, stream, text

SPEED = stream("1000:s1@1010 1100:s2@1110 1200:s3@1280 1300:s4@1320")


def _most_recent(*, start, end, delay):
    return Policy(
        approximation=Approximation.MOST_RECENT,
        change=SampleEvery(ms(100)),
        max_delay=ms(delay),
        start=ms(start),
        end=ms(end),
    )


def test_extending_puts_the_most_recent_value_on_each_grid_point():
    """The values are those of definition 4.5.10, available as soon as they can be known."""
    extended = extend(SPEED, _most_recent(start=1050, end=1250, delay=80), ms(5000))

    assert text(extended) == "1050:s1 1150:s2 1250:s3@1280"
    assert text(extend(SPEED, Policy(), ms(5000))) == text(SPEED)


def test_an_approximation_is_due_when_the_maximal_delay_has_passed():
    """Until then a better value can come; a sample of exactly the time is due at once."""
    extended = extended_samples(SPEED, _most_recent(start=1100, end=1300, delay=50), ms(5000))

    assert [(one.sample.value, one.due) for one in extended] == [
        ("s2", ms(1110)),
        ("s2", ms(1250)),
        ("s4", ms(1320)),
    ]


def test_of_several_samples_of_exactly_the_time_the_first_counts():
    """It has been handed on when the second arrives."""
    given_stream = stream("0:a 100:b 100:c@110")

    assert text(extend(given_stream, _most_recent(start=0, end=200, delay=50), ms(500))) == (
        "0:a 100:b 200:c"
    )


@settings(derandomize=True, deadline=None, max_examples=150)
@given(streams(), policies() | approximating_policies())
def test_the_extended_stream_is_that_of_the_definition(given_stream, policy):
    """In one pass, what the definition says of each time of the grid by itself."""
    for until in (ms(60), ms(400)):
        expected = naive_extend(given_stream, policy, until)
        assert text(extend(given_stream, policy, until)) == text(expected)

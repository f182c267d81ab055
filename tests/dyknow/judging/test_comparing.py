"""Where a recorded stream differs from what should have been recorded."""

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.judging.comparing import Comparison
from dyknow.judging.judgement import Breach, Definition, Tally
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint
from tests.support.laws import same_streams
from tests.support.mutations import MUTATIONS, Mutation
from tests.support.policies import streams
from tests.support.streams import ms, stream

EXPECTED = "0:a 100:b 200:c 300:d"


def differences(expected: list[Sample[Any]], recorded: list[Sample[Any]]) -> list[Breach]:
    """Return all differences of two streams."""
    tally = Tally(1 << 30)
    comparison = Comparison("speed", Definition.UNIT, recorded, tally)
    for sample in expected:
        comparison.expect(sample)
    comparison.finish()
    assert tally.count == len(tally.kept)
    return list(tally.kept)


@pytest.mark.parametrize(
    ("recorded", "expected", "found"),
    [
        ("0:a 200:c 300:d", "a sample valid at 100 and available at 100: 'b'", "none"),
        ("0:a 100:b 200:c", "a sample valid at 300 and available at 300: 'd'", "none"),
        ("0:a 100:x 200:c 300:d", "'b'", "'x'"),
        ("0:a 100:b@110 200:c 300:d", "available time 100", "available time 110"),
        ("0:a 100:b 200:c 300:d@200+1", "available time 300", "available time 200000001 ns"),
        ("0:a 110:b@100 200:c 300:d", "valid time 100", "valid time 110"),
        ("0:a 100:x@110 200:c 300:d", "available time 100 and 'b'", "available time 110 and 'x'"),
        ("0:a 100:b 150:x 200:c 300:d", "no such sample", "'x'"),
        (
            "0:a 100:b 100:b@150 200:c 300:d",
            "no such sample",
            "'b', the same as the one before it",
        ),
    ],
)
def test_one_difference_is_told_as_one(recorded: str, expected: str, found: str) -> None:
    """What is missing, too much, altered or shifted is told apart, and is told once."""
    samples = stream(recorded.replace("+1", ""))
    if "+1" in recorded:
        samples[-1] = Sample("d", ms(300), TimePoint(ms(200) + 1))

    (breach,) = differences(stream(EXPECTED), samples)

    assert (breach.expected, breach.found) == (expected, found)


def test_samples_in_each_others_place_are_two_differences() -> None:
    """Of two samples that have changed places, each is told with its available times."""
    one, other = differences(stream(EXPECTED), stream("0:a 200:c@100 100:b@200 300:d"))

    assert (one.expected, one.found) == ("available time 200", "available time 100")
    assert (other.expected, other.found) == ("available time 100", "available time 200")


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams())
def test_a_stream_does_not_differ_from_itself(samples: list[Sample[Any]]) -> None:
    """Equal streams have no differences."""
    assert differences(samples, list(samples)) == []


@settings(derandomize=True, deadline=None, max_examples=300)
@given(streams().filter(bool), st.sampled_from(MUTATIONS), st.integers(0, 11))
def test_any_difference_is_found(
    samples: list[Sample[Any]], mutation: Mutation, place: int
) -> None:
    """There is a difference if and only if the streams are not the same, and there are few."""
    spoilt = mutation(samples, place % len(samples))
    recorded = sorted(spoilt, key=lambda sample: sample.available_time)

    found = differences(samples, recorded)

    assert bool(found) == (not same_streams(samples, recorded))
    assert len(found) <= 2


def test_a_missing_sample_does_not_make_the_later_ones_wrong() -> None:
    """Of a long stream that lacks one sample in the middle, one is told."""
    samples = [Sample(number, ms(number), ms(number)) for number in range(5000)]

    (breach,) = differences(samples, [*samples[:2000], *samples[2001:]])

    assert breach.valid_time == ms(2000)


def test_wholly_different_streams_are_compared_in_one_pass() -> None:
    """What has no counterpart is told without keeping all of it."""
    samples = [Sample(number, ms(2 * number), ms(2 * number)) for number in range(2000)]
    others = [Sample("x", ms(2 * number + 1), ms(2 * number + 1)) for number in range(2000)]

    found = differences(samples, others)

    assert len(found) == 4000

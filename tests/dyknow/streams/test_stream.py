"""Questions to fluent streams: the examples of Heintz (2009), section 4.3.

The streams of the thesis have times without a unit; here they are milliseconds.
"""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import NO_SAMPLE, Sample
from dyknow.streams.stream import (
    available,
    available_times,
    is_fluent_stream,
    join,
    last_available,
    last_valid_before,
    most_recent_at,
    previous,
    valid_before,
)
from tests.support.policies import streams
from tests.support.streams import ms, stream, text

F1 = stream("1:v1 2:v2@3 5:v3@4")
F2 = stream("1:v4@2 1:v5@4 1:v6@5")


def test_example_4_3_5_fluent_streams_have_unique_available_times():
    """Samples in order of available time are a fluent stream, samples at one time are not."""
    assert is_fluent_stream(F1)
    assert is_fluent_stream(F2)
    assert not is_fluent_stream(stream("1:a@4 2:b@4"))


def test_example_4_3_6_the_last_available_sample():
    """The last available sample of a stream changes as time goes on."""
    assert text([last_available(F1, ms(2))]) == "1:v1"
    assert text([last_available(F1, ms(3))]) == "2:v2@3"
    assert last_available(F2, ms(1)) is NO_SAMPLE
    assert text([last_available(F2, ms(3))]) == "1:v4@2"
    assert text([last_available(F2, ms(4))]) == "1:v5@4"


def test_example_4_3_7_the_previous_sample():
    """Each sample but the first has one before it."""
    assert text([previous(F1, F1[1])]) == "1:v1"
    assert previous(F1, F1[0]) is NO_SAMPLE


def test_example_4_3_8_available_times():
    """The available times of two streams are those of either."""
    assert available_times(F1) == {ms(1), ms(3), ms(4)}
    assert available_times(F2) == {ms(2), ms(4), ms(5)}
    assert available_times(F1, F2) == {ms(1), ms(2), ms(3), ms(4), ms(5)}


def test_example_4_3_11_the_join_of_two_streams():
    """At each time with something new, the join has the last available sample of each stream."""
    joined = join(F1, F2)

    assert [sample.available_time for sample in joined] == [ms(t) for t in (1, 2, 3, 4, 5)]
    assert [[getattr(s, "value", s) for s in sample.value] for sample in joined] == [
        ["v1", NO_SAMPLE.value],
        ["v1", "v4"],
        ["v2", "v4"],
        ["v3", "v5"],
        ["v3", "v6"],
    ]


def test_of_samples_with_one_valid_time_the_last_available_is_the_most_recent():
    """The later of two estimates of the same moment counts, once it is there."""
    assert text(last_valid_before(F2, ms(3), ms(4))) == "1:v4@2 1:v5@4"
    assert text([most_recent_at(F2, ms(3), ms(4))]) == "1:v5@4"
    assert text([most_recent_at(F2, ms(3), ms(3))]) == "1:v4@2"
    assert most_recent_at(F1, ms(0), ms(5)) is NO_SAMPLE


def test_section_7_8_1_the_most_recent_value_for_a_state():
    """At 1130, the most recent speed for 1050 is the one that was valid at 1000."""
    speed = stream("1000:s1@1010 1100:s2@1110 1200:s3@1280 1300:s4@1320")

    assert text([most_recent_at(speed, ms(1050), ms(1130))]) == "1000:s1@1010"


def test_what_is_before_no_sample_is_no_sample():
    """Definition 4.3.12 has an answer for the absence of a sample too."""
    assert previous(F1, NO_SAMPLE) is NO_SAMPLE
    assert not is_fluent_stream([NO_SAMPLE])


def test_samples_that_become_available_together_are_joined_once():
    """At one time there is one element of the join, whatever the number of new samples."""
    joined = join(stream("0:a 10:b"), stream("10:c"), [])

    assert [sample.available_time for sample in joined] == [ms(0), ms(10)]
    assert [text(joined[1].value[:2]), joined[1].value[2]] == ["10:b 10:c", NO_SAMPLE]
    assert join() == []


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(streams(), max_size=4))
def test_the_join_is_that_of_the_definition(given_streams):
    """In one pass, what definition 4.3.16 says of each time by itself."""
    expected = [
        Sample(tuple(last_available(one, time) for one in given_streams), time, time)
        for time in sorted(available_times(*given_streams))
    ]

    assert join(*given_streams) == expected


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), st.integers(0, 22))
def test_what_is_available_is_found_as_the_definitions_say(given_stream, time):
    """Definitions 4.3.7, 4.3.8 and 4.3.12 as sets, without regard to order."""
    now = ms(10 * time)

    there = [sample for sample in given_stream if sample.available_time <= now]

    assert available(given_stream, now) == there
    assert last_available(given_stream, now) is _latest(there)
    for sample in given_stream:
        earlier = [s for s in given_stream if s.available_time < sample.available_time]
        assert previous(given_stream, sample) is _latest(earlier)


def _latest(samples):
    return max(samples, key=lambda sample: sample.available_time, default=NO_SAMPLE)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.dictionaries(st.integers(0, 9), st.integers(0, 9)), st.integers(0, 9), st.integers(0, 9))
def test_valid_before_is_what_is_available_and_valid_in_time(valid_by_available, time, query):
    """Samples are valid before t at q if they are available at q and valid at or before t."""
    given_stream = [Sample(v, ms(v), ms(a)) for a, v in sorted(valid_by_available.items())]

    found = valid_before(given_stream, ms(time), ms(query))

    assert all(sample in available(given_stream, ms(query)) for sample in found)
    expected = {(v, a) for a, v in valid_by_available.items() if v <= time and a <= query}
    assert {(s.value, s.available_time // ms(1)) for s in found} == expected

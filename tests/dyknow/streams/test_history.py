"""Many questions about one stream."""

from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.history import History
from dyknow.streams.sample import NO_SAMPLE
from dyknow.streams.stream import last_available, most_recent_at
from tests.support.policies import streams
from tests.support.streams import ms, stream, text


def test_a_late_sample_counts_from_when_it_is_available():
    """What was most recent at a time depends on when the question is asked."""
    history = History(stream("0:a 20:c 10:b@30"))

    assert text([history.most_recent_at(ms(15), ms(29))]) == "0:a"
    assert text([history.most_recent_at(ms(15), ms(30))]) == "10:b@30"
    assert text([history.most_recent_at(ms(25), ms(30))]) == "20:c"
    assert text([history.last_available(ms(40))]) == "10:b@30"


def test_an_empty_history_has_no_answers():
    """Nothing was ever available."""
    assert History([]).most_recent_at(ms(5), ms(5)) is NO_SAMPLE
    assert History([]).last_available(ms(5)) is NO_SAMPLE


@settings(derandomize=True, deadline=None, max_examples=100)
@given(streams(), st.integers(0, 13), st.integers(0, 22))
def test_the_answers_are_those_of_the_definitions(given_stream, time, query):
    """A history only answers faster than definitions 4.3.8 and 4.3.11."""
    history = History(given_stream)
    time, query = ms(10 * time), ms(10 * query)

    assert history.last_available(query) is last_available(given_stream, query)
    assert history.most_recent_at(time, query) is most_recent_at(given_stream, time, query)

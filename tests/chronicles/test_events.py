"""Events and recognitions as JSON."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import (
    Event,
    Recognition,
    event_from_json,
    json_from_event,
    json_from_recognition,
    recognition_from_json,
)
from dyknow.time import TimePoint

times = st.integers(-(10**6), 10**6).map(lambda steps: TimePoint(steps * 500_000))
texts = st.text(max_size=4)
changes = st.builds(
    Event, texts, st.lists(texts).map(tuple), st.one_of(st.none(), texts), texts, times
)
messages = st.builds(Event, texts, st.lists(texts).map(tuple), st.none(), st.none(), times)
events = st.one_of(changes, messages)
recognitions = st.builds(
    Recognition,
    texts,
    st.dictionaries(texts, texts),
    st.dictionaries(texts, times),
    st.lists(events).map(tuple),
    times,
    times,
    times,
)


@settings(derandomize=True, deadline=None, max_examples=50)
@given(events)
def test_events_survive_json(event: Event) -> None:
    """Writing an event and reading it again changes nothing."""
    assert event_from_json(json.loads(json.dumps(json_from_event(event)))) == event


@settings(derandomize=True, deadline=None, max_examples=50)
@given(recognitions)
def test_recognitions_survive_json(recognition: Recognition) -> None:
    """Writing a recognition and reading it again changes nothing."""
    document = json.loads(json.dumps(json_from_recognition(recognition)))

    assert recognition_from_json(document) == recognition


def test_the_json_of_an_event_is_as_documented():
    """Times are milliseconds; an attribute has `from` and `to`, a message neither."""
    change = Event("behind", ("car1", "car2"), None, "true", TimePoint(5_000_000))

    assert json_from_event(change) == {
        "t": 5,
        "attribute": "behind",
        "arguments": ["car1", "car2"],
        "from": None,
        "to": "true",
    }
    assert json_from_event(Event("A", (), None, None, TimePoint(1_500_000))) == {
        "t": 1.5,
        "message": "A",
        "arguments": [],
    }


def test_truth_values_and_numbers_become_text():
    """JSON's own values are taken as the words that chronicles use."""
    document = {"t": 0, "attribute": "p", "arguments": [3], "from": False, "to": True}

    assert event_from_json(document) == Event("p", ("3",), "false", "true", TimePoint(0))


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"attribute": "p", "to": "v"}, "expected a number of milliseconds as 't', found None"),
        ({"t": 1e300, "message": "m"}, "expected a time within 292 years of time zero as 't'"),
        ({"t": float("nan"), "message": "m"}, "found nan"),
        ({"t": -(10**400), "message": "m"}, "expected a time within 292 years"),
        ({"t": True, "message": "m"}, "expected a number of milliseconds as 't', found True"),
        ({"t": 1}, "expected either 'attribute' or 'message', found none"),
        ({"t": 1, "attribute": "p"}, "expected a value for 'to', found none"),
        ({"t": 1, "message": "m", "arguments": "x"}, "expected a list as 'arguments', found 'x'"),
        ({"t": 1, "message": {}}, "as 'message', found {}"),
    ],
)
def test_what_is_no_event_is_refused_with_a_reason(document, message):
    """The message says what was expected and what came."""
    with pytest.raises(ValueError, match=message.replace("{}", r"\{\}")):
        event_from_json(document)

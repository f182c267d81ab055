"""Events as lines of JSON."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from dyknow.time import TimePoint
from tests.support.event_files import events_in, lines_from
from traffic.errors import LineError

texts = st.text(st.characters(codec="utf-8"), max_size=4)
names = texts.filter(bool)
times = st.integers(-(10**9), 10**9).map(lambda amount: TimePoint(amount * 1_000))
changes = st.builds(
    Event, names, st.lists(texts).map(tuple), st.one_of(st.none(), texts), texts, times
)
messages = st.builds(Event, names, st.lists(texts).map(tuple), st.none(), st.none(), times)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.lists(st.one_of(changes, messages), max_size=5), st.integers(1, 50))
def test_written_events_are_read_again(events: list[Event], size: int) -> None:
    """However the bytes come, the events are those that were written."""
    assert events_in(lines_from(events), ".jsonl", size) == events


@pytest.mark.parametrize(
    ("line", "event"),
    [
        (
            '{"t": 1, "attribute": "p", "to": "v"}',
            Event("p", (), None, "v", TimePoint(1_000_000)),
        ),
        (
            '{"to": true, "arguments": [3, 1.5, false], "from": 0, "t": 0.5, "attribute": "p"}',
            Event("p", ("3", "1.5", "false"), "0", "true", TimePoint(500_000)),
        ),
        (
            '{"t": -2, "attribute": "p", "from": "v", "to": null, "arguments": null}',
            Event("p", (), "v", None, TimePoint(-2_000_000)),
        ),
        (
            '{"t": 0, "message": "m", "arguments": ["a:b"], "from": "x", "note": {"t": ["y"]}}',
            Event("m", ("a:b",), None, None, TimePoint(0)),
        ),
    ],
)
def test_events_are_read_as_documented(line: str, event: Event) -> None:
    """Numbers and booleans are texts, and what is not needed may be missing."""
    assert events_in(line) == [event]


@pytest.mark.parametrize(
    ("line", "place", "message"),
    [
        ('{"t": 1, "attribute": "p", "to": "v', ":1:36", "the rest of the event, found the end"),
        ('{"t": NaN, "attribute": "p", "to": "v"}', ":1:7", "a finite number, found NaN"),
        ('{"t": -Infinity, "message": "p"}', ":1:7", "a finite number"),
        ('{"t": 1e999, "message": "p"}', ":1:7", "a time of at most"),
        ('{"t": 1e-9, "message": "p"}', ":1:7", "a time in whole nanoseconds"),
        ('{"t": "1", "message": "p"}', ":1:7", "a number of milliseconds as 't', found '1'"),
        ('{"t": true, "message": "p"}', ":1:7", "a number of milliseconds as 't', found true"),
        ('{"message": "p"}', ":1:1", "'t', a time, found none"),
        ('{"t": 1}', ":1:1", "either 'attribute' or 'message', found neither"),
        ('{"t": 1, "attribute": "p", "message": "p"}', ":1:1", "'message', found both"),
        ('{"t": 1, "message": ""}', ":1:21", "a name as 'message', found ''"),
        ('{"t": 1, "attribute": 5, "to": "v"}', ":1:23", "a name as 'attribute', found 5"),
        ('{"t": 1, "attribute": "p"}', ":1:1", "'to', the value after the change, found none"),
        ('{"t": 1, "attribute": "p", "to": null}', ":1:34", "'to', the value after"),
        ('{"t": 1, "attribute": "p", "to": [1]}', ":1:34", "a boolean as 'to', found an array"),
        ('{"t": 1, "message": "p", "arguments": "a"}', ":1:39", "an array as 'arguments'"),
        ('{"t": 1, "message": "p", "arguments": [[]]}', ":1:39", "found an array"),
        ('{"t": 1, "t": 2, "message": "p"}', ":1:15", "'t' once, found it twice"),
        ("[1]", ":1:1", "an object, found an array"),
        ("p", ":1:1", "an object of JSON, found 'p'"),
    ],
)
def test_what_is_no_event_is_refused(line: str, place: str, message: str) -> None:
    """The place is that of the value at fault, and the message says what was expected."""
    good = '{"t": 1, "message": "m"}'
    for before in ("", f"{good}\n"):
        with pytest.raises(LineError) as raised:
            events_in(before + line, ".jsonl")

        number = before.count("\n") + 1
        assert raised.value.place == "events" + place.replace(":1:", f":{number}:")
        assert message in str(raised.value)


def test_bytes_that_are_no_text_are_refused() -> None:
    """A file in another encoding is told by its first byte that is not UTF-8."""
    with pytest.raises(LineError, match="events:1:22: expected UTF-8, found the byte 0xe9"):
        events_in('{"t": 1, "message": "é"}'.encode("latin-1"))


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(
        st.sampled_from(["t", "attribute", "message", "arguments", "from", "to"]),
        inner,
        max_size=5,
    ),
    max_leaves=8,
))  # fmt: skip
def test_any_json_is_read_or_refused(document: object) -> None:
    """A line of JSON of any shape gives an event or a fault of that line."""
    place = "events:1"
    try:
        events_in(json.dumps(document), ".jsonl")
    except LineError as error:
        place = error.place

    assert place.startswith("events:1")

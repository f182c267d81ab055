"""The format of events is told by the name of a file or by its first character."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chronicles.events import Event
from dyknow.time import TimePoint
from tests.support.damage import damaged
from tests.support.event_files import events_in
from traffic.errors import LineError
from traffic.recognising.opening import open_events

JSON = """{"t": 1, "attribute": "p", "arguments": ["a"], "from": "v", "to": "été"}
{"t": 2.5, "message": "m", "arguments": ["a", "b"]}
"""
CSV = 't,attribute,message,arguments,from,to\n1,p,,a,v,"été"\n2.5,,m,a b,,\n'
EVENTS = [
    Event("p", ("a",), "v", "été", TimePoint(1_000_000)),
    Event("m", ("a", "b"), None, None, TimePoint(2_500_000)),
]


@pytest.mark.parametrize("text", [JSON, CSV, "\n  \n" + JSON, "\ufeff" + JSON, "\ufeff" + CSV])
@pytest.mark.parametrize("size", [1, 7, 1000])
def test_both_formats_say_the_same(text: str, size: int) -> None:
    """The first character tells them apart."""
    assert events_in(text, size=size) == EVENTS


def test_names_tell_the_format(tmp_path) -> None:
    """Files are read by their endings, or by what is in them."""
    for name, text in (("a.csv", CSV), ("a.jsonl", JSON), ("a.txt", CSV), ("b", JSON)):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        with open_events(path) as events:
            assert list(events) == EVENTS


@pytest.mark.parametrize("ending", ["", ".csv", ".jsonl"])
@pytest.mark.parametrize("text", ["", "\n", " \n\n"])
def test_a_file_may_be_empty(text: str, ending: str) -> None:
    """Nothing happened."""
    assert events_in(text, ending) == []


@settings(derandomize=True, deadline=None, max_examples=250)
@given(
    content=st.one_of(damaged(JSON.encode()), damaged(CSV.encode()), st.binary(max_size=60)),
    ending=st.sampled_from(["", ".csv", ".jsonl"]),
    size=st.integers(1, 40),
)
def test_damaged_events_are_read_or_refused(content: bytes, ending: str, size: int) -> None:
    """Whatever the bytes, there are events or one of our errors, with a place."""
    place = "events:"
    try:
        events_in(content, ending, size)
    except LineError as error:
        place = error.place

    assert place.startswith("events:")

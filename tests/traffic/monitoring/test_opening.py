"""The format of states is told by the name of a file or by its first character."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.errors import SpecificationErrors
from tests.support.damage import damaged
from tests.support.state_files import Pieces, asked, reader_of, states_in
from traffic.errors import LineError
from traffic.monitoring.following import follow
from traffic.monitoring.opening import open_states, read_states

JSON = """{"t": 1, "values": {"p": true, "x[a]": 2.5, "name": "b"}}
{"t": 2.5, "values": {"p": false, "x[a]": -1, "name": "été"}}
"""
CSV = 't,p,x[a],"name"\n1,true,2.5,b\n2.5,false,-1,"été"\n'
STATES = [
    (1_000_000, {"p": True, "x(a)": 2.5, "name": "b"}),
    (2_500_000, {"p": False, "x(a)": -1, "name": "été"}),
]
FORMULA = 'always (p or x(a) > 1 or name = "b")'
QUESTION = asked(FORMULA)


@pytest.mark.parametrize("text", [JSON, CSV, "\n  \n" + JSON, "\ufeff" + JSON, "\ufeff" + CSV])
@pytest.mark.parametrize("size", [1, 7, 1000])
def test_both_formats_say_the_same(text, size):
    """The first character tells them apart."""
    assert states_in(text, FORMULA, size=size) == STATES


def test_names_tell_the_format(tmp_path):
    """Files are read by their endings, or by what is in them."""
    sorts = asked(FORMULA).sorts
    for name, text in (("a.csv", CSV), ("a.jsonl", JSON), ("a.txt", CSV), ("b", JSON)):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        with open_states(path, sorts) as states:
            assert [time for time, _ in states] == [1_000_000, 2_500_000]
            assert states.name == str(path)


@pytest.mark.parametrize("ending", ["", ".csv", ".jsonl"])
@pytest.mark.parametrize("text", ["", "\n", " \n\n"])
def test_nothing_is_no_state(text, ending):
    """An empty file is a fault."""
    with pytest.raises(LineError, match="expected at least one state, found none"):
        states_in(text, "p", ending)


def test_endless_blanks_end(monkeypatch):
    """Looking for the first character ends where a line would."""
    monkeypatch.setattr("traffic.reading.formats.LONGEST_LINE", 50)

    with pytest.raises(LineError, match="expected at least one state"):
        read_states(Pieces(b" " * 1_000, 10), "f", {})


@settings(derandomize=True, deadline=None, max_examples=250)
@given(
    content=st.one_of(damaged(JSON.encode()), damaged(CSV.encode()), st.binary(max_size=60)),
    ending=st.sampled_from(["", ".csv", ".jsonl"]),
    size=st.integers(1, 40),
)
def test_damaged_states_are_read_or_refused(content, ending, size):
    """Whatever the bytes, there is an answer or one of our errors, with a place."""
    refused = None
    try:
        follow(QUESTION, read_states(Pieces(content, size), "f", QUESTION.sorts, ending))
    except LineError as error:
        refused = error.place
    except SpecificationErrors as errors:
        refused = str(errors.exceptions[0]).removeprefix("the state at ")

    assert refused is None or refused.startswith("f")


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.sampled_from(["t", "values", "p", "x[a]", "q"]), inner, max_size=3),
    max_leaves=8,
))  # fmt: skip
def test_any_json_is_read_or_refused(document):
    """A line of JSON of any shape gives states or a fault of that line."""
    place = "states"
    try:
        list(reader_of(json.dumps(document), "p and x(a) > 1", ".jsonl"))
    except LineError as error:
        place = error.place

    assert place.startswith("states")

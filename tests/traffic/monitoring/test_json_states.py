"""States as lines of JSON."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.state_files import reader_of, states_in
from traffic.errors import LineError

ORDER = "expected states in order of time, after 1 ms"
VALUE = "expected a boolean, a number or a text"
CUT_OFF = "expected the rest of the state, found the end of the file"
GOOD = '{"t":1,"values":{"p":true}}\n'
STATES = st.lists(
    st.tuples(
        st.integers(1, 10**9),
        st.booleans(),
        st.integers(-(10**20), 10**20) | st.floats(allow_nan=False, allow_infinity=False),
        st.text(st.characters(codec="utf-8"), max_size=8),
    ),
    min_size=1,
    max_size=5,
)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(STATES, st.integers(1, 50), st.booleans())
def test_states_are_read_as_they_were_written(rows, size, is_ascii):
    """Times and values come back, whatever the spelling and however the bytes come."""
    now, expected, lines = 0, [], []
    for gap, p, x, text in rows:
        now += gap
        values = {"p": p, "x[car]": x, "other": None, "name": text}
        lines.append(json.dumps({"values": values, "t": now / 1e6}, ensure_ascii=is_ascii))
        expected.append((now, {"p": p, "x(car)": x, "name": text}))

    read = states_in("\n".join(lines), 'p and x(car) > 1 and name = "n"', ".jsonl", size)

    assert read == expected


def test_states_may_spell_features_in_turn():
    """Each state may write a feature in either way, and have more than is needed."""
    text = '{"t":1,"values":{"x[a]":1}}\n\n{"t":2,"values":{"x(a)":2,"q":1,"r":3}}\n'

    assert [values for _, values in states_in(text, "x(a) > 0")] == [{"x(a)": 1}, {"x(a)": 2}]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("nonsense", "2:1: expected an object of JSON, found 'nonsense'"),
        ("[1]", "2:1: expected an object, found an array"),
        ("1", "2:1: expected an object, found 1"),
        ('{"t":2}', "2:1: expected 'values', an object with the features, found none"),
        ('{"time":2,"values":{}}', "2:1: expected 't', a time, found none"),
        ('{"t":2,"value":{}}', "found none; did you mean 'value'?"),
        ('{"t":null,"values":{}}', "2:6: expected a number of milliseconds, found null"),
        ('{"t":"2","values":{}}', "2:6: expected a number of milliseconds, found '2'"),
        ('{"t":true,"values":{}}', "2:6: expected a time in milliseconds, found true"),
        ('{"t":2,"values":3}', "2:17: expected an object with the features, found 3"),
        ('{"t":1,"values":{}}', f"2:6: {ORDER}, found another one at 1 ms"),
        ('{"t":0.5,"values":{}}', f"2:6: {ORDER}, found one at 0.5 ms"),
        ('{"t":2,"values":{"q":0,"p":NaN}}', "2:28: expected a finite number, found NaN"),
        ('{"t":2,"values":{"p":-Infinity}}', "2:22: expected a finite number, found -Infinity"),
        ('{"t":2,"values":{"ä":1,"p":1e999}}', "2:28: expected a number below 1.8e308"),
        ('{"t":2,"values":{"p":null}}', "2:22: expected a value of 'p', found null"),
        ('{"t":2,"values":{"p":[1,{"p":3}]}}', f"2:22: {VALUE}, found an array"),
        ('{"t":2,"values":{"p":true,"p":false}}', "2:31: expected 'p' once, found it twice"),
        ('{"t":2,"t":3,"values":{"p":true}}', "2:12: expected 't' once, found it twice"),
        ('{"t":2,"values":{"p":true},', f"2:28: {CUT_OFF}"),
        ('{"t":2,"values":{"p":tr', f"2:24: {CUT_OFF}"),
        ('{"t":2,"values":{"p":"a', f"2:24: {CUT_OFF}"),
        ('{"t":' + "1" * 5_000 + ',"values":{}}', "2:4"),
        ("[" * 1_000, "recursion limit exceeded"),
    ],
)  # fmt: skip
def test_faults_have_their_place(line, message):
    """File, line and column, what was expected and what was found."""
    with pytest.raises(LineError) as raised:
        states_in(GOOD + line)

    assert str(raised.value).startswith("states:2")
    assert message in str(raised.value)


def test_features_may_not_be_there_in_both_notations():
    """Which of the two values would count?"""
    with pytest.raises(LineError, match=r"1:34: expected 'x\(a\)' once, found 'x\[a\]' as well"):
        states_in('{"t":1,"values":{"x(a)":1,"x[a]":2}}', "x(a) > 1", ".jsonl")


def test_other_bytes_are_refused():
    """What is not UTF-8 is no state."""
    with pytest.raises(LineError, match="states:1:20: expected UTF-8, found the byte 0xff"):
        states_in(b'{"t":1,"values":{"p\xff":1}}')


def test_values_have_places():
    """The place of a value is where it stands among the values, not elsewhere in the line."""
    reader = reader_of('{"p": 1, "t":1, "values": {"q": "\\"p\\": 1", "p": 7, "r[a]": 3}}', "p")
    list(reader)

    assert reader.place("p") == "states:1:50"
    assert reader.place("missing") == reader.place() == "states:1"


def test_times_with_colons_are_no_repetition():
    """A colon inside a text is not taken for a name."""
    text = '{"t":1,"values":{"at":"12:30:00","p":true},"more":{"p":1,"q":{"p":2}}}'

    assert states_in(text) == [(1_000_000, {"p": True})]

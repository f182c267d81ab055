"""States as comma-separated values."""

import csv
import io

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.state_files import reader_of, states_in
from traffic.errors import LineError

NAMES = st.text(st.characters(codec="utf-8", exclude_characters="\r\n\0"), min_size=1, max_size=8)


@settings(derandomize=True, deadline=None, max_examples=100)
@given(
    st.lists(
        st.tuples(
            st.integers(1, 10**9),
            st.booleans(),
            st.floats(allow_nan=False, allow_infinity=False),
            NAMES.map(str.strip).filter(bool),
        ),
        min_size=1,
        max_size=5,
    ),
    st.integers(1, 50),
    st.sampled_from(["\n", "\r\n"]),
)
def test_states_are_read_as_they_were_written(rows, size, end):
    """What the csv module writes comes back, quoted or not."""
    now, expected, written = 0, [], io.StringIO()
    writer = csv.writer(written, lineterminator=end)
    writer.writerow(["dist[a, b]", "t", "p", "other", "name"])
    for gap, p, x, name in rows:
        now += gap
        writer.writerow([x, now / 1e6, p, "", name])
        expected.append((now, {"p": p, "dist(a, b)": x, "name": name}))

    read = states_in(written.getvalue(), 'p and dist(a, b) > 1 and name = "n"', ".csv", size)

    assert read == expected


@pytest.mark.parametrize(
    ("cell", "formula", "value"),
    [
        ("TRUE", "x", True), ("0", "x", False), (" False ", "x", False),
        ("0", "x > 1", 0.0), (" -1e3 ", "x > 1", -1000.0),
        ("12", 'x = "a"', "12"), ("nan", 'x = "a"', "nan"),
        ("12", "x = y", 12.0), ("b1", "x = y", "b1"), ("1_0", "x = y", "1_0"),
    ],
)  # fmt: skip
def test_cells_are_read_as_the_formula_needs_them(cell, formula, value):
    """There are no sorts in the format; the formula tells."""
    assert states_in(f"t,x,y\n1,{cell},1", formula, ".csv")[0][1]["x"] == value


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("x,p\n1,1", "1:1: expected a column 't' with the time, found none"),
        ("T;p\n1;1", "1:1: expected a column 't' with the time, found none"),
        ("t,p,q,p\n", "1:7: expected one column 'p', found another at column 2"),
        ("t,p,t \n", "1:5: expected one column 't', found another at column 1"),
        ("t,p\n1,true\n2", "3:2: expected 2 cells, found 1 and the end of the file"),
        ("t,p\n1,true\n2\n", "3:2: expected 2 cells as in the first line, found 1"),
        ("t,p\n1,true,3\n", "2:8: expected 2 cells as in the first line, found 3"),
        ('t,q,p\n1,"a,b",yes\n', "2:9: expected a boolean ('p'), found 'yes'"),
        ("t,p\n1,\n", "2:3: expected a boolean ('p'), found an empty cell"),
        ("t,p\n1,2\n", "2:3: expected a boolean ('p'), found '2'"),
        ("t,p\n1,1\n1,1\n", "3:1: expected states in order of time, after 1 ms, found another"),
        ("t,p\n1,1\n0,1\n", "3:1: expected states in order of time, after 1 ms, found one at 0"),
        ("p,t\n1,x\n", "2:3: expected a time in milliseconds, found 'x'"),
        ('t,p\n1,"a\nb"\n', "2:3: expected quoted cells that end on their line, found unexp"),
        ('t,p\n1,"a"b\n', "2:3: expected quoted cells that end on their line"),
        ("t,p\n\n", ": expected at least one state, found none"),
    ],
)
def test_faults_have_their_place(rows, message):
    """File, line and column, what was expected and what was found."""
    with pytest.raises(LineError) as raised:
        states_in(rows, "p", ".csv")

    assert str(raised.value).startswith("states:")
    assert message in str(raised.value)


@pytest.mark.parametrize("cell", ["nan", "inf", "-Infinity", "1e999", "1_000", "fast", " "])
@pytest.mark.parametrize("formula", ["x > 1", "x = y"])
def test_numbers_are_finite(cell, formula):
    """What is no finite number is refused where a number belongs, and never guessed."""
    if formula == "x = y" and cell in {"fast", "1_000"}:
        return
    with pytest.raises(LineError, match=r"states:2:3: expected a (number|value)"):
        states_in(f"t,x,y\n1,{cell},1", formula, ".csv")


def test_other_bytes_are_refused():
    """What is not UTF-8 is no state; a byte order mark is passed over."""
    assert states_in(b"\xef\xbb\xbft,p\n1,1") == [(1_000_000, {"p": True})]
    with pytest.raises(LineError, match="states:2:3: expected UTF-8, found the byte 0xe9"):
        states_in(b"t,p\n1,\xe9")


def test_values_have_places():
    """The place of a value is that of its cell."""
    reader = reader_of('t,q,p\n1,"a ""x"", b",1\n', "p", ".csv")
    list(reader)

    assert reader.place("p") == "states:2:16"
    assert reader.place("missing") == reader.place() == "states:2"

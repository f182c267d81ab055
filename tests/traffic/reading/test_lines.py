"""Lines come one by one, as soon as they have ended, in bounded memory."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.state_files import Pieces
from traffic.errors import LineError
from traffic.reading import lines as module
from traffic.reading.lines import Lines


@settings(derandomize=True, deadline=None, max_examples=200)
@given(
    st.lists(st.binary(max_size=6).map(lambda b: b.replace(b"\n", b"")), max_size=6),
    st.integers(1, 9),
    st.booleans(),
)
def test_lines_are_what_stands_between_breaks(lines, size, has_end):
    """However the bytes come, the lines are the same; the last one may lack its end."""
    content = b"\n".join(lines) + (b"\n" if has_end else b"")
    expected = content.split(b"\n")
    if expected[-1] == b"":
        expected.pop()
    if expected and expected[0].startswith(b"\xef\xbb\xbf"):
        expected[0] = expected[0][3:]

    read = Lines(Pieces(content, size), "f")

    assert list(read) == expected
    assert read.number == len(expected)
    assert read.is_cut_off == (bool(content) and not content.endswith(b"\n"))


def test_a_line_does_not_wait_for_the_next():
    """What has ended is handed out before more is asked for."""
    stream = Pieces(b"a\nb\n", 2)

    first = next(iter(Lines(stream, "f")))

    assert first == b"a"
    assert stream.tell() == 2


def test_places_count_characters():
    """A column is a number of characters, not of bytes."""
    lines = Lines(Pieces("x\näöü\xa0z".encode()), "f")
    list(lines)

    assert lines.place() == "f:2"
    assert lines.place(lines.column(4)) == "f:2:3"


def test_endless_lines_are_refused(monkeypatch):
    """A line without end does not fill the memory."""
    monkeypatch.setattr(module, "LONGEST_LINE", 100)

    with pytest.raises(LineError, match=r"f:2: expected a line of at most 100 bytes"):
        list(Lines(Pieces(b"a\n" + b"b" * 1_000, 10), "f"))


def test_other_encodings_are_refused():
    """The first byte that is not UTF-8 is named with its place."""
    lines = Lines(Pieces("ä".encode() + b"\xff"), "f")
    list(lines)

    with pytest.raises(LineError, match="f:1:2: expected UTF-8, found the byte 0xff"):
        lines.text()

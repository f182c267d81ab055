"""Events as comma-separated values."""

import pytest

from chronicles.events import Event
from dyknow.time import TimePoint
from tests.support.event_files import events_in
from traffic.errors import LineError


@pytest.mark.parametrize(
    ("text", "events"),
    [
        ("t,message\n1,m\n", [Event("m", (), None, None, TimePoint(1_000_000))]),
        (
            "to , from,note,t,attribute,arguments\nv,,x,2.5, p ,\n",
            [Event("p", (), None, "v", TimePoint(2_500_000))],
        ),
        (
            "t,attribute,to,from,arguments\r\n0,p,,v,a\r\n\r\n-1,p,v,w,a b\r\n",
            [
                Event("p", ("a",), "v", None, TimePoint(0)),
                Event("p", ("a", "b"), "w", "v", TimePoint(-1_000_000)),
            ],
        ),
        (
            't,attribute,message,arguments,to\n0,p,,"a, b",v\n1,,m,a;b,\n2,,m,"[""a b""]",',
            [
                Event("p", ("a", "b"), None, "v", TimePoint(0)),
                Event("m", ("a", "b"), None, None, TimePoint(1_000_000)),
                Event("m", ("a b",), None, None, TimePoint(2_000_000)),
            ],
        ),
        ("t,message", []),
    ],
)
def test_events_are_read_as_documented(text: str, events: list[Event]) -> None:
    """Columns may stand in any order, and arguments be written in several ways."""
    assert events_in(text, ".csv") == events


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("time,message\n", ":1:1", "a column 't', found none"),
        ("t\n", ":1:1", "a column 'attribute' or 'message', found none"),
        ("t,attribut,to\n", ":1:1", "'message', found none; did you mean 'attribut'?"),
        ("t,attribute\n", ":1:1", "a column 'to', found none"),
        ("t,message,t\n", ":1:11", "one column 't', found another at column 1"),
        ("t,message\n1,m,x\n", ":2:5", "2 cells as in the first line, found 3"),
        ("t,message\n1", ":2:2", "2 cells, found 1 and the end of the file"),
        ("t,message\nnan,m\n", ":2:1", "a time in milliseconds, found 'nan'"),
        ("t,message\n,m\n", ":2:1", "a time in milliseconds, found ''"),
        ("t,message\n1e20,m\n", ":2:1", "a time of at most"),
        (f"t,message\n{'9' * 30},m\n", ":2:1", "a time of at most"),
        ("t,message\n1,\n", ":2", "either an attribute or a message, found neither"),
        ("t,attribute,message,to\n1,p,m,v\n", ":2", "or a message, found both"),
        ("t,message,from\n1,m,v\n", ":2:5", "no values of a message, found 'v'"),
        ("t,attribute,to\n1,p,\n", ":2:5", "the value after the change, found an empty cell"),
        ('t,message,arguments\n1,m,"[1]"\n', ":2:5", "or an array of texts, found '[1]'"),
        ("t,message,arguments\n1,m,[a\n", ":2:5", "or an array of texts, found '[a'"),
        ('t,message,arguments\n1,m,"a,,b,"\n', ":2:5", "arguments parted by blanks"),
        ('t,message\n1,"m\n', ":2:3", "quoted cells that end on their line"),
    ],
)
def test_what_is_no_event_is_refused(text: str, place: str, message: str) -> None:
    """The place is that of the cell at fault, and the message says what was expected."""
    with pytest.raises(LineError) as raised:
        events_in(text, ".csv")

    assert raised.value.place == f"events{place}"
    assert message in str(raised.value)

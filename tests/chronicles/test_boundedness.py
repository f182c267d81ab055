"""Events that partial instances may await without end."""

import pytest

from chronicles.boundedness import warnings
from chronicles.parser import parse_chronicles


@pytest.mark.parametrize(
    ("constraints", "awaited"),
    [
        ("t1 <= t2 <= t1 + 5; t2 < t3", ["d"]),
        ("t1 <= t2 <= t3", ["b", "d"]),
        ("end - start <= 100", []),
        ("t1 < t2 < t3 <= t1 + 9", []),
        ("t1 <= t2 <= t3 <= 5000", []),
    ],
)
def test_events_without_a_limit_are_told(constraints: str, awaited: list[str]) -> None:
    """An event is told if nothing limits how long after those before it it can come."""
    events = "event(a[?x], t1) event(b[?x], t2) event(d[?x], t3)"
    text = f"chronicle c[?x] {{ {events} {constraints} }}"

    found = warnings(parse_chronicles(text))

    assert [text[one.span.start :][6] for one in found] == awaited


@pytest.mark.parametrize(
    ("statements", "awaited"),
    [
        ("event(a[?x]:(?, true), t0) noevent(a[?x]:(true, ?), (t0 + 1, t1))", []),
        ("event(a[?x]:(?, ?), t0) noevent(a[?x]:(?, ?), (t0 + 1, t1))", []),
        ("event(a[?x], t0) noevent(a[?x], (t0 + 1, t1))", []),
        ("event(a[?x]:(?, true), t0) noevent(a[?x]:(?, true), (t0 + 1, t1))", []),
        ("event(a[?x]:(?, true), t0) noevent(a[?x]:(false, ?), (t0 + 1, t1))", ["b"]),
        ("event(a[?x]:(?, true), t0) noevent(a[?x]:(true, false), (t0 + 1, t1))", ["b"]),
        ("event(a[?x]:(?, true), t0) noevent(a[?x]:(true, ?), (t0 + 2, t1))", ["b"]),
        ("event(a[?x]:(?, true), t0) occurs(0, 1, a[?x]:(true, ?), (t0 + 1, t1))", ["b"]),
        ("event(a[?x]:(?, true), t0) noevent(d[?x]:(true, ?), (t0 + 1, t1))", ["b"]),
        ("event(a[?x]:(?, true), t0) noevent(a[?y]:(true, ?), (t0 + 1, t1))", ["b"]),
        (("event(a[?x]:(?, true), t0) event(d[?x], t) noevent(a[?x]:(true, ?), (t0 + 1, t1))"
         " t0 < t"), ["d", "b"]),
    ],
)  # fmt: skip
def test_what_holds_as_long_as_nothing_changes_is_bounded(
    statements: str, awaited: list[str]
) -> None:
    """There is one instance for what holds now if the next change ends it."""
    text = f"chronicle c[?x, ?y] {{ {statements} event(b[?x, ?y], t1) t0 < t1 }}"

    found = warnings(parse_chronicles(text))

    assert [text[one.span.start :][6] for one in found] == awaited

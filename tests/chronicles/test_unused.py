"""Declarations that nothing uses."""

from chronicles.parser import parse_chronicles
from chronicles.unused import warnings


def test_what_nothing_uses_is_told() -> None:
    """In reading order, whether it is a domain, a constraint, an attribute or a message."""
    text = """
domain A = {a} domain B = A | {b} domain C = {c} domain D = {d} domain E = {e}
constraint near(t) { t >= 0 } constraint apart[?x] { ?x != a; ?x in C }
attribute p[?x] { ?x in D } message m message n
chronicle c[?x] { event(p[?x]:(?, ?), t) noevent(m, (t, t + 5)) near(t) variable ?x in E }
"""
    found = warnings(parse_chronicles(text))

    assert [each.message for each in found] == [
        "'B' is not used", "'apart' is not used", "'n' is not used"
    ]  # fmt: skip

"""The words of the language that cannot be names, and what is said where something else stands."""

from collections.abc import Collection, Mapping

__all__ = ["RESERVED_WORDS", "alternatives", "described", "listed"]

RESERVED_WORDS = frozenset(
    (
        *("alias", "and", "attribute", "chronicle", "constraint", "delay", "domain", "else"),
        *("end", "event", "hold", "if", "in", "init", "instant", "message", "noevent", "not"),
        *("occurs", "oo", "or", "recognized", "report", "send", "start", "then", "variable"),
        "when",
    )
)
"""Words that cannot be names; those without a use yet are kept free for the whole of C.R.S."""

_EXPECTED = {
    "NAME": "a name",
    "VARIABLE": "a variable",
    "STAR": "a star variable",
    "DURATION": "a length of time",
    "INTEGER": "a number",
    "STRING": "a string",
    "ORDER": "a comparison",
    "EQUAL": "'='",
    "EQUALITY": "'==' or '!='",
    "_UNION": "'|'",
    "_DIFFERENCE": "'\\'",
    "_COMPLEMENT": "'~'",
    "START": "'start'",
    "END": "'end'",
    "PLUS": "'+'",
    "MINUS": "'-'",
    "LEFT": "'[' or ']'",
    "RIGHT": "'[' or ']'",
    "$END": "the end of the text",
}
_ANY_VALUE = {"NAME", "INTEGER", "STRING"}
_MOST_ALTERNATIVES = 8


def alternatives(terminals: Collection[str], pattern_by_name: Mapping[str, str]) -> list[str]:
    """Return how to say which *terminals* could have come, in order."""
    rest = set(terminals)
    words = set()
    if rest >= _ANY_VALUE:
        rest -= _ANY_VALUE
        words.add("a value")
    if "NAME" in rest:
        rest -= {"START", "END"}
    if "ORDER" in rest:
        rest -= {"EQUAL"}
    if "DURATION" in rest:
        rest -= {"PLUS"}
    for name in rest:
        is_keyword = name.startswith("_") and not name.startswith("__")
        sign = name[1:].lower() if is_keyword else pattern_by_name.get(name, name)
        words.add(_EXPECTED.get(name) or f"'{sign}'")
    return sorted(words)


def listed(words: list[str]) -> str:
    """Return some alternatives as one phrase."""
    if not words or len(words) > _MOST_ALTERNATIVES:
        return "a statement" if "'noevent'" in words else "something else"
    *others, last = words
    return f"{', '.join(others)} or {last}" if others else last


def described(found: str) -> str:
    """Return what to say of the text that stands at the place of a fault."""
    if not found:
        return "the end of the text"
    return f"the reserved word '{found}'" if found in RESERVED_WORDS else f"'{found}'"

"""How a statement in which parameters stand is printed: as it is written, in one way of layout."""

import re
from collections.abc import Callable

from chronicles.wording import RESERVED_WORDS
from dyknow.time import duration_from_text, text_from_duration

__all__ = ["constant", "respaced"]

_BARE = re.compile(r"[A-Za-z_]\w*|\d+", re.ASCII)
_TOKEN = re.compile(
    r'(?P<string>"[^"\n]*")'
    r"|(?P<comment>(?:\#|//)[^\n]*)"
    r"|(?P<length>\d+(?:\.\d+(?:[ \t]*(?:ns|us|ms|s|min|h)\b)?|[ \t]*(?:ns|us|ms|s|min|h)\b))"
    r"|(?P<word>[?*]?[A-Za-z_]\w*|\d+)"
    r"|(?P<sign>[<>]=|\S)"
)
_IN_ASCII = {"\u2212": "-", "\u2264": "<=", "\u2265": ">=", "*": "?"}
_BINARY = frozenset(("+", "-", "<", "<=", ">", ">=", "=", "&", "|", "in"))
_NORMAL: dict[str, Callable[[str], str]] = {
    "string": lambda text: constant(text[1:-1]),
    "comment": lambda _: "",
    "length": lambda text: text_from_duration(duration_from_text(text)),
    "word": lambda text: text,
    "sign": lambda text: _IN_ASCII.get(text, text),
}


def constant(text: str) -> str:
    """Return how a value is written, in quotes if it must be."""
    if _BARE.fullmatch(text) and text not in RESERVED_WORDS:
        return text
    return f'"{text}"'


def respaced(text: str) -> str:
    """Return a statement on times or events with blanks where they belong, without comments.

    Texts of the same tokens become equal; lengths are written in milliseconds.
    """
    found: list[str] = []
    last, wants_operand = "", True
    for match in _TOKEN.finditer(text):
        kind = str(match.lastgroup)
        token = _NORMAL[kind](match[0])
        if not token:
            continue
        if found and _are_apart(last, token):
            found.append(" ")
        found.append(token)
        is_prefix = wants_operand and token in ("+", "-")
        last = "(" if is_prefix or (wants_operand and token in ("[", "]")) else token
        wants_operand = last in ("(", ",") or last in _BINARY
    return "".join(found)


def _are_apart(left: str, right: str) -> bool:
    """Return whether a blank stands between two tokens."""
    if left in ("(", ".", ":") or right in (")", ",", ".", ":", ";"):
        return False
    if left == "," or left in _BINARY or right in _BINARY:
        return True
    return _is_word(left) and _is_word(right)


def _is_word(token: str) -> bool:
    return token[-1].isalnum() or token[-1] in '_"'

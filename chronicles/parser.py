"""From the text of a chronicle file to its syntax tree."""

from collections.abc import Callable, Collection, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, v_args
from lark.ast_utils import create_transformer
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, VisitError
from lark.tree import Meta

from chronicles import syntax
from chronicles.errors import ChronicleSyntaxError
from chronicles.syntax import ChronicleFile
from dyknow.source_text import SourceText, Span, nearest_name
from dyknow.time import MILLISECOND, Duration, duration_from_text

__all__ = ["RESERVED_WORDS", "parse_chronicles", "read_chronicles"]

RESERVED_WORDS = frozenset(
    (
        *("alias", "and", "attribute", "chronicle", "constraint", "delay", "domain", "else"),
        *("end", "event", "hold", "if", "in", "init", "instant", "message", "noevent", "not"),
        *("occurs", "oo", "or", "recognized", "report", "send", "start", "then", "variable"),
        "when",
    )
)
"""Words that cannot be names; those without a use yet are kept free for the whole of C.R.S."""

_TERMINALS = rf"""
NAME: /(?!(?:{"|".join(sorted(RESERVED_WORDS))})\b)[A-Za-z_]\w*/
VARIABLE: /\?[A-Za-z_]\w*/
STAR: /\*[A-Za-z_]\w*/
DURATION: /\d{{1,18}}(?:\.\d{{1,9}})?(?![\d.])(?:[ \t]*(?:ns|us|ms|min|s|h)\b)?/
INTEGER: /\d{{1,18}}(?!\d)/
STRING: /"[^"\n]*"/
ORDER: "<=" | ">=" | "<" | ">" | "="
EQUALITY: "==" | "!="
PLUS: "+"
MINUS: "-"
LEFT: "[" | "]"
RIGHT: "[" | "]"
COMMENT: /(?:#|\/\/)[^\n]*/
%ignore COMMENT
%ignore /\s+/
"""

_EXPECTED = {
    "NAME": "a name",
    "VARIABLE": "a variable",
    "STAR": "a star variable",
    "DURATION": "a length of time",
    "INTEGER": "a number",
    "STRING": "a string",
    "ORDER": "a comparison",
    "EQUALITY": "'==' or '!='",
    "PLUS": "'+'",
    "MINUS": "'-'",
    "LEFT": "'[' or ']'",
    "RIGHT": "'[' or ']'",
    "$END": "the end of the text",
}
_ANY_VALUE = {"NAME", "INTEGER", "STRING"}
_MOST_ALTERNATIVES = 8
_LONGEST = 1 << 58


def read_chronicles(path: Path) -> ChronicleFile:
    """Read the chronicle file at *path*, which is UTF-8.

    Raises:
        ChronicleSyntaxError: The text does not follow the grammar.
    """
    name = str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        place = Span(SourceText(name, ""), 0, 0)
        message = f"expected text in UTF-8, found the byte 0x{error.object[error.start]:02x}"
        raise ChronicleSyntaxError(f"{message} at offset {error.start}", place) from error
    return parse_chronicles(text, name)


def parse_chronicles(text: str, name: str = "<chronicles>") -> ChronicleFile:
    """Parse the text of a chronicle file, called *name* in messages.

    Raises:
        ChronicleSyntaxError: The text does not follow the grammar.
    """
    source = SourceText(name, text)
    try:
        tree = _grammar().parse(text)
        file: ChronicleFile = _transformer(source).transform(tree)
    except UnexpectedInput as error:
        raise _syntax_error(source, error) from None
    except VisitError as error:
        raise error.orig_exc from None
    return file


@cache
def _grammar() -> Lark:
    text = Path(__file__).with_name("grammar.lark").read_text(encoding="utf-8")
    return Lark(
        text + _TERMINALS,
        parser="lalr",
        start="chronicle_file",
        propagate_positions=True,
        maybe_placeholders=True,
    )


class _Pieces(Transformer[Token, Any]):
    """The rules that are no class of their own: names, lists, numbers."""

    def __init__(self, source: SourceText) -> None:
        super().__init__()
        self._source = source

    def dotted_name(self, names: list[Token]) -> str:
        return ".".join(names)

    def constant(self, tokens: list[Token]) -> str:
        (token,) = tokens
        return token[1:-1] if token.type == "STRING" else str(token)

    def parameters(self, items: list[Any]) -> tuple[Any, ...]:
        return tuple(item for item in items if item is not None)

    memberships = arguments = statements = parameters

    def count(self, tokens: list[Token]) -> int:
        return int(tokens[0])

    def limit(self, tokens: list[Token]) -> int | None:
        return int(tokens[0]) if tokens else None

    def signed(self, tokens: list[Token | None]) -> Duration:
        sign, number = tokens
        assert number is not None
        duration = self._duration(number)
        return Duration(-duration) if sign == "-" else duration

    def offset(self, tokens: list[Token | None]) -> Duration:
        return Duration(0) if tokens[-1] is None else self.signed(tokens)

    def no_lower_limit(self, _sign: list[Token]) -> None:
        return None

    no_upper_limit = no_lower_limit

    def _duration(self, token: Token) -> Duration:
        try:
            duration = duration_from_text(token)
        except ValueError:
            duration = None
        if duration is None or duration % MILLISECOND:
            message = f"'{token}' is finer than a millisecond, the instant of chronicles"
            raise ChronicleSyntaxError(message, _span_of_token(self._source, token))
        if duration > _LONGEST:
            message = f"'{token}' is longer than nine years"
            raise ChronicleSyntaxError(message, _span_of_token(self._source, token))
        return duration


def _transformer(source: SourceText) -> Transformer[Token, Any]:
    pieces = _Pieces(source)
    transformer: Transformer[Token, Any] = create_transformer(
        syntax, pieces, decorator_factory=lambda **_: v_args(wrapper=_spanned(source))
    )
    return transformer


def _spanned(source: SourceText) -> Callable[..., Any]:
    def make(node: Callable[..., Any], data: str, children: list[Any], meta: Meta) -> Any:
        span = Span(source, 0, 0) if meta.empty else Span(source, meta.start_pos, meta.end_pos)
        arrange = _ARRANGEMENTS.get(str(data))
        return node(span, *(arrange(children) if arrange else map(_plain, children)))

    return make


def _plain(child: Any) -> Any:
    return str(child) if isinstance(child, Token) else child


def _interval(children: Sequence[Any]) -> Sequence[Any]:
    """Turn the brackets of an interval into its closed ends."""
    left, lower, upper, right = children
    if lower is not None and left == "]":
        lower += MILLISECOND
    if upper is not None and right == "[":
        upper -= MILLISECOND
    return lower, upper


def _comparison(children: Sequence[Any]) -> Sequence[Any]:
    """Part a chain into its operands and the orders between them."""
    return tuple(children[::2]), tuple(str(order) for order in children[1::2])


def _values(children: Sequence[Any]) -> Sequence[Any]:
    return (tuple(child for child in children if child is not None),)


_ARRANGEMENTS: dict[str, Callable[[Sequence[Any]], Sequence[Any]]] = {
    "chronicle_file": _values,
    "interval": _interval,
    "comparison": _comparison,
    "value_set": _values,
}


def _span_of_token(source: SourceText, token: Token) -> Span:
    start = token.start_pos
    end = token.end_pos
    if start is None or end is None:
        return Span(source, len(source.text), len(source.text))
    return Span(source, start, end)


def _syntax_error(source: SourceText, error: UnexpectedInput) -> ChronicleSyntaxError:
    if isinstance(error, UnexpectedCharacters):
        assert error.pos_in_stream is not None
        span = _word_at(source, error.pos_in_stream)
        accepted: Collection[str] | None = error.allowed
    else:
        token = error.token  # type: ignore[attr-defined]  # UnexpectedToken or UnexpectedEOF
        at_end = Span(source, len(source.text.rstrip()), len(source.text.rstrip()))
        is_end = isinstance(error, UnexpectedEOF) or token.type == "$END"
        span = at_end if is_end else _span_of_token(source, token)
        accepted = getattr(error, "accepts", None) or getattr(error, "expected", None)
    expected = _alternatives(accepted or ())
    found = source.text[span.start : span.end]
    message = f"expected {_listed(expected)}, found {_described(found)}"
    nearest = nearest_name(found, (word.strip("'") for word in expected))
    hint = f"; did you mean '{nearest}'?" if nearest and nearest != found else ""
    return ChronicleSyntaxError(message + hint, span)


def _word_at(source: SourceText, start: int) -> Span:
    end = start + 1
    while source.text[start : end + 1].isidentifier() and end < len(source.text):
        end += 1
    return Span(source, start, end)


def _described(found: str) -> str:
    if not found:
        return "the end of the text"
    return f"the reserved word '{found}'" if found in RESERVED_WORDS else f"'{found}'"


def _alternatives(terminals: Collection[str]) -> list[str]:
    """Return how to say what could have come, in order."""
    pattern_by_name = {terminal.name: terminal.pattern.value for terminal in _grammar().terminals}
    rest = set(terminals)
    words = set()
    if rest >= _ANY_VALUE:
        rest -= _ANY_VALUE
        words.add("a value")
    words |= {_EXPECTED.get(name) or f"'{pattern_by_name.get(name, name)}'" for name in rest}
    return sorted(words)


def _listed(words: list[str]) -> str:
    if not words or len(words) > _MOST_ALTERNATIVES:
        return "a statement" if "'noevent'" in words else "something else"
    *others, last = words
    return f"{', '.join(others)} or {last}" if others else last

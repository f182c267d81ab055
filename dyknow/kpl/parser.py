"""From text to syntax tree."""

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, UnexpectedInput, UnexpectedToken, v_args
from lark.ast_utils import create_transformer
from lark.exceptions import UnexpectedCharacters, VisitError
from lark.tree import Meta

from dyknow.errors import FormulaSyntaxError, KPLSyntaxError
from dyknow.kpl import syntax
from dyknow.kpl.syntax import Constraint, Specification, Text, Value
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.syntax import Formula
from dyknow.runtime.failures import OnFailure
from dyknow.source_text import SourceText, Span
from dyknow.time import Duration, duration_from_text

__all__ = ["parse_policy", "parse_specification", "parse_value"]

_PHRASES = {
    "$END": "the end of the text",
    "AND_MORE": "', ...'",
    "COUNT": "a whole number",
    "FAILURE": "'end' or 'stop'",
    "FIELD": "a field",
    "FORMULA": "a formula",
    "NAME": "a name",
    "NUMBER": "a number",
    "PATTERN": "a pattern",
    "SETTING": "a setting",
    "STRING": "a string",
    "TIME": "a time",
    "TIME_WITH_UNIT": "a time",
    "OBJECT": "'object'",
    "_COMMON_PERIOD": "'common period'",
    "_THEN_CONSTRAINT": "','",
    "_THEN_SETTING": "','",
    "_ESTABLISH": "'establish ='",
    "_SELECT": "'select'",
    "_REESTABLISH": "'reestablish ='",
    "_MAINTAIN": "'maintain ='",
}
_WORD = re.compile(r"\w+|\S")
_CLOSED = re.compile(r"\[[^\[\]()]*[\])]")


def parse_specification(text: str, name: str = "<specification>") -> Specification:
    """Return the syntax tree of a KPL specification; *name* is what messages call the text.

    Raises:
        KPLSyntaxError: The text does not follow the grammar.
        FormulaSyntaxError: A condition of a link is not a formula.
    """
    source = SourceText(name, text)
    try:
        tree = _parser().parse(text, start="specification")
        specification: Specification = _transformer(source).transform(tree)
    except UnexpectedInput as fault:
        raise _syntax_error(fault, source) from None
    except VisitError as fault:
        raise fault.orig_exc from None
    return specification


def parse_value(text: str) -> Value:
    """Read a value as KPL writes it: a number, a time, a name; any other text is a string."""
    try:
        tree = _parser().parse(text, start="value")
        (value,) = _transformer(SourceText("<value>", text)).transform(tree)
    except (UnexpectedInput, VisitError):
        return Text(text)
    found: Value = value
    return found


def parse_policy(text: str, name: str = "<policy>") -> tuple[Constraint, ...]:
    """Return the constraints of a policy, written as after `with`; none for an empty text.

    Raises:
        KPLSyntaxError: The text does not follow the grammar.
    """
    if not text.strip():
        return ()
    source = SourceText(name, text)
    try:
        tree = _parser().parse(text, start="policy")
        found: tuple[Constraint, ...] = _transformer(source).transform(tree)
    except UnexpectedInput as fault:
        raise _syntax_error(fault, source) from None
    except VisitError as fault:
        raise fault.orig_exc from None
    return found


@cache
def _parser() -> Lark:
    grammar = Path(__file__).with_name("grammar.lark").read_text(encoding="utf-8")
    return Lark(
        grammar,
        parser="lalr",
        start=["specification", "policy", "value"],
        propagate_positions=True,
        postlex=_WholeWords(),
    )


class _WholeWords:
    """Lets the lexer see a name everywhere, so that it never takes `sourcea` for `source a`."""

    always_accept = ("NAME",)

    def process(self, stream: Iterator[Token]) -> Iterator[Token]:
        """Change nothing."""
        return stream


def _transformer(source: SourceText) -> Transformer[Token, Any]:
    def with_span(*, inline: bool, meta: bool) -> Callable[[Any], Any]:  # noqa: ARG001 (lark)
        def build(node: Any, _rule: str, children: list[Any], place: Meta) -> Any:
            start, end = (0, 0) if place.empty else (place.start_pos, place.end_pos)
            parts = children if inline else [tuple(children)]
            return node(*parts, span=Span(source, start, end))

        return v_args(wrapper=build)

    return create_transformer(syntax, _Leaves(source), with_span)


class _Leaves(Transformer[Token, Any]):
    """Turns tokens into values, and rules without a class into tuples."""

    def __init__(self, source: SourceText) -> None:
        super().__init__()
        self._source = source

    def __default__(self, data: Any, children: list[Any], meta: Any) -> Any:
        return tuple(child for child in children if child is not None)

    def __default_token__(self, token: Token) -> str:
        return str(token)

    def SETTING(self, token: Token) -> str:
        return token.rstrip("= \t\r\n")

    def STRING(self, token: Token) -> str:
        try:
            return str(json.loads(token))
        except ValueError:
            raise KPLSyntaxError("the string has an unknown escape", self._span(token)) from None

    def NUMBER(self, token: Token) -> int | float:
        return int(token) if re.fullmatch(r"[+-]?\d+", token) else float(token)

    def COUNT(self, token: Token) -> int:
        return int(token)

    def TIME(self, token: Token) -> Duration:
        try:
            return duration_from_text(str(token))
        except ValueError as fault:
            raise KPLSyntaxError(str(fault), self._span(token)) from None

    TIME_WITH_UNIT = TIME

    def AND_MORE(self, token: Token) -> bool:
        return bool(token)

    def TRUTH(self, token: Token) -> bool:
        return str(token) == "true"

    def on_failure(self, words: list[str | None]) -> OnFailure:
        return OnFailure(words[0]) if words[0] else OnFailure.STOP

    def deviation(self, times: list[Any]) -> Any:
        return times[0] if times else None

    longest = deviation

    def FORMULA(self, token: Token) -> Formula:
        """Parse the formula in a copy of the text that is blank elsewhere: places stay right."""
        before = re.sub(r"[^\n]", " ", self._source.text[: token.start_pos])
        try:
            formula = parse_formula(before + token, self._source.name)
        except FormulaSyntaxError as fault:
            place = Span(self._source, fault.span.start, fault.span.end)
            raise FormulaSyntaxError(fault.message, place) from None
        placed: Formula = _placed(formula, self._source)
        return placed

    def _span(self, token: Token) -> Span:
        start = token.start_pos or 0
        return Span(self._source, start, start + len(token))


def _placed(node: Any, source: SourceText) -> Any:
    """Return a formula, or a part of one, with places in *source*."""
    if isinstance(node, tuple):
        return tuple(_placed(part, source) for part in node)
    if not is_dataclass(node) or isinstance(node, type):
        return node
    names = [each.name for each in fields(node) if each.name != "span"]
    parts = {name: _placed(getattr(node, name), source) for name in names}
    found: Span = node.span  # type: ignore[attr-defined]
    return replace(node, span=Span(source, found.start, found.end), **parts)


def _syntax_error(fault: UnexpectedInput, source: SourceText) -> KPLSyntaxError:
    expected = _expected(fault)
    if isinstance(fault, UnexpectedToken) and fault.token.type == "$END":
        end = len(source.text.rstrip())
        message = f"expected {expected}, found the end of the text"
        return KPLSyntaxError(message, Span(source, end, end))
    start = _start(fault)
    found = _WORD.match(source.text, start)
    word = found[0] if found else source.text[start]
    span = Span(source, start, start + len(word))
    if word == "[" and not _CLOSED.match(source.text, start):
        return KPLSyntaxError("this '[' is not closed", span)
    return KPLSyntaxError(f"expected {expected}, found '{word}'", span)


def _start(fault: UnexpectedInput) -> int:
    at = fault.token.start_pos if isinstance(fault, UnexpectedToken) else fault.pos_in_stream
    return 0 if at is None else at


def _expected(fault: UnexpectedInput) -> str:
    names: set[str] = set()
    if isinstance(fault, UnexpectedToken):
        names = set(fault.accepts or fault.expected)
    elif isinstance(fault, UnexpectedCharacters):
        names = set(fault.allowed)
    phrases = sorted({_phrase(name) for name in names})
    *others, last = phrases or ["something else"]
    return f"{', '.join(others)} or {last}" if others else last


def _phrase(name: str) -> str:
    if name in _PHRASES:
        return _PHRASES[name]
    pattern = _parser().get_terminal(name).pattern
    return f"'{pattern.value}'"

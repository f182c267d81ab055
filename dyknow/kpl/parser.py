"""From text to syntax tree."""

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from math import isinf
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, UnexpectedInput, UnexpectedToken, v_args
from lark.ast_utils import create_transformer
from lark.exceptions import UnexpectedCharacters
from lark.parsers.lalr_interactive_parser import InteractiveParser
from lark.tree import Meta

from dyknow.errors import (
    FormulaSyntaxError,
    KPLSyntaxError,
    SpecificationError,
    SpecificationErrors,
)
from dyknow.kpl import syntax
from dyknow.kpl.recovery import MAX_DEPTH, Outline
from dyknow.kpl.syntax import Constraint, Number, Specification, Text, Truth, Value
from dyknow.kpl.wording import wording_of
from dyknow.mtl.parser import parse_formula
from dyknow.mtl.syntax import TRUE, Formula
from dyknow.runtime.failures import OnFailure
from dyknow.source_text import SourceText, Span, nearest_name
from dyknow.time import MILLISECOND, Duration, duration_from_text

__all__ = [
    "Reading",
    "parse_policy",
    "parse_specification",
    "parse_value",
    "read_specification",
    "value_from",
]

_WORD = re.compile(r"\w+|\S")
_CLOSED = re.compile(r"\[[^\[\]()]*[\])]")
_WHOLE = re.compile(r"[+-]?\d+")
_LARGEST = 1 << 63
_OUTSIDE = frozenset({"COMPUNIT", "FOR", "PARAMETER", "SOURCE", "STREAM", "STRMGEN", "$END"})
"""What can follow a declaration outside of blocks."""
_BETWEEN = _OUTSIDE | {"RBRACE"}
"""What can follow a declaration."""


@dataclass(frozen=True)
class Reading:
    """What could be read of a text.

    Attributes:
        specification: The declarations that follow the grammar.
        faults: Where the text does not, in reading order.
        lost: Names that declarations which could not be read seem to declare.
    """

    specification: Specification
    faults: tuple[SpecificationError, ...] = ()
    lost: frozenset[str] = frozenset()


def parse_specification(text: str, name: str = "<specification>") -> Specification:
    """Return the syntax tree of a KPL specification; *name* is what messages call the text.

    Raises:
        SpecificationErrors: The text does not follow the grammar, in one or several places; the
            faults are of the classes `KPLSyntaxError` and `FormulaSyntaxError`.
    """
    reading = read_specification(text, name)
    if reading.faults:
        raise SpecificationErrors(f"{len(reading.faults)} fault(s)", reading.faults)
    return reading.specification


def read_specification(text: str, name: str = "<specification>") -> Reading:
    """Return all that can be read of a text; behind a fault, from the next declaration on."""
    source = SourceText(name, text)
    outline = Outline(text)
    if outline.too_deep is not None:
        at = outline.too_deep
        message = f"expected at most {MAX_DEPTH} brackets inside one another, found more"
        return Reading(Specification(()), (KPLSyntaxError(message, Span(source, at, at + 1)),))
    recovery = _Recovery(source, outline)
    tree = recovery.tree()
    leaves = _Leaves(source)
    found = Specification(()) if tree is None else _transformer(leaves).transform(tree)
    faults = sorted([*recovery.faults, *leaves.faults], key=lambda fault: fault.span.start)
    return Reading(found, tuple(faults), frozenset(recovery.lost))


def parse_policy(text: str, name: str = "<policy>") -> tuple[Constraint, ...]:
    """Return the constraints of a policy, written as after `with`; none for an empty text.

    Raises:
        KPLSyntaxError: The text does not follow the grammar.
    """
    if not text.strip():
        return ()
    source = SourceText(name, text)
    leaves = _Leaves(source)
    try:
        tree = _parser().parse(text, start="policy")
    except UnexpectedInput as fault:
        raise _syntax_error(fault, source) from None
    found: tuple[Constraint, ...] = _transformer(leaves).transform(tree)
    if leaves.faults:
        raise leaves.faults[0]
    return found


def parse_value(text: str) -> Value:
    """Read a value as KPL writes it: a number, a time, a name; any other text is a string."""
    if Outline(text).too_deep is not None:
        return Text(text)
    leaves = _Leaves(SourceText("<value>", text))
    try:
        tree = _parser().parse(text, start="value")
    except UnexpectedInput:
        return Text(text)
    (value,) = _transformer(leaves).transform(tree)
    found: Value = Text(text) if leaves.faults else value
    return found


def value_from(given: object) -> Value:
    """Return the value that a number, a truth value, or a text that KPL could have stands for.

    Raises:
        TypeError: It is none of these.
    """
    match given:
        case bool():
            return Truth(given)
        case int() | float():
            return Number(given)
        case str():
            return parse_value(given)
        case _:
            raise TypeError(f"expected a number, a truth value or a string, not {given!r}")


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


class _Recovery:
    """Parses a text to its end, whatever is wrong with it.

    Behind a fault it goes on with the next declaration, at the nearest level of blocks where one
    may stand.

    Attributes:
        faults: In reading order.
        lost: Names that declarations which were passed over seem to declare.
    """

    def __init__(self, source: SourceText, outline: Outline) -> None:
        self.faults: list[SpecificationError] = []
        self.lost: set[str] = set()
        self._source = source
        self._outline = outline
        self._n_headless = 0

    def tree(self) -> Any:
        """Return the tree of all that follows the grammar, or None if there is nothing."""
        parser = _parser().parse_interactive(self._source.text, start="specification")
        while True:
            try:
                return parser.resume_parse()  # type: ignore[no-untyped-call]
            except UnexpectedInput as error:
                if not self._can_go_on(error, parser):
                    return None

    def _can_go_on(self, error: UnexpectedInput, parser: InteractiveParser) -> bool:
        """Note a fault; take the parser to the next place where it may understand the text."""
        at = _start(error, self._source)
        self._note(error, at)
        if at >= len(self._source.text.rstrip()):
            return self._close(parser)
        is_less = _withdraw(parser, _BETWEEN)
        resumed_at = self._outline.next_resumption(at if is_less else at + 1)
        self._n_headless += self._outline.count_openings(at, resumed_at)
        if is_less:
            self.lost.update(self._outline.names_declared(at, resumed_at))
        _go_to(parser, resumed_at)
        return True

    def _note(self, error: UnexpectedInput, at: int) -> None:
        if self._n_headless and self._source.text[at : at + 1] == "}":
            self._n_headless -= 1  # it closes a block whose beginning was passed over
        else:
            self.faults.append(_syntax_error(error, self._source))

    def _close(self, parser: InteractiveParser) -> bool:
        """Take the parser out of all that is not finished, at the end of the text."""
        end = len(self._source.text)
        _withdraw(parser, _OUTSIDE)
        self.lost.update(self._outline.names_declared(end, end))
        _go_to(parser, end)
        return True


def _withdraw(parser: InteractiveParser, allowed: frozenset[str]) -> bool:
    """Forget what is unfinished, until only *allowed* may follow; return whether there was any."""
    state = parser.parser_state
    is_less = False
    while not set(parser.accepts()) <= allowed:  # type: ignore[no-untyped-call]
        state.state_stack.pop()
        state.value_stack.pop()
        is_less = True
    return is_less


def _go_to(parser: InteractiveParser, at: int) -> None:
    """Let the lexer read on at another place of the text."""
    state = parser.lexer_thread.state
    assert state is not None  # there is a text
    state.line_ctr.char_pos = at


def _transformer(leaves: "_Leaves") -> Transformer[Token, Any]:
    source = leaves.source

    def with_span(*, inline: bool, meta: bool) -> Callable[[Any], Any]:  # noqa: ARG001 (lark)
        def build(node: Any, _rule: str, children: list[Any], place: Meta) -> Any:
            start, end = (0, 0) if place.empty else (place.start_pos, place.end_pos)
            parts = children if inline else [tuple(children)]
            return node(*parts, span=Span(source, start, end))

        return v_args(wrapper=build)

    return create_transformer(syntax, leaves, with_span)


class _Leaves(Transformer[Token, Any]):
    """Turns tokens into values, and rules without a class into tuples.

    What follows the grammar and still has no meaning is a fault; something else stands for it.

    Attributes:
        source: The text.
        faults: What has no meaning.
    """

    def __init__(self, source: SourceText) -> None:
        super().__init__()
        self.source = source
        self.faults: list[SpecificationError] = []

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
            self._report("the string has an unknown escape", token)
            return ""

    def NUMBER(self, token: Token) -> int | float:
        number = float(token)
        if isinf(number):
            self._report("the number is too large", token)
            return 0
        return int(token) if _WHOLE.fullmatch(token) else number

    COUNT = NUMBER

    def TIME(self, token: Token) -> Duration:
        try:
            time = duration_from_text(str(token))
        except ValueError as fault:
            self._report(str(fault), token)
            return MILLISECOND
        if time >= _LARGEST:
            self._report("expected a time below 2^63 nanoseconds", token)
            return MILLISECOND
        return time

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
        before = re.sub(r"[^\n]", " ", self.source.text[: token.start_pos])
        try:
            formula = parse_formula(before + token, self.source.name)
        except FormulaSyntaxError as fault:
            place = Span(self.source, fault.span.start, fault.span.end)
            self.faults.append(FormulaSyntaxError(fault.message, place))
            return TRUE
        placed: Formula = _placed(formula, self.source)
        return placed

    def _report(self, message: str, token: Token) -> None:
        start = token.start_pos or 0
        span = Span(self.source, start, start + len(token))
        self.faults.append(KPLSyntaxError(message, span))


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
    expected = wording_of(_terminals(fault), _keywords())
    start = _start(fault, source)
    found = _WORD.match(source.text, start)
    if found is None:
        end = len(source.text.rstrip())
        message = f"expected {expected}, found the end of the text"
        return KPLSyntaxError(message, Span(source, end, end))
    span = Span(source, start, start + len(found[0]))
    if found[0] == "[" and not _CLOSED.match(source.text, start):
        return KPLSyntaxError("this '[' is not closed", span)
    keywords = [word for name, word in _keywords().items() if name in _terminals(fault)]
    nearest = nearest_name(found[0], [word for word in keywords if word.isalpha()])
    hint = f"; did you mean '{nearest}'?" if nearest and len(keywords) > 1 else ""
    return KPLSyntaxError(f"expected {expected}, found '{found[0]}'{hint}", span)


def _start(fault: UnexpectedInput, source: SourceText) -> int:
    """Return where the first thing stands that does not fit."""
    if isinstance(fault, UnexpectedToken) and fault.token.type == "$END":
        return len(source.text)
    at = fault.token.start_pos if isinstance(fault, UnexpectedToken) else fault.pos_in_stream
    return 0 if at is None else at


def _terminals(fault: UnexpectedInput) -> set[str]:
    if isinstance(fault, UnexpectedToken):
        return set(fault.accepts or fault.expected)
    return set(fault.allowed) if isinstance(fault, UnexpectedCharacters) else set()


@cache
def _keywords() -> dict[str, str]:
    """Return the text of each terminal that always has the same."""
    patterns = {each.name: each.pattern for each in _parser().terminals}
    return {name: each.value for name, each in patterns.items() if each.type == "str"}

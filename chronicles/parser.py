"""From the text of a chronicle file to its syntax tree."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, Tree, v_args
from lark.ast_utils import create_transformer
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput
from lark.tree import Meta

from chronicles import syntax
from chronicles.arrangements import ARRANGEMENTS, plain
from chronicles.errors import ChronicleSyntaxError
from chronicles.intervals import intersection_of, is_empty, negated, sum_of, union_of
from chronicles.parameters import LONGEST, Given, Values, amount_from, length_from
from chronicles.recovery import MAX_DEPTH, Outline
from chronicles.syntax import Amount, ChronicleFile, Interval
from chronicles.wording import RESERVED_WORDS, alternatives, described, listed
from dyknow.errors import SpecificationError, SpecificationErrors
from dyknow.source_text import SourceText, Span, nearest_name
from dyknow.time import MILLISECOND, Duration

__all__ = ["parse_chronicles", "read_chronicles", "with_values"]

_TERMINALS = rf"""
NAME: /(?!(?:{"|".join(sorted(RESERVED_WORDS))})\b)[A-Za-z_]\w*/
VARIABLE: /\?[A-Za-z_]\w*/
STAR: /\*[A-Za-z_]\w*/
_UNION: "|" | /\+(?=\s*[~\u223c({{A-Za-z_])/
_DIFFERENCE.2: "\\" | /[-\u2212](?=\s*[~\u223c({{A-Za-z_])/
_COMPLEMENT: "~" | "\u223c"
START: /start(?!\w)/
END: /end(?!\w)/
DURATION: /\d{{1,18}}(?:\.\d{{1,9}})?(?![\d.])(?:[ \t]*(?:ns|us|ms|min|s|h)\b)?/
INTEGER: /\d{{1,18}}(?!\d)/
STRING: /"[^"\n]*"/
ORDER: "<=" | ">=" | "<" | ">" | "\u2264" | "\u2265"
EQUAL: "="
EQUALITY: "==" | "!=" | "\u2260"
PLUS: "+"
MINUS: "-" | "\u2212"
LEFT: "[" | "]"
RIGHT: "[" | "]"
COMMENT: /(?:#|\/\/)[^\n]*/
%ignore COMMENT
%ignore /\s+/
"""

_NO_NAME = r"(?!\s*(?:in\b|[<>=+\-(\[\u2264\u2265\u2212]))"
_MAY_BE_NAMES = ("parameter", "time")
"""Words that begin a declaration; behind a domain what follows tells whether they are names."""

_IN_ASCII = {"\u2212": "-", "\u2264": "<=", "\u2265": ">=", "\u2260": "!="}
_MOST_FAULTS = 20
_DEEPEST = 200
_KEYWORD = re.compile(r'"([a-z_]+)"')
_STARTS = frozenset({"_ATTRIBUTE", "_DOMAIN"})
"""Terminals that are accepted together only between declarations."""


def read_chronicles(path: Path, values: Mapping[str, Given] | None = None) -> ChronicleFile:
    """Read the chronicle file at *path*, which is UTF-8.

    Args:
        path: The file.
        values: Of its parameters, in place of those that it declares.

    Raises:
        SpecificationErrors: The text is no UTF-8 or does not follow the grammar, or a value is
            none that its parameter can have.
    """
    name = str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        place = Span(SourceText(name, ""), 0, 0)
        message = f"expected text in UTF-8, found the byte 0x{error.object[error.start]:02x}"
        fault = ChronicleSyntaxError(f"{message} at offset {error.start}", place)
        raise SpecificationErrors("1 fault(s)", [fault]) from error
    return parse_chronicles(text, name, values)


def parse_chronicles(
    text: str, name: str = "<chronicles>", values: Mapping[str, Given] | None = None
) -> ChronicleFile:
    """Parse the text of a chronicle file.

    Args:
        text: The text.
        name: How messages refer to it.
        values: Of its parameters, in place of those that it declares.

    Raises:
        SpecificationErrors: The text does not follow the grammar, in one or several places, or
            names a parameter that is not there, or a value is none that its parameter can have.
    """
    source = SourceText(name, text)
    given = _amounts(values or {})
    outline = Outline(text)
    if outline.too_deep is not None:
        place = Span(source, outline.too_deep, outline.too_deep + 1)
        message = f"expected at most {MAX_DEPTH} brackets inside one another, found more"
        raise SpecificationErrors("1 fault(s)", [ChronicleSyntaxError(message, place)])
    tree, faults = _tree(source, outline)
    deepest = None if tree is None else _too_deep(tree)
    if deepest is not None:
        message = f"expected at most {_DEEPEST} operators inside one another, found more"
        fault = ChronicleSyntaxError(message, _span_of_token(source, deepest))
        raise SpecificationErrors("1 fault(s)", [fault])
    if tree is None:
        raise SpecificationErrors(f"{len(faults)} fault(s)", faults)
    put_in = Values(source, _declared(source, tree), given)
    pieces = _Pieces(source, put_in)
    found: ChronicleFile = _transformer(source, pieces).transform(tree)
    of_names = [] if faults else put_in.faults  # what cannot be read may have declared them
    faults = sorted([*faults, *pieces.faults, *of_names], key=lambda fault: fault.span.start)
    if faults:
        raise SpecificationErrors(f"{len(faults)} fault(s)", faults)
    return _redeclared(found, given)


def with_values(file: ChronicleFile, values: Mapping[str, Given]) -> ChronicleFile:
    """Return a file, which was read from a text, with other values of some parameters.

    Raises:
        SpecificationErrors: A value is none that its parameter can have.
    """
    source = file.span.source
    kept = {parameter.name: parameter.value for parameter in file.parameters}
    return parse_chronicles(source.text, source.name, {**kept, **values})


def _redeclared(file: ChronicleFile, values: Mapping[str, Amount]) -> ChronicleFile:
    """Return a file that declares the values that its parameters have been given."""
    if not values:
        return file
    declarations = tuple(
        replace(each, value=values.get(each.name, each.value))
        if isinstance(each, syntax.ParameterDeclaration)
        else each
        for each in file.declarations
    )
    return replace(file, declarations=declarations)


def _amounts(values: Mapping[str, Given]) -> dict[str, Amount]:
    """Return the values that are given to parameters.

    Raises:
        SpecificationErrors: One is neither a length of time nor a number.
    """
    found, faults = {}, []
    for name, value in values.items():
        text = SourceText(f"<value of '{name}'>", str(value))
        try:
            found[name] = amount_from(value, Span(text, 0, len(text.text)))
        except SpecificationError as error:
            faults.append(error)
    if faults:
        raise SpecificationErrors(f"{len(faults)} fault(s)", faults)
    return found


def _declared(source: SourceText, tree: Tree[Token]) -> dict[str, Amount]:
    """Return the values that a file declares for its parameters; of two of one name, the first."""
    found: dict[str, Amount] = {}
    read = _Pieces(source, Values(source, {}, {}))
    for declaration in tree.children:
        if isinstance(declaration, Tree) and declaration.data == "parameter_declaration":
            name, amount = declaration.children
            assert isinstance(amount, Tree)
            found.setdefault(str(name), read.amount([*amount.children]))  # type: ignore[list-item]
    return found


def _tree(
    source: SourceText, outline: Outline
) -> tuple[Tree[Token] | None, list[SpecificationError]]:
    """Return the tree of what can be read, and the faults of the rest, at most so many."""
    faults: list[SpecificationError] = []
    text = source.text
    while len(faults) < _MOST_FAULTS:
        try:
            return _grammar().parse(text), faults
        except UnexpectedInput as error:
            fault = _syntax_error(source, error)
            accepted = _accepted(error)
        faults.append(fault)
        at = fault.span.start
        parts = outline.faulty_parts(at, in_block="_IF" in accepted, between=accepted >= _STARTS)
        start, end = next((part for part in parts if text[slice(*part)].strip()), (0, 0))
        if start == end or at >= len(text.rstrip()):
            break
        text = text[:start] + re.sub(r"\S", " ", text[start:end]) + text[end:]
    return None, faults


def _too_deep(tree: Tree[Token]) -> Token | None:
    """Return a token that stands deeper in a tree than one can follow, if there is one."""
    level: list[Tree[Token]] = [tree]
    for _ in range(_DEEPEST):
        level = [child for parent in level for child in parent.children if isinstance(child, Tree)]
    return next((token for each in level for token in each.scan_values(_is_token)), None)


def _is_token(child: object) -> bool:
    return isinstance(child, Token)


@cache
def _grammar() -> Lark:
    text = Path(__file__).with_name("grammar.lark").read_text(encoding="utf-8")
    keywords = sorted(set(_KEYWORD.findall(text)))
    terminals = "".join(map(_keyword, keywords))
    return Lark(
        _KEYWORD.sub(lambda match: f"_{match[1].upper()}", text) + _TERMINALS + terminals,
        parser="lalr",
        start="chronicle_file",
        propagate_positions=True,
        maybe_placeholders=True,
        lexer_callbacks=dict.fromkeys(("MINUS", "ORDER", "EQUALITY"), _in_ascii),
    )


def _keyword(word: str) -> str:
    """Return the terminal of a word."""
    if word in _MAY_BE_NAMES:
        return rf"_{word.upper()}.2: /{word}(?!\w){_NO_NAME}/" + "\n"
    return rf"_{word.upper()}: /{word}(?!\w)/" + "\n"


def _in_ascii(token: Token) -> Token:
    """Return a sign as it is written without special characters."""
    plain = _IN_ASCII.get(token)
    return token if plain is None else token.update(value=plain)


class _Pieces(Transformer[Token, Any]):
    """The rules that are no class of their own: names, lists, numbers, what is computed.

    Attributes:
        faults: Of numbers and intervals.
    """

    def __init__(self, source: SourceText, values: Values) -> None:
        super().__init__()
        self._source = source
        self._values = values
        self.faults: list[SpecificationError] = []

    def dotted_name(self, names: list[Token]) -> str:
        return ".".join(names)

    def constant(self, tokens: list[Token]) -> str:
        (token,) = tokens
        return token[1:-1] if token.type == "STRING" else str(token)

    def parameters(self, items: list[Any]) -> tuple[Any, ...]:
        return tuple(item for item in items if item is not None)

    conditions = arguments = bindings = terms = parameters

    def statements(self, items: list[Any]) -> tuple[Any, ...]:
        return tuple(self._values.stated(item) for item in items)

    constraints = statements

    def instants(self, names: list[Token | None]) -> tuple[str, ...]:
        return tuple(str(name) for name in names if name is not None)

    def points(self, items: list[Any]) -> tuple[Any, ...]:
        return tuple(item for item in items if item is not None)

    def amount(self, tokens: list[Token | None]) -> Amount:
        sign, number = tokens
        assert number is not None
        span = _span_of_token(self._source, number)
        if sign is not None:
            span = Span(self._source, _span_of_token(self._source, sign).start, span.end)
        try:
            return amount_from(f"{sign or ''}{number}", span)
        except SpecificationError as error:
            self.faults.append(error)
            return syntax.Number(span, 1)

    def count(self, tokens: list[Token]) -> int:
        (token,) = tokens
        if token.type == "NAME":
            return self._values.count(token, token.start_pos or 0)
        return int(token)

    def limit(self, tokens: list[Token]) -> int | None:
        return self.count(tokens) if tokens else None

    def named(self, tokens: list[Token]) -> Duration:
        return self._duration(tokens[0])

    def signed(self, tokens: list[Token | None]) -> Duration:
        sign, number = tokens
        assert number is not None
        duration = self._duration(number)
        return Duration(-duration) if sign == "-" else duration

    def offset(self, tokens: list[Token]) -> Duration:
        terms = [self.signed([*pair]) for pair in zip(tokens[::2], tokens[1::2], strict=True)]
        total = Duration(sum(terms))
        if len(terms) > 1 and abs(total) > LONGEST:
            self._complain("the sum of these lengths is longer than nine years", tokens[0])
        return total

    def no_lower_limit(self, _sign: list[Token]) -> None:
        return None

    no_upper_limit = no_lower_limit

    @v_args(meta=True)
    def fixed(self, meta: Meta, items: list[Any]) -> syntax.Instant:
        """Read `t1 + [5, 5]`; what is not at a fixed distance can only be compared."""
        name, interval = items
        span = Span(self._source, meta.start_pos, meta.end_pos)
        if interval.lower is None or interval.lower != interval.upper:
            message = "expected an instant at a fixed distance from another, such as 't1 + 5'"
            found = self._source.text[span.start : span.end]
            self.faults.append(ChronicleSyntaxError(f"{message}, found '{found}'", span))
            return syntax.Instant(span, str(name), Duration(0))
        return syntax.Instant(span, str(name), interval.lower)

    def interval_negated(self, items: list[Any]) -> Interval:
        _sign, interval = items
        return negated(interval)

    def interval_shifted(self, items: list[Any]) -> Interval:
        interval, sign, number = items
        shift = self.signed([sign, number])
        return sum_of(interval, Interval(interval.span, shift, shift))

    def interval_sum(self, items: list[Any]) -> Interval:
        left, sign, right = items
        return sum_of(left, negated(right) if sign == "-" else right)

    def displacement(self, items: list[Any]) -> Interval:
        sign, interval = items
        return negated(interval) if sign == "-" else interval

    displacement_shifted = interval_shifted
    displacement_sum = interval_sum

    def interval_intersection(self, items: list[Any]) -> Interval:
        left, right = items
        found = intersection_of(left, right)
        if is_empty(found):
            self.faults.append(ChronicleSyntaxError("these intervals share nothing", left.span))
        return found

    def interval_union(self, items: list[Any]) -> Interval:
        left, right = items
        shared = intersection_of(left, right)
        if is_empty(shared, by=MILLISECOND):
            message = "these intervals leave a gap and have no interval as their union"
            self.faults.append(ChronicleSyntaxError(message, left.span))
        return union_of(left, right)

    @v_args(meta=True)
    def non_membership(self, meta: Meta, items: list[Any]) -> syntax.Negation:
        span = Span(self._source, meta.start_pos, meta.end_pos)
        return syntax.Negation(span, syntax.Membership(span, *items))

    def _complain(self, message: str, token: Token) -> None:
        self.faults.append(ChronicleSyntaxError(message, _span_of_token(self._source, token)))

    def _duration(self, token: Token) -> Duration:
        if token.type == "NAME":
            return self._values.length(token, token.start_pos or 0)
        try:
            return length_from(token, _span_of_token(self._source, token))
        except SpecificationError as error:
            self.faults.append(error)
            return MILLISECOND


def _transformer(source: SourceText, pieces: _Pieces) -> Transformer[Token, Any]:
    transformer: Transformer[Token, Any] = create_transformer(
        syntax, pieces, decorator_factory=lambda **_: v_args(wrapper=_spanned(source))
    )
    return transformer


def _spanned(source: SourceText) -> Callable[..., Any]:
    def make(node: Callable[..., Any], data: str, children: list[Any], meta: Meta) -> Any:
        span = Span(source, 0, 0) if meta.empty else Span(source, meta.start_pos, meta.end_pos)
        arrange = ARRANGEMENTS.get(str(data))
        return node(span, *(arrange(children) if arrange else map(plain, children)))

    return make


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
    else:
        token = error.token  # type: ignore[attr-defined]  # UnexpectedToken or UnexpectedEOF
        at_end = Span(source, len(source.text.rstrip()), len(source.text.rstrip()))
        is_end = isinstance(error, UnexpectedEOF) or token.type == "$END"
        span = at_end if is_end else _span_of_token(source, token)
    expected = alternatives(_accepted(error), _pattern_by_name())
    found = source.text[span.start : span.end]
    message = f"expected {listed(expected)}, found {described(found)}"
    nearest = nearest_name(found, (word.strip("'") for word in expected))
    hint = f"; did you mean '{nearest}'?" if nearest and nearest != found else ""
    return ChronicleSyntaxError(message + hint, span)


def _accepted(error: UnexpectedInput) -> frozenset[str]:
    """Return the terminals that could have come instead."""
    if isinstance(error, UnexpectedCharacters):
        return frozenset(error.allowed or ())
    return frozenset(getattr(error, "accepts", None) or getattr(error, "expected", None) or ())


def _word_at(source: SourceText, start: int) -> Span:
    end = start + 1
    while source.text[start : end + 1].isidentifier() and end < len(source.text):
        end += 1
    return Span(source, start, end)


def _pattern_by_name() -> dict[str, str]:
    return {terminal.name: terminal.pattern.value for terminal in _grammar().terminals}

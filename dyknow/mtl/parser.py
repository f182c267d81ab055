"""From the text of a formula, or of a file of one, to its syntax."""

import json
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Any

from lark import Lark, Token, UnexpectedCharacters, UnexpectedInput, UnexpectedToken, v_args
from lark.exceptions import VisitError
from lark.tree import Meta
from lark.visitors import Transformer_NonRecursive

from dyknow.errors import FormulaSyntaxError
from dyknow.mtl import syntax
from dyknow.mtl.syntax import (
    TOO_DEEP,
    Declaration,
    Document,
    FeatureDeclaration,
    Formula,
    Interval,
    Node,
    ObjectDeclaration,
    SortDeclaration,
    Term,
    too_deep,
)
from dyknow.source_text import SourceText, Span
from dyknow.time import duration_from_text

__all__ = ["parse_document", "parse_formula"]


def parse_formula(text: str, source_name: str = "<formula>") -> Formula:
    """Read a formula, such as `always (p -> eventually [0, 1000] speed[car1] < 3)`.

    Args:
        text: The formula.
        source_name: How messages refer to the text.

    Raises:
        FormulaSyntaxError: The text is not a formula; its span says where.
    """
    (node,) = _parsed(text, source_name, "start").children
    _forbid_deep_nesting(node)
    return _formula(node)


def parse_document(text: str, source_name: str = "<formula>") -> Document:
    """Read a formula with declarations of the sorts, objects and features before it, if any.

    Args:
        text: The declarations and the formula.
        source_name: How messages refer to the text.

    Raises:
        FormulaSyntaxError: The text does not follow the grammar; its span says where.
    """
    *declarations, node = _parsed(text, source_name, "document").children
    _forbid_deep_nesting(node)
    return Document(tuple(declarations), _formula(node))


def _parsed(text: str, source_name: str, start: str) -> Any:
    source = SourceText(source_name, text)
    try:
        return _Builder(source).transform(_grammar().parse(text, start=start))
    except UnexpectedInput as error:
        raise _syntax_error(error, source) from None
    except VisitError as error:
        raise error.orig_exc from None


@cache
def _grammar() -> Lark:
    text = files("dyknow.mtl").joinpath("grammar.lark").read_text(encoding="utf-8")
    return Lark(
        text,
        parser="lalr",
        start=["start", "document"],
        propagate_positions=True,
        maybe_placeholders=False,
    )


def _formula(node: Node) -> Formula:
    """Return *node* if it is a formula."""
    match node:
        case syntax.Number() | syntax.Text() | syntax.Arithmetic() | syntax.Minus():
            raise FormulaSyntaxError(f"expected a formula, found {_kind(node)}", node.span)
        case _:
            return node


def _term(node: Node) -> Term:
    """Return *node* if it is a term."""
    match node:
        case (
            syntax.Truth() | syntax.Number() | syntax.Text() | syntax.Feature()
            | syntax.Arithmetic() | syntax.Minus()
        ):  # fmt: skip
            return node
        case _:
            raise FormulaSyntaxError(f"expected a term, found {_kind(node)}", node.span)


def _kind(node: Node) -> str:
    match node:
        case syntax.Number() | syntax.Arithmetic() | syntax.Minus():
            return "a number"
        case syntax.Text():
            return "a text"
        case _:
            return "a formula"


@v_args(inline=True, meta=True)
class _Builder(Transformer_NonRecursive[Token, Any]):
    """One method for each rule; each hands the span of what was read to the class of the rule."""

    def __init__(self, source: SourceText) -> None:
        super().__init__()
        self._source = source

    def _span(self, meta: Meta) -> Span:
        return Span(self._source, meta.start_pos, meta.end_pos)

    def sort(self, meta: Meta, name: syntax.Name, *objects: syntax.Name) -> Declaration:
        return SortDeclaration(name, objects, span=self._span(meta))

    def objects(self, meta: Meta, *names: syntax.Name) -> Declaration:
        *objects, sort = names
        return ObjectDeclaration(tuple(objects), sort, span=self._span(meta))

    def feature_signature(self, meta: Meta, name: syntax.Name, *sorts: syntax.Name) -> Declaration:
        *parameters, sort = sorts
        return FeatureDeclaration(name, tuple(parameters), sort, span=self._span(meta))

    def equivalence(self, meta: Meta, left: Node, right: Node) -> Formula:
        return syntax.Equivalence(_formula(left), _formula(right), span=self._span(meta))

    def implication(self, meta: Meta, left: Node, right: Node) -> Formula:
        return syntax.Implication(_formula(left), _formula(right), span=self._span(meta))

    def disjunction(self, meta: Meta, *bodies: Node) -> Formula:
        return syntax.Disjunction(tuple(map(_formula, bodies)), span=self._span(meta))

    def conjunction(self, meta: Meta, *bodies: Node) -> Formula:
        return syntax.Conjunction(tuple(map(_formula, bodies)), span=self._span(meta))

    def until(self, meta: Meta, left: Node, *rest: Any) -> Formula:
        *within, right = rest
        interval = within[0] if within else syntax.ALWAYS_HENCEFORTH
        return syntax.Until(interval, _formula(left), _formula(right), span=self._span(meta))

    def negation(self, meta: Meta, body: Node) -> Formula:
        return syntax.Negation(_formula(body), span=self._span(meta))

    def always(self, meta: Meta, *rest: Any) -> Formula:
        *within, body = rest
        interval = within[0] if within else syntax.ALWAYS_HENCEFORTH
        return syntax.Always(interval, _formula(body), span=self._span(meta))

    def eventually(self, meta: Meta, *rest: Any) -> Formula:
        *within, body = rest
        interval = within[0] if within else syntax.ALWAYS_HENCEFORTH
        return syntax.Eventually(interval, _formula(body), span=self._span(meta))

    def for_all(
        self, meta: Meta, variable: syntax.Name, domain: syntax.Name, body: Node
    ) -> Formula:
        return syntax.ForAll(variable, domain, _formula(body), span=self._span(meta))

    def exists(
        self, meta: Meta, variable: syntax.Name, domain: syntax.Name, body: Node
    ) -> Formula:
        return syntax.Exists(variable, domain, _formula(body), span=self._span(meta))

    def comparison(self, meta: Meta, left: Node, operator: Token, right: Node) -> Formula:
        sign = {"==": "=", "≤": "<=", "≥": ">=", "≠": "!="}.get(operator, str(operator))
        return syntax.Comparison(_term(left), sign, _term(right), span=self._span(meta))

    def arithmetic(self, meta: Meta, left: Node, operator: Token, right: Node) -> Term:
        sign = "*" if operator == "·" else str(operator)
        return syntax.Arithmetic(_term(left), sign, _term(right), span=self._span(meta))

    def minus(self, meta: Meta, body: Node) -> Term:
        return syntax.Minus(_term(body), span=self._span(meta))

    def true(self, meta: Meta) -> Formula:
        return syntax.Truth(value=True, span=self._span(meta))

    def false(self, meta: Meta) -> Formula:
        return syntax.Truth(value=False, span=self._span(meta))

    def number(self, meta: Meta, digits: Token) -> Term:
        try:
            return syntax.Number(float(digits), span=self._span(meta))
        except ValueError as error:
            raise FormulaSyntaxError(str(error), self._span(meta)) from None

    def text(self, meta: Meta, quoted: Token) -> Term:
        try:
            return syntax.Text(json.loads(quoted), span=self._span(meta))
        except ValueError:
            message = f"expected a text with the escapes of JSON, found {quoted}"
            raise FormulaSyntaxError(message, self._span(meta)) from None

    def feature(self, meta: Meta, name: Token, *arguments: syntax.Argument) -> Term:
        return syntax.Feature(str(name), arguments, span=self._span(meta))

    def name(self, meta: Meta, name: Token) -> syntax.Name:
        return syntax.Name(str(name), span=self._span(meta))

    def interval(self, meta: Meta, start: Token, end: Token | None = None) -> Interval:
        try:
            longest = None if end is None else duration_from_text(str(end))
            return Interval(duration_from_text(str(start)), longest, span=self._span(meta))
        except ValueError as error:
            raise FormulaSyntaxError(str(error), self._span(meta)) from None


def _forbid_deep_nesting(node: Node) -> None:
    deep = too_deep(node)
    if deep is not None:
        raise FormulaSyntaxError(TOO_DEEP, deep.span)


def _syntax_error(error: UnexpectedInput, source: SourceText) -> FormulaSyntaxError:
    """Say what was expected and what was found, in the words of a reader."""
    end = len(source.text)
    match error:
        case UnexpectedToken(token=Token(type="$END")):
            last = len(source.text.rstrip())
            return _expected(error.accepts or error.expected, "the end", Span(source, last, end))
        case UnexpectedToken(token=Token() as token):
            at = Span(source, token.start_pos or 0, token.end_pos or end)
            return _expected(error.accepts or error.expected, f"'{token}'", at)
        case UnexpectedCharacters():
            offset: Any = error.pos_in_stream
            found = f"'{source.text[offset]}'"
            # Which bracket is open is known to the parser, not to the reader of characters.
            return _expected(
                set(error.allowed) - {"RPAR"}, found, Span(source, offset, offset + 1)
            )
        case _:
            return FormulaSyntaxError(f"expected a formula: {error}", Span(source, 0, end))


def _expected(terminals: Iterable[str], found: str, at: Span) -> FormulaSyntaxError:
    return FormulaSyntaxError(f"expected {_words(set(terminals))}, found {found}", at)


_KINDS = (
    ("NOT", "a formula"),
    ("MINUS", "a term"),
    ("COMPARISON", "an operator"),
    ("AND", "an operator"),
    ("DURATION", "a duration such as '200' or '1.5 s'"),
    ("_INFINITY", "'oo'"),
    ("LSQB", "an interval"),
    ("NUMBER", "an argument"),
    ("NAME", "a name"),
    ("IN", "'in'"),
    ("COMMA", "','"),
    ("COLON", "':'"),
    ("RPAR", "')'"),
    ("RSQB", "']'"),
    ("$END", "the end"),
)
"""What to call a place in a formula, by a terminal that tells it; the first match speaks for all
terminals that can begin the same thing."""

_SPOKEN_FOR = {
    "NOT": {"MINUS", "NUMBER", "NAME", "COMPARISON"},
    "MINUS": {"NUMBER", "NAME"},
    "COMPARISON": {"AND", "LSQB"},
    "AND": {"LSQB"},
    "NUMBER": {"NAME"},
}


def _words(terminals: set[str]) -> str:
    """Return the terminals as a list of alternatives that a person can read."""
    words: list[str] = []
    for terminal, word in _KINDS:
        if terminal in terminals:
            words.append(word)
            terminals -= _SPOKEN_FOR.get(terminal, set())
    return " or ".join(words) or "a formula"

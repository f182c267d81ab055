"""Going on behind a syntax fault: what to leave out so that the rest can be read.

The outline of a text is found without its grammar: declarations begin with a keyword outside of
blocks, statements with a keyword, at the beginning of a line, or behind `;`.
"""

import re
from bisect import bisect_right
from itertools import pairwise

__all__ = ["MAX_DEPTH", "Outline"]

MAX_DEPTH = 50
"""How many brackets, and negations, may be inside one another."""

_PIECES = re.compile(
    r'"[^"\n]*"'
    r"|(?:\#|//)[^\n]*"
    r"|(?P<declaration>\b(?:attribute|constraint|domain|message)\b|^chronicle\b"
    r"|^[ \t]*parameter(?=\s+\w+\s*=))"
    r"|(?P<statement>\b(?:chronicle|event|instant|noevent|occurs|report|variable)\b)"
    r"|(?P<line>^(?![ \t]*\}))"
    r"|(?P<mark>[{}()\[\];])",
    re.MULTILINE,
)
_DOMAIN = re.compile(r"=[^{}]*")


class Outline:
    """Where declarations and statements of a text begin.

    Attributes:
        too_deep: Where a bracket stands inside too many others, if one does.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._declarations = [0]
        self._statements: list[int] = []
        self._depth = 0
        self._in_block = False
        self.too_deep: int | None = None
        for piece in _PIECES.finditer(text):
            match piece.lastgroup:
                case "declaration":
                    self._declare(piece.start())
                case "statement":
                    self._state(piece[0], piece.start())
                case "line" if self._in_block and self._depth == 0:
                    self._statements.append(piece.start())
                case "mark":
                    self._mark(piece[0], piece.start())
                case _:
                    pass
        self._declarations.append(len(text))

    def faulty_parts(
        self, at: int, *, in_block: bool, between: bool
    ) -> tuple[tuple[int, int], ...]:
        """Return the stretches one of which to leave out because of a fault at *at*.

        The first of them with anything in it is meant. A fault where a statement or declaration
        begins is one of what comes before, which has not ended, unless a new one was accepted.

        Args:
            at: Offset of the fault.
            in_block: Whether a statement was accepted there.
            between: Whether a declaration was accepted there.
        """
        first, last = self._declaration(at)
        before = self._declaration(max(first - 1, 0))
        starts = [start for start in self._statements if first < start < last]
        place = bisect_right(starts, at)
        if place == 0:
            is_unfinished = in_block or (not between and not self._text[first:at].strip())
            return (before, (first, last)) if is_unfinished else ((first, last),)
        start, end = starts[place - 1], starts[place] if place < len(starts) else last
        if in_block or self._text[start:at].strip():
            return (start, end), (first, last)
        earlier = [(one, other) for one, other in pairwise(starts[:place])]
        return (*reversed(earlier), (start, end), (first, last))

    def _declare(self, at: int) -> None:
        self._declarations.append(at)
        self._depth = 0
        self._in_block = False

    def _state(self, keyword: str, at: int) -> None:
        if self._in_block:
            self._statements.append(at)
            self._depth = 0
        elif keyword == "chronicle":
            self._declare(at)

    def _mark(self, mark: str, at: int) -> None:
        if mark == ";" or self._is_edge_of_block(mark, at):
            self._statements.append(at if mark == "}" else at + 1)
            self._depth = 0
            self._in_block = mark == "{" or (mark == ";" and self._in_block)
        elif mark in "{([":
            self._depth += 1
            if self._depth > MAX_DEPTH and self.too_deep is None:
                self.too_deep = at
        else:
            self._depth = max(0, self._depth - 1)

    def _is_edge_of_block(self, mark: str, at: int) -> bool:
        if mark == "{":
            head = self._text[self._declarations[-1] : at]
            return not self._in_block and _DOMAIN.search(head) is None
        return mark == "}" and self._in_block and self._depth == 0

    def _declaration(self, at: int) -> tuple[int, int]:
        """Return the stretch of the declaration around *at*."""
        place = min(bisect_right(self._declarations, at), len(self._declarations) - 1)
        return self._declarations[place - 1], self._declarations[place]

"""Going on behind a syntax fault: where the next declaration begins, and what was lost.

The outline of a text is found without its grammar: declarations begin with a keyword that is
never a name, or with `for each` at the beginning of a line; strings and comments are passed over.
"""

import re
from bisect import bisect_left
from collections.abc import Iterator

__all__ = ["MAX_DEPTH", "Outline"]

MAX_DEPTH = 50
"""How many brackets may be inside one another."""

_PIECES = re.compile(
    r"""(?P<text>"(?:[^"\\\n]|\\.)*")"""
    r"|(?P<comment>\#[^\n]*)"
    r"|(?P<start>\b(?:compunit|parameter|source|stream|strmgen)\b|^[ \t]*for\s+each\b)"
    r"|(?P<open>[(\[{])|(?P<close>[)\]}])",
    re.MULTILINE,
)
_DECLARED = re.compile(
    r"(?:strmgen|stream|parameter)\s+(\w+)|(?:source|compunit)\s+\w+\s*(?:\([^)]*\))?\s*(\w+)"
)


class Outline:
    """Where the declarations and the blocks of a text begin and end.

    Attributes:
        too_deep: Where a bracket stands inside too many others, if one does.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts: list[int] = []
        self._braces: list[tuple[int, str]] = []
        self.too_deep: int | None = None
        depth = 0
        for piece in _PIECES.finditer(text):
            match piece.lastgroup:
                case "start":
                    self._starts.append(piece.end() - len(piece[0].lstrip(" \t")))
                case "open":
                    depth += 1
                    if depth > MAX_DEPTH and self.too_deep is None:
                        self.too_deep = piece.start()
                case "close":
                    depth = max(0, depth - 1)
                case _:
                    pass
            if piece[0] in "{}":
                self._braces.append((piece.start(), piece[0]))
        ends = [at for at, brace in self._braces if brace == "}"]
        self._resumptions = sorted([*self._starts, *ends])

    def next_resumption(self, at: int) -> int:
        """Return where the first declaration or end of a block from *at* on is."""
        found = bisect_left(self._resumptions, at)
        return self._resumptions[found] if found < len(self._resumptions) else len(self._text)

    def count_openings(self, start: int, end: int) -> int:
        """Return how many blocks open between two places."""
        return sum(brace == "{" for at, brace in self._braces if start <= at < end)

    def names_declared(self, start: int, end: int) -> Iterator[str]:
        """Yield the names that the declarations around a stretch of the text seem to declare."""
        first = max(0, bisect_left(self._starts, start) - 1)
        for at in self._starts[first : bisect_left(self._starts, end)]:
            declared = _DECLARED.match(self._text, at)
            if declared is not None:
                yield declared[1] or declared[2]

"""What people write about chronicles in comments, for those who look them up.

The comment that ends on the line before a declaration is about that declaration. The comment at
the top of a file is about the whole file.
"""

import re
from collections.abc import Iterable, Iterator
from itertools import takewhile

from chronicles.syntax import Chronicle, ChronicleFile

__all__ = ["comment_of", "heading_of"]

_COMMENT = re.compile(r"\s*(?:#+|//+) ?(?P<words>.*)")


def comment_of(chronicle: Chronicle) -> str:
    """Return the comment right before *chronicle*, without its marks; empty if there is none."""
    span = chronicle.span
    *lines, indent = span.source.text[: span.start].split("\n")
    if indent.strip():
        return ""
    return "\n".join(reversed([*_words(reversed(lines))])).strip()


def heading_of(file: ChronicleFile) -> str:
    """Return the comment at the top of *file*, without its marks; empty if there is none."""
    return "\n".join(_words(file.span.source.text.lstrip().split("\n"))).strip()


def _words(lines: Iterable[str]) -> Iterator[str]:
    """Yield what the comments among *lines* say, up to the first that is none."""
    for found in takewhile(bool, map(_COMMENT.fullmatch, lines)):
        if found is not None:
            yield found["words"].rstrip()

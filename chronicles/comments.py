"""What people write about chronicles in comments, for those who look them up.

The comment that ends on the line before a declaration is about that declaration, and so is one
behind a parameter. The comment at the top of a file is about the whole file.
"""

import re
from collections.abc import Iterable, Iterator
from itertools import takewhile

from chronicles.syntax import Chronicle, ChronicleFile, ParameterDeclaration

__all__ = ["comment_of", "heading_of", "remark_on"]

_COMMENT = re.compile(r"\s*(?:#+|//+) ?(?P<words>.*)")


def comment_of(declaration: Chronicle | ParameterDeclaration) -> str:
    """Return the comment right before a declaration, without its marks; empty if there is none."""
    span = declaration.span
    *lines, indent = span.source.text[: span.start].split("\n")
    if indent.strip():
        return ""
    return "\n".join(reversed([*_words(reversed(lines))])).strip()


def remark_on(parameter: ParameterDeclaration) -> str:
    """Return the comment behind *parameter*, or else the one right before it."""
    span = parameter.span
    rest, _, _ = span.source.text[span.end :].partition("\n")
    return next(_words([rest]), "") or comment_of(parameter)


def heading_of(file: ChronicleFile) -> str:
    """Return the comment at the top of *file*, without its marks; empty if there is none."""
    return "\n".join(_words(file.span.source.text.lstrip().split("\n"))).strip()


def _words(lines: Iterable[str]) -> Iterator[str]:
    """Yield what the comments among *lines* say, up to the first that is none."""
    for found in takewhile(bool, map(_COMMENT.fullmatch, lines)):
        if found is not None:
            yield found["words"].rstrip()

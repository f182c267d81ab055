"""Where each key of a TOML text stands, which the standard library's reader does not tell.

The text is known to be valid TOML when it comes here, so a scan for headers and keys is enough.
Keys inside inline tables are found; elements of an array that are not tables have the place of
the array.
"""

import re
from collections.abc import Iterator, Mapping

from dyknow.source_text import SourceText, Span

__all__ = ["KeyPath", "places_of_keys", "span_of"]

KeyPath = tuple[str | int, ...]
"""Keys from the root inwards; a number counts the tables of an array, from 0."""

_HEADER = re.compile(r"[ \t]*(\[\[?)[ \t]*([^\[\]\n]+?)[ \t]*\]\]?")
_NAME = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_KEY = re.compile(rf"[ \t]*({_NAME}(?:[ \t]*\.[ \t]*{_NAME})*)[ \t]*=")
_PART = re.compile(_NAME)
_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'|#[^\n]*|[\[\]{}\n]',
    re.DOTALL,
)
_INLINE_KEY = re.compile(rf"[{{,]\s*({_NAME})\s*=")


def places_of_keys(source: SourceText) -> dict[KeyPath, Span]:
    """Return the span of each key and of each table's header, by its path."""
    places: dict[KeyPath, Span] = {}
    tables: dict[KeyPath, int] = {}
    prefix: KeyPath = ()
    for start, end in _statements(source.text):
        statement = source.text[start:end]
        if header := _HEADER.match(statement):
            prefix = _path_of_header(_parts(header[2]), tables, is_array=header[1] == "[[")
            places.setdefault(prefix, Span(source, start + header.start(1), start + header.end()))
        elif key := _KEY.match(statement):
            path = (*prefix, *_parts(key[1]))
            places[path] = Span(source, start + key.start(1), start + key.end(1))
            for inner in _INLINE_KEY.finditer(statement, key.end()):
                span = Span(source, start + inner.start(1), start + inner.end(1))
                places.setdefault((*path, *_parts(inner[1])), span)
    return places


def span_of(path: KeyPath, places: Mapping[KeyPath, Span], source: SourceText) -> Span:
    """Return the place of *path*, or of the nearest table around it that is written down."""
    for length in range(len(path), 0, -1):
        if path[:length] in places:
            return places[path[:length]]
    return Span(source, 0, 0)


def _statements(text: str) -> Iterator[tuple[int, int]]:
    """Yield start and end of each statement: a line, or more if brackets or strings go on."""
    start = depth = 0
    for token in _TOKEN.finditer(text):
        match token[0]:
            case "[" | "{":
                depth += 1
            case "]" | "}":
                depth -= 1
            case "\n" if depth <= 0:
                yield start, token.start()
                start, depth = token.end(), 0
            case _:
                pass
    yield start, len(text)


def _parts(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip("\"'") for part in _PART.findall(dotted))


def _path_of_header(
    parts: tuple[str, ...], tables: dict[KeyPath, int], *, is_array: bool
) -> KeyPath:
    """Return the path of a header, with the number of the newest table of each array in it."""
    path: KeyPath = ()
    for part in parts[:-1]:
        path = (*path, part)
        if path in tables:
            path = (*path, tables[path])
    path = (*path, parts[-1])
    if is_array:
        tables[path] = tables.get(path, -1) + 1
        path = (*path, tables[path])
    return path

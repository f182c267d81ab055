"""What can be said of a line of JSON: where its values are, and what is wrong with it.

Reading a line is one call of `pydantic_core.from_json`; all of this is only needed for faults.
"""

import json
import re
from collections.abc import Iterator
from typing import NamedTuple, NoReturn

from traffic.errors import LineError
from traffic.reading.lines import Lines
from traffic.reading.times import described

__all__ = ["columns_in", "forbid_repetition", "refuse"]

_FAULT = re.compile(r"(?P<what>.*) at line \d+ column (?P<column>\d+)", re.DOTALL)
_TOKEN = re.compile(r'[{}\[\]]|(?P<key>"(?:[^"\\]|\\.)*")\s*:\s*|"(?:[^"\\]|\\.)*"')
_NO_NUMBER = re.compile(rb"NaN|-?Infinity")


def refuse(lines: Lines, error: ValueError, what_it_is: str) -> NoReturn:
    """Say what is wrong with the present line, which is not JSON.

    Args:
        lines: The lines.
        error: What `from_json` said.
        what_it_is: What the line should be, for instance `state`.
    """
    match = _FAULT.fullmatch(str(error))
    at = max(0, int(match["column"]) - 1) if match else 0
    what = match["what"] if match else str(error)
    if lines.is_cut_off and what.startswith("EOF"):
        place = lines.place(lines.column(len(lines.line)))
        raise LineError(place, f"the rest of the {what_it_is}", "the end of the file") from None
    text = lines.text()
    begin = text.lstrip()
    if begin[0] not in "{[":
        place = lines.place(len(text) - len(begin) + 1)
        raise LineError(place, "an object of JSON", described(begin)) from None
    number = _NO_NUMBER.match(lines.line, max(0, at - 1)) or _NO_NUMBER.match(lines.line, at)
    if number is not None:
        place, found = lines.place(lines.column(number.start())), number[0].decode()
        raise LineError(place, "a finite number", found) from None
    place = lines.place(lines.column(at))
    raise LineError(place, "an object of JSON", f"a fault in it ({what})") from None


def forbid_repetition(lines: Lines) -> None:
    """Look for a name that stands twice in an object of the present line.

    Raises:
        LineError: One does.
    """
    seen: set[tuple[str, int]] = set()
    for name, column, inside in _keys_in(lines.text()):
        if (name, inside) in seen:
            raise LineError(lines.place(column), f"'{name}' once", "it twice")
        seen.add((name, inside))


def columns_in(lines: Lines, outer: str | None = None) -> dict[str, int]:
    """Return where the value of each name is in the present line's object.

    Args:
        lines: The lines.
        outer: If given, look into the object that is the value of this name instead.
    """
    keys = list(_keys_in(lines.line.decode("utf-8", "replace")))
    columns = {key.name: key.column for key in keys if key.inside == 1}
    if outer is None:
        return columns
    return {key.name: key.column for key in keys if key.inside == columns.get(outer)}


class _Key(NamedTuple):
    """A name in a line of JSON.

    Attributes:
        name: The name.
        column: Where its value begins, from 1.
        inside: Where the object begins that it belongs to; of the line's own object, 1.
    """

    name: str
    column: int
    inside: int


def _keys_in(text: str) -> Iterator[_Key]:
    """Yield each name of an object in a line of JSON."""
    opened: list[int] = []
    for token in _TOKEN.finditer(text):
        match token[0][0]:
            case "{" | "[":
                opened.append(token.start() + 1 if opened else 1)
            case "}" | "]":
                opened.pop()
            case _ if token["key"] is not None:
                name = json.loads(token["key"], strict=False)
                yield _Key(name, token.end() + 1, opened[-1])
            case _:
                pass

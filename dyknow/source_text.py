"""Places in a text that a person wrote, and an excerpt that points at one."""

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property

__all__ = ["MADE_IN_PYTHON", "SourceText", "Span", "did_you_mean", "nearest_are", "nearest_name"]


@dataclass(frozen=True)
class SourceText:
    """A text with the name by which its reader knows it, usually a path.

    Attributes:
        name: How messages refer to the text.
        text: The whole text.
    """

    name: str
    text: str

    @cached_property
    def _line_starts(self) -> list[int]:
        starts = [0]
        starts.extend(at + 1 for at, character in enumerate(self.text) if character == "\n")
        return starts

    def place(self, offset: int) -> tuple[int, int]:
        """Return line and column of the character at *offset*, both counted from 1."""
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1

    def line(self, number: int) -> str:
        """Return line *number*, counted from 1, without its end."""
        start = self._line_starts[number - 1]
        end = self.text.find("\n", start)
        return self.text[start:] if end < 0 else self.text[start:end]


@dataclass(frozen=True)
class Span:
    """A stretch of a text, from `start` up to but not including `end`.

    Attributes:
        source: The text.
        start: Offset of the first character.
        end: Offset behind the last character.
    """

    source: SourceText
    start: int
    end: int

    @property
    def place(self) -> str:
        """Where the stretch begins, as `name:line:column`."""
        line, column = self.source.place(self.start)
        return f"{self.source.name}:{line}:{column}"

    def excerpt(self) -> str:
        """Return the line on which the stretch begins, and carets under it."""
        number, column = self.source.place(self.start)
        line = self.source.line(number)
        width = max(1, min(self.end - self.start, len(line) - column + 1))
        indent = "".join("\t" if c == "\t" else " " for c in line[: column - 1])
        return f"{line}\n{indent}{'^' * width}"


MADE_IN_PYTHON = Span(SourceText("<python>", ""), 0, 0)
"""The place of everything that was not written as text."""


def nearest_name(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that a person most probably meant by *name*, if any is close."""
    close = get_close_matches(name, list(known), n=1, cutoff=0.6)
    return close[0] if close else None


def did_you_mean(nearest: str | None) -> str:
    """Return what to add to a message about an unknown name, given the nearest known one."""
    return f"; did you mean '{nearest}'?" if nearest else ""


def nearest_are(labels: Sequence[str]) -> str:
    """Return what to add to a message about an unknown label, given the nearest known ones."""
    if not labels:
        return ""
    verb = "are" if len(labels) > 1 else "is"
    return f"; nearest {verb} " + ", ".join(f"'{label}'" for label in labels)

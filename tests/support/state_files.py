"""States in memory, read as from a file that comes in pieces."""

import io
from collections.abc import Sequence

from traffic.monitoring.opening import read_states
from traffic.monitoring.questions import Question, read_question
from traffic.monitoring.states import StateReader

__all__ = ["Pieces", "asked", "reader_of", "states_in"]


class Pieces(io.BytesIO):
    """Bytes of which few come at a time; counts how many were asked for."""

    def __init__(self, content: bytes, size: int = 1 << 20) -> None:
        super().__init__(content)
        self.size = size

    def read1(self, size: int | None = -1) -> bytes:
        """Return the next few bytes."""
        del size
        return super().read1(self.size)


def asked(formula: str, **domains: Sequence[str]) -> Question:
    """Return a question."""
    return read_question(formula, domains)


def reader_of(
    text: str | bytes, formula: str = "p", ending: str = "", size: int = 1 << 20
) -> StateReader:
    """Return a reader of the states in a text, for what a formula needs."""
    content = text.encode() if isinstance(text, str) else text
    return read_states(Pieces(content, size), "states", asked(formula).sorts, ending)


def states_in(text: str | bytes, formula: str = "p", ending: str = "", size: int = 1 << 20):
    """Return all states in a text, with the features of the formula."""
    terms = asked(formula).sorts
    return [
        (time, {term: values[term] for term in terms if term in values})
        for time, values in reader_of(text, formula, ending, size)
    ]

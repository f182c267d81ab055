"""States as they are read: what every reader does, whichever the format.

A reader hands out (time, features) and remembers where it is, so that a fault that is found later,
when the formula looks at a value, has its place as well.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any, Protocol

from dyknow.source_text import nearest_name
from dyknow.time import TimePoint
from traffic.errors import LineError
from traffic.reading.times import text_from_time

__all__ = [
    "StateReader",
    "check_order",
    "match_features",
    "missing_feature",
    "printed_feature",
]

_FEATURE = re.compile(r"\s*([^\s\[(]+)\s*(?:\((.*)\)|\[(.*)\])\s*", re.DOTALL)


class StateReader(Protocol):
    """Reads states."""

    @property
    def name(self) -> str:
        """How messages refer to what is read."""

    def __iter__(self) -> Iterator[tuple[TimePoint, Mapping[str, Any]]]:
        """Yield the time of each state and its features, by their printed terms.

        Raises:
            LineError: There is no state, or something is wrong with one.
        """

    def place(self, term: str | None = None) -> str:
        """Return the place of the present state, or of a feature in it."""

    def terms(self) -> Collection[str]:
        """Return the features that are there in the present state, as they are printed."""


def check_order(last: int, now: int, place: str) -> None:
    """Raise a `LineError` unless *now* is a time later than *last*."""
    expected = f"states in order of time, after {text_from_time(last)} ms"
    if now == last:
        raise LineError(place, expected, f"another one at {text_from_time(now)} ms")
    if now < last:
        raise LineError(place, expected, f"one at {text_from_time(now)} ms")


def printed_feature(key: str) -> str:
    """Return a name in a state in the form in which formulas are printed."""
    match = _FEATURE.fullmatch(key)
    if match is None:
        return key.strip()
    name, round_brackets, square_brackets = match.groups()
    inside = square_brackets if round_brackets is None else round_brackets
    return f"{name}({', '.join(argument.strip() for argument in inside.split(','))})"


def match_features(
    terms: Collection[str], keys: Iterable[str]
) -> tuple[dict[str, str], dict[str, tuple[str, str]]]:
    """Find the features of a formula among the names in a state.

    `speed[car1]`, `speed(car1)` and `speed( car1 )` are the same feature.

    Returns:
        Printed term to name, for those that are there; and those that are there twice, with both
        names.
    """
    found: dict[str, str] = {}
    twice: dict[str, tuple[str, str]] = {}
    for key in keys:
        term = printed_feature(key)
        if term in found:
            twice[term] = (found[term], key)
        elif term in terms:
            found[term] = key
    return found, twice


def missing_feature(term: str, keys: Iterable[str]) -> str:
    """Return what is found instead of a feature: nothing, and the nearest name."""
    nearest = nearest_name(term, map(printed_feature, keys))
    return f"none; did you mean '{nearest}'?" if nearest else "none"

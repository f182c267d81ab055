"""States as they are read: what every reader does, whichever the format.

A reader hands out (time, features) and remembers where it is, so that a fault that is found later,
when the formula looks at a value, has its place as well.
"""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from decimal import Decimal, InvalidOperation
from typing import Any, Protocol

from dyknow.source_text import nearest_name
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import StatesError

__all__ = [
    "BEFORE_ALL",
    "LATEST",
    "StateReader",
    "check_order",
    "described",
    "match_features",
    "missing_feature",
    "printed_feature",
    "text_from_time",
    "time_from",
]

LATEST = 1 << 62
"""The greatest time, and with its sign changed the smallest: some 146 years of nanoseconds."""

BEFORE_ALL = -LATEST - 1
"""The time of no state, before those of all."""

_LATEST_ROUNDED = LATEST / MILLISECOND
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|inf", re.ASCII)
_SHOWN = 40
_FEATURE = re.compile(r"\s*([^\s\[(]+)\s*(?:\((.*)\)|\[(.*)\])\s*", re.DOTALL)


class StateReader(Protocol):
    """Reads states."""

    @property
    def name(self) -> str:
        """How messages refer to what is read."""

    def __iter__(self) -> Iterator[tuple[TimePoint, Mapping[str, Any]]]:
        """Yield the time of each state and its features, by their printed terms.

        Raises:
            StatesError: There is no state, or something is wrong with one.
        """

    def place(self, term: str | None = None) -> str:
        """Return the place of the present state, or of a feature in it."""

    def terms(self) -> Collection[str]:
        """Return the features that are there in the present state, as they are printed."""


def time_from(amount: object, place: Callable[[], str]) -> int:
    """Return the time of so many milliseconds, a number or its digits, in nanoseconds.

    Raises:
        StatesError: It is no number, finer than a nanosecond, or too large.
    """
    expected = "a time in milliseconds"
    digits = str(amount)
    if not _NUMBER.fullmatch(digits):
        raise StatesError(place(), expected, described(amount))
    if abs(float(digits)) >= _LATEST_ROUNDED:
        expected = f"a time of at most {LATEST // MILLISECOND} milliseconds"
        raise StatesError(place(), expected, described(amount))
    try:
        exact = Decimal(digits) * MILLISECOND
    except InvalidOperation:  # digits further behind the point than can be counted
        exact = Decimal("0.5")
    if exact != int(exact):
        raise StatesError(place(), "a time in whole nanoseconds", f"{digits} milliseconds")
    return int(exact)


def text_from_time(time: int) -> str:
    """Write a time in milliseconds, exactly."""
    whole, rest = divmod(abs(time), MILLISECOND)
    sign = "-" if time < 0 else ""
    return f"{sign}{whole}.{rest:06d}".rstrip("0").rstrip(".")


def check_order(last: int, now: int, place: str) -> None:
    """Raise a `StatesError` unless *now* is a time later than *last*."""
    expected = f"states in order of time, after {text_from_time(last)} ms"
    if now == last:
        raise StatesError(place, expected, f"another one at {text_from_time(now)} ms")
    if now < last:
        raise StatesError(place, expected, f"one at {text_from_time(now)} ms")


def described(value: object) -> str:
    """Return a value of a state as it is written there, shortened."""
    match value:
        case None | bool():
            return {None: "null", True: "true", False: "false"}[value]
        case str():
            return repr(_shortened(value))
        case list():
            return "an array"
        case dict():
            return "an object"
        case _:
            return _shortened(str(value))


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


def _shortened(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"

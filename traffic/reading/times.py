"""Times and values as they stand in lines, whatever the lines are about."""

import re
from collections.abc import Callable
from decimal import Decimal, InvalidOperation

from dyknow.time import MILLISECOND
from traffic.errors import LineError

__all__ = ["BEFORE_ALL", "LATEST", "described", "text_from_time", "time_from"]

LATEST = 1 << 62
"""The greatest time, and with its sign changed the smallest: some 146 years of nanoseconds."""

BEFORE_ALL = -LATEST - 1
"""The time of nothing, before all others."""

_LATEST_ROUNDED = LATEST / MILLISECOND
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|inf", re.ASCII)
_SHOWN = 40


def time_from(amount: object, place: Callable[[], str]) -> int:
    """Return the time of so many milliseconds, a number or its digits, in nanoseconds.

    Raises:
        LineError: It is no number, finer than a nanosecond, or too large.
    """
    expected = "a time in milliseconds"
    digits = str(amount)
    if not _NUMBER.fullmatch(digits):
        raise LineError(place(), expected, described(amount))
    if abs(float(digits)) >= _LATEST_ROUNDED:
        expected = f"a time of at most {LATEST // MILLISECOND} milliseconds"
        raise LineError(place(), expected, described(amount))
    try:
        exact = Decimal(digits) * MILLISECOND
    except InvalidOperation:  # digits further behind the point than can be counted
        exact = Decimal("0.5")
    if exact != int(exact):
        raise LineError(place(), "a time in whole nanoseconds", f"{digits} milliseconds")
    return int(exact)


def text_from_time(time: int) -> str:
    """Write a time in milliseconds, exactly."""
    whole, rest = divmod(abs(time), MILLISECOND)
    sign = "-" if time < 0 else ""
    return f"{sign}{whole}.{rest:06d}".rstrip("0").rstrip(".")


def described(value: object) -> str:
    """Return a value as it is written in JSON, shortened."""
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


def _shortened(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"

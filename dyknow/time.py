"""Time points and durations in whole nanoseconds, and how people write them.

Inside the program time is an `int` of nanoseconds. In texts that people write (KPL, formulas,
chronicles, scenarios, the command line) a bare number is milliseconds and a unit may follow:
`200`, `200 ms`, `1.5 s`, `1 min`.
"""

import re
from decimal import Decimal
from typing import NewType

__all__ = [
    "MILLISECOND",
    "MINUTE",
    "SECOND",
    "Duration",
    "TimePoint",
    "duration_from_text",
    "milliseconds",
    "seconds",
    "text_from_duration",
]

TimePoint = NewType("TimePoint", int)
"""Nanoseconds since the beginning of the run."""

Duration = NewType("Duration", int)
"""A span of time in nanoseconds."""

MILLISECOND = Duration(1_000_000)
SECOND = Duration(1_000_000_000)
MINUTE = Duration(60 * SECOND)

_NANOSECONDS_BY_UNIT = {
    "ns": 1,
    "us": 1_000,
    "ms": MILLISECOND,
    "s": SECOND,
    "min": MINUTE,
    "h": 60 * MINUTE,
}
_DURATION = re.compile(r"\s*([+-]?\d+(?:\.\d+)?)\s*([a-z]*)\s*", re.ASCII)


def milliseconds(amount: float) -> Duration:
    """Return the duration of *amount* milliseconds, to the nearest nanosecond."""
    return Duration(round(amount * MILLISECOND))


def seconds(amount: float) -> Duration:
    """Return the duration of *amount* seconds, to the nearest nanosecond."""
    return Duration(round(amount * SECOND))


def duration_from_text(text: str) -> Duration:
    """Read a duration as people write it: `200`, `200 ms`, `1.5 s`, `1 min`.

    Raises:
        ValueError: The text is not a number with one of the known units, or is finer than a
            nanosecond.
    """
    match = _DURATION.fullmatch(text)
    if match is None:
        raise ValueError(f"expected a duration such as '200', '1.5 s' or '1 min', found {text!r}")
    number, unit = match.groups()
    factor = _NANOSECONDS_BY_UNIT.get(unit or "ms")
    if factor is None:
        known = ", ".join(_NANOSECONDS_BY_UNIT)
        raise ValueError(f"expected one of the units {known}, found {unit!r}")
    amount = Decimal(number) * factor
    if amount != amount.to_integral_value():
        raise ValueError(f"{text!r} is finer than a nanosecond")
    return Duration(int(amount))


def text_from_duration(duration: int) -> str:
    """Write *duration* in the form that `duration_from_text` reads, in milliseconds.

    Whole milliseconds are written as a bare number, anything finer with the unit `ns`.
    """
    whole, rest = divmod(duration, MILLISECOND)
    return f"{duration} ns" if rest else str(whole)

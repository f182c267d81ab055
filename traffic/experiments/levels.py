"""Levels of factors as they are put beside each other: equal ones found, numbers by size.

A duration that is written as a text is the number of its milliseconds, as it is in KPL: 500 and
"500 ms" are one level.
"""

from collections.abc import Iterable, Sequence

from dyknow.time import MILLISECOND, duration_from_text
from traffic.experiments.designs import Level

__all__ = ["LevelKey", "amount_of", "headings_of", "in_order", "key_of", "unit_of"]

LevelKey = float | str
"""Equal for levels that mean the same."""

_UNITS = {
    "altitude": "m",
    "delay": "ms",
    "field_of_view": "°",
    "max_speed": "m/s",
    "position_noise": "m",
    "rate_per_hour": "per hour",
    "sample_period": "ms",
    "sensor_delay": "ms",
    "speed": "m/s",
    "stability": "ms",
}
"""Of numbers, by the last part of a setting's name."""


def amount_of(level: Level) -> float | None:
    """Return the number that a level is, in milliseconds if it is a duration; or None."""
    match level:
        case bool():
            return None
        case int() | float():
            return float(level)
        case _:
            try:
                return duration_from_text(level) / MILLISECOND
            except ValueError:
                return None


def key_of(level: Level) -> LevelKey:
    """Return what is equal for levels that mean the same."""
    amount = amount_of(level)
    if amount is not None:
        return amount
    return str(level).lower() if isinstance(level, bool) else str(level)


def in_order(levels: Iterable[Level]) -> list[Level]:
    """Return each level once: numbers by size if all are, otherwise as they come."""
    found = {key_of(level): level for level in reversed(list(levels))}
    once = list(reversed(found.values()))
    if all(isinstance(key, float) for key in found):
        return sorted(once, key=lambda level: amount_of(level) or 0.0)
    return once


def headings_of(names: Sequence[str]) -> list[str]:
    """Return what stands above the levels of settings: the last parts of their names, in words.

    A name of which the last part is that of another one as well stays whole.
    """
    lasts = [name.rpartition(".")[2] for name in names]
    return [
        (last if lasts.count(last) == 1 else name).replace("_", " ")
        for name, last in zip(names, lasts, strict=True)
    ]


def unit_of(name: str) -> str:
    """Return the unit of the numbers that a setting has; empty if it is not known."""
    return _UNITS.get(name.rpartition(".")[2], "")

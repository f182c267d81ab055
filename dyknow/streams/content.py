"""Samples told apart by what they say: a value and its valid time."""

from typing import Any

from dyknow.streams.sample import Sample
from dyknow.streams.values import are_equal
from dyknow.time import TimePoint

__all__ = ["Contents"]


class Contents:
    """Numbers samples such that two have one number if they say the same of the same time."""

    def __init__(self) -> None:
        self._count = 0
        self._by_time: dict[TimePoint, list[tuple[Any, int]]] = {}

    def number(self, sample: Sample[Any]) -> int:
        """Return the number of what *sample* says."""
        known = self._by_time.setdefault(sample.valid_time, [])
        for value, number in known:
            if are_equal(value, sample.value):
                return number
        self._count += 1
        known.append((sample.value, self._count))
        return self._count

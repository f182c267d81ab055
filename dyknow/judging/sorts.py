"""What sorts contain, as far as the application says (Heintz 2009, definition 4.5.1)."""

from collections.abc import Callable, Mapping
from typing import Any

from dyknow.kpl.syntax import ANY_SORT, STATE_SORT, Sort

__all__ = ["SortTest", "Sorts", "sort_test"]

SortTest = Callable[[Any], str | None]
"""Tells what is wrong with a value that is not of a sort; None if nothing is."""

Sorts = Mapping[str, SortTest]
"""The tests by the names of the sorts."""


def sort_test(sort: Sort | None, sorts: Sorts) -> SortTest | None:
    """Return the test of a declared sort; None if nothing is known about its values."""
    if sort is None or sort.name == ANY_SORT:
        return None
    if sort.name != STATE_SORT:
        return sorts.get(sort.name)
    return _StateTest(tuple(sort_test(part, sorts) for part in sort.parts))


class _StateTest:
    """A state has one value for each of its parts."""

    def __init__(self, parts: tuple[SortTest | None, ...]) -> None:
        self._parts = parts

    def __call__(self, value: Any) -> str | None:
        if not isinstance(value, tuple) or len(value) != len(self._parts):
            return f"expected a tuple of {len(self._parts)} values"
        for number, (test, part) in enumerate(zip(self._parts, value, strict=True), start=1):
            fault = None if test is None else test(part)
            if fault is not None:
                return f"in place {number}, {fault}"
        return None

"""Symbols of objects, such as `car7`: a sort and a number."""

import re

__all__ = ["id_of", "sort_of_symbol"]

_SYMBOL = re.compile(r"(?P<sort>.*\D)(?P<id>\d+)")


def id_of(symbol: str) -> int | None:
    """Return the number of an object; None if *symbol* does not end in one."""
    match = _SYMBOL.fullmatch(symbol)
    return None if match is None else int(match["id"])


def sort_of_symbol(symbol: str) -> str | None:
    """Return the sort of an object; None if *symbol* does not end in a number."""
    match = _SYMBOL.fullmatch(symbol)
    return None if match is None else match["sort"]

"""Every error that networks raises on purpose."""

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

__all__ = ["NetworkError", "NetworkFileError", "UnknownPlaceError"]


class NetworkError(Exception):
    """The root of all errors of networks."""


class NetworkFileError(NetworkError):
    """A road network file is missing, broken, or holds no road for vehicles.

    Attributes:
        path: The file.
        fault: What is wrong, without the place.
        line: The line of the fault, counted from 1, if one is known.
        column: The column of the fault, counted from 1, if one is known.
    """

    def __init__(
        self, path: Path, fault: str, *, line: int | None = None, column: int | None = None
    ) -> None:
        known = [str(part) for part in (path, line, column) if part is not None]
        super().__init__(f"{':'.join(known)}: {fault}")
        self.path = path
        self.fault = fault
        self.line = line
        self.column = column

    def report(self) -> str:
        """Return the place and what is wrong there."""
        return str(self)


class UnknownPlaceError(NetworkError):
    """A name stands for no road, link or crossing of the map."""

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        close = get_close_matches(name, list(known), n=1, cutoff=0.6)
        hint = f"; did you mean '{close[0]}'?" if close else ""
        super().__init__(f"no {kind} called '{name}'{hint}")
        self.kind = kind
        self.name = name

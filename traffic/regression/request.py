"""What a user asks of the regression suite, read from the command line and checked."""

import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from dyknow.time import Duration, duration_from_text
from traffic.errors import RequestError
from traffic.recording.rebuilding import describe, open_run
from traffic.regression.cutting import Piece
from traffic.regression.regressing import Addition
from traffic.regression.suite import Entry, bundled_suite, entries

__all__ = ["RegressionRequest"]

_NAME = re.compile(r"[a-z0-9][a-z0-9-]*")


@dataclass(frozen=True, slots=True)
class RegressionRequest:
    """What a user asks of the regression suite.

    Attributes:
        entries: Which recordings.
        update: Whether what is recognised now is to be expected from now on.
        addition: What is to be added, if anything is.
    """

    entries: tuple[Entry, ...]
    update: bool = False
    addition: Addition | None = None

    @classmethod
    def from_texts(  # noqa: PLR0913, one for each option of the command
        cls,
        *,
        names: Collection[str] = (),
        suite: Path | None = None,
        add: Path | None = None,
        begin: str = "0",
        end: str | None = None,
        name: str | None = None,
        update: bool = False,
    ) -> "RegressionRequest":
        """Read what a user wrote on the command line.

        Raises:
            RequestError: An option is impossible, or has no meaning beside another one.
            RecordingError: What is to be added is no recording.
        """
        folder = suite or bundled_suite()
        if add is None:
            for option, value in (("--name", name), ("--to", end), ("--from", begin.strip("0"))):
                if value:
                    fault = "nothing, because it only has a meaning with --add"
                    raise RequestError(option, fault, value)
            return cls(entries(folder, names), update)
        if names or update:
            found = next(iter(names), "--update")
            raise RequestError("--add", "neither names nor --update beside it", found)
        if name is None or _NAME.fullmatch(name) is None:
            expected = "a name of small letters, digits and '-' for what is added"
            raise RequestError("--name", expected, "nothing" if name is None else name)
        piece = Piece(_time(begin, "--from"), _end(add) if end is None else _time(end, "--to"))
        return cls((), addition=Addition(add, piece, Entry(folder, name)))


def _time(text: str, option: str) -> Duration:
    try:
        return duration_from_text(text)
    except ValueError as error:
        expected = "a time such as '200', '1.5 s' or '1 min'"
        raise RequestError(option, expected, text) from error


def _end(recording: Path) -> Duration:
    with open_run(recording) as opened:
        return describe(opened).origin.scenario.duration

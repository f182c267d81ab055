"""The recordings of the regression suite, each with what is expected of it beside it."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from dyknow.source_text import nearest_name
from traffic.bundled import data_folder
from traffic.errors import RequestError

__all__ = ["Entry", "bundled_suite", "entries"]

_RECORDING = ".mcap"
_EXPECTED = ".expected.txt"


@dataclass(frozen=True, slots=True)
class Entry:
    """A recording of the suite.

    Attributes:
        folder: Of the suite.
        name: Of the recording, without its ending.
    """

    folder: Path
    name: str

    @property
    def recording(self) -> Path:
        """The file of the recording."""
        return self.folder / f"{self.name}{_RECORDING}"

    @property
    def expected(self) -> Path:
        """The file that says what is to be recognised."""
        return self.folder / f"{self.name}{_EXPECTED}"


def bundled_suite() -> Path:
    """Return the folder of the suite that comes with the program."""
    return data_folder() / "recordings"


def entries(folder: Path, names: Collection[str] = ()) -> tuple[Entry, ...]:
    """Return the recordings of a suite, those of *names* or all, in order of name.

    Raises:
        RequestError: There is no folder, or no recording of a name.
    """
    if not folder.is_dir():
        raise RequestError("--suite", "a folder with recordings", folder)
    known = sorted(path.name.removesuffix(_RECORDING) for path in folder.glob(f"*{_RECORDING}"))
    for name in names:
        if name not in known:
            nearest = nearest_name(name, known)
            hint = f"; did you mean '{nearest}'?" if nearest else ""
            expected = f"names of recordings in '{folder}'{hint}"
            raise RequestError("traffic regress", expected, name)
    return tuple(Entry(folder, name) for name in known if not names or name in names)

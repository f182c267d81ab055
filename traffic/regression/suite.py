"""The recordings of a regression suite, each with what is expected of it beside it."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from dyknow.source_text import did_you_mean, nearest_name
from traffic.bundled import data_folder
from traffic.errors import RequestError

__all__ = ["Entry", "bundled_suite", "chosen", "entries", "replace_text", "written_whole"]

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

    def fault_of(self, error: Exception) -> str:
        """Return what is wrong with the recording if using it gave this error."""
        if not self.recording.exists():
            return f"there is no '{self.recording}'"
        reason = error.strerror if isinstance(error, OSError) else None
        return f"{self.recording}: {reason}" if reason else str(error)

    def read_expected(self) -> str:
        """Return what is to be recognised.

        Raises:
            RequestError: That is not written down, or is no text.
        """
        try:
            return self.expected.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            why = error.strerror if isinstance(error, OSError) else "no text in UTF-8"
            expected = f"what is to be recognised in '{self.expected}' ({why})"
            hint = f"'traffic regress --update {self.name}' writes it"
            raise RequestError("traffic regress", f"{expected}; {hint}", "nothing") from error


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
    return tuple(Entry(folder, name) for name in chosen(known, names, folder))


def chosen(known: Collection[str], names: Collection[str], folder: Path) -> tuple[str, ...]:
    """Return those *names* of the *known* ones, or all.

    Raises:
        RequestError: A name is not known.
    """
    for name in names:
        if name not in known:
            hint = did_you_mean(nearest_name(name, list(known)))
            expected = f"names of recordings in '{folder}'{hint}"
            raise RequestError("traffic regress", expected, name)
    return tuple(name for name in known if not names or name in names)


def replace_text(path: Path, text: str) -> None:
    """Write a text file anew; if that fails it stays as it was."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        partial.write_text(text, encoding="utf-8")
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


@contextmanager
def written_whole(entry: Entry) -> Iterator[Entry]:
    """Give an entry of another folder to be written, which becomes *entry* when all went well.

    Nothing is left of it otherwise.
    """
    with TemporaryDirectory(prefix=".writing-", dir=entry.folder) as folder:
        unfinished = Entry(Path(folder), entry.name)
        yield unfinished
        unfinished.expected.replace(entry.expected)
        unfinished.recording.replace(entry.recording)

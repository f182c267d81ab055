"""Where the recording of a run is, which is a file of its own beside the folder of the run."""

from collections.abc import Iterator
from pathlib import Path

from pydantic import ValidationError

from traffic.errors import RequestError
from traffic.origin import Origin
from traffic.recording.rebuilding import describe, open_run

__all__ = ["find_recording", "note_recording"]

_NOTE = "recording.txt"
_ENDING = ".mcap"


def note_recording(path: Path, folder: Path) -> None:
    """Write into the folder of a run where its recording will be."""
    (folder / _NOTE).write_text(f"{path.absolute()}\n", encoding="utf-8")


def find_recording(path: Path, option: str) -> Path:
    """Return *path* if it is no folder, or else the recording of the run in that folder.

    That is where the run says that it is, or beside the folder and called like it, or in it.

    Args:
        path: What a user wrote.
        option: Where.

    Raises:
        RequestError: The run was not recorded, or its recording is not there any more.
        RecordingError: What is there cannot be read.
        ReplayError: What is there is no recording of a run.
    """
    if not path.is_dir():
        return path
    origin = _origin_of(path, option)
    noted = next(_noted(path), None)
    for each in (
        *_noted(path),
        path.with_name(f"{path.name}{_ENDING}"),
        *path.glob(f"*{_ENDING}"),
    ):
        if each.is_file():
            with open_run(each) as recording:
                if describe(recording).origin == origin:
                    return each
    how = "'traffic run SCENARIO --record FILE.mcap' records a run"
    found = f"{path}, whose recording '{noted}' is gone" if noted else f"{path}, of none"
    raise RequestError(
        option, f"the recording of a run, or the folder of a recorded one; {how}", found
    )


def _origin_of(folder: Path, option: str) -> Origin:
    try:
        return Origin.model_validate_json((folder / "origin.json").read_text(encoding="utf-8"))
    except (OSError, ValidationError, UnicodeDecodeError) as error:
        raise RequestError(option, "the folder of a run", folder) from error


def _noted(folder: Path) -> Iterator[Path]:
    note = folder / _NOTE
    if note.is_file():
        yield Path(note.read_text(encoding="utf-8").strip())

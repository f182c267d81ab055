"""Every error that recordings raise on purpose; each message is for the person who must act."""

from collections.abc import Iterable
from pathlib import Path

from dyknow.errors import DyKnowError
from dyknow.source_text import did_you_mean, nearest_name

__all__ = [
    "DamagedRecordingError",
    "MissingCodecError",
    "MissingOriginError",
    "MissingStreamError",
    "NotARecordingError",
    "RecordingError",
    "RecordingExistsError",
    "RecordingVersionError",
    "UnrecordableValueError",
]


class RecordingError(DyKnowError):
    """The root of all errors of recordings.

    Attributes:
        path: The file in question.
        fault: What is wrong with it.
    """

    def __init__(self, path: Path, fault: str) -> None:
        super().__init__(f"{path}: {fault}")
        self.path = path
        self.fault = fault


class RecordingExistsError(RecordingError):
    """There is a file already where a recording shall be written."""

    def __init__(self, path: Path, hint: str = "") -> None:
        super().__init__(path, f"there is a file of this name already{hint}")


class NotARecordingError(RecordingError):
    """The file is something else than a recording of this library."""

    def __init__(self, path: Path, found: str) -> None:
        super().__init__(path, f"expected a recording in MCAP, found {found}")


class RecordingVersionError(RecordingError):
    """The recording has a format that this version does not read."""

    def __init__(self, path: Path, expected: str, found: str) -> None:
        super().__init__(path, f"expected a recording of format {expected}, found format {found}")


class DamagedRecordingError(RecordingError):
    """Something in the file is not what was written; *where* says which chunk or record."""

    def __init__(self, path: Path, where: str, fault: str) -> None:
        super().__init__(
            path, f"{where} is damaged: {fault}; what is whole can be recovered into another file"
        )
        self.where = where


class MissingStreamError(RecordingError):
    """The recording has no stream of this topic."""

    def __init__(self, path: Path, topic: str, known: Iterable[str]) -> None:
        hint = did_you_mean(nearest_name(topic, list(known)))
        super().__init__(path, f"no stream '{topic}' has been recorded{hint}")
        self.topic = topic


class MissingOriginError(RecordingError):
    """A sample of an adapted stream refers to one of its provider that is not there."""

    def __init__(self, path: Path, topic: str, provider: str, available_time: int) -> None:
        super().__init__(
            path,
            f"stream '{topic}' refers to the sample of '{provider}' that became available at "
            f"{available_time} ns, which is not in the recording",
        )


class MissingCodecError(RecordingError):
    """A stream has values of an application that nothing is there to read."""

    def __init__(self, path: Path, topic: str, codec: str) -> None:
        super().__init__(path, f"stream '{topic}' has values that need the codec '{codec}'")
        self.codec = codec


class UnrecordableValueError(RecordingError):
    """A sample has a value that cannot be written."""

    def __init__(self, path: Path, topic: str, fault: str) -> None:
        super().__init__(path, f"stream '{topic}' cannot be recorded: {fault}")
        self.topic = topic

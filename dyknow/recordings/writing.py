"""The file that is being written: channels and messages, in chunks, by the library for MCAP.

The file has the ending `.partial` until it is closed well. Each whole chunk is handed to the
operating system at once, so that a program that is killed loses no more than the open one.
"""

import os
from collections.abc import Callable, Mapping
from pathlib import Path

from mcap.writer import CompressionType, Writer

from dyknow.recordings.errors import RecordingExistsError
from dyknow.recordings.formats import PROFILE

__all__ = ["CHUNK_SIZE", "FileWriter", "partial_path"]

CHUNK_SIZE = 128 * 1024
"""Bytes of messages after which a chunk is written."""

_HINT = ", left behind by a writer that did not finish; recover it or remove it"

AddMessage = Callable[[int, int, bytes, int, int], None]
"""Takes the number of a channel, log time, content, publish time, and sequence number."""


def partial_path(path: Path) -> Path:
    """Return the name of a recording while it is being written."""
    return path.with_name(f"{path.name}.partial")


class FileWriter:
    """Writes one MCAP file.

    Attributes:
        path: What the file will be called.
        add_message: Writes a message.
    """

    def __init__(
        self, path: Path, chunk_size: int = CHUNK_SIZE, partial: Path | None = None
    ) -> None:
        """Begin a file, which is called *partial* until it is closed; else `….partial`.

        Raises:
            RecordingExistsError: There is a file of this name, or its `.partial` one.
        """
        if path.exists():
            raise RecordingExistsError(path)
        self.path = path
        self._partial = partial or partial_path(path)
        try:
            self._file = _Unbuffered(self._partial)
        except FileExistsError:
            raise RecordingExistsError(self._partial, _HINT) from None
        self._writer = Writer(
            self._file,  # type: ignore[arg-type]  # all that the library asks of it is there
            chunk_size=chunk_size,
            compression=CompressionType.ZSTD,
            enable_data_crcs=True,
        )
        self._writer.start(profile=PROFILE)
        self.add_message: AddMessage = self._writer.add_message

    def add_channel(
        self, topic: str, schema: tuple[str, bytes], metadata: Mapping[str, str]
    ) -> int:
        """Begin a channel for messages of *schema*, its name and bytes; return its number."""
        name, data = schema
        schema_number = self._writer.register_schema(name, "protobuf", data)
        return self._writer.register_channel(topic, "protobuf", schema_number, dict(metadata))

    def add_metadata(self, name: str, metadata: Mapping[str, str]) -> None:
        """Write texts that belong to no channel."""
        self._writer.add_metadata(name, dict(metadata))

    def finish(self) -> None:
        """Write what is still open and the summary; leave the file `.partial`."""
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
        finally:
            self._file.close()

    def publish(self) -> None:
        """Finish the file and give it its name.

        Raises:
            RecordingExistsError: Somebody else has made a file of this name meanwhile.
        """
        self.finish()
        if self.path.exists():
            raise RecordingExistsError(self.path)
        self._partial.rename(self.path)

    def discard(self) -> None:
        """Remove what has been written."""
        self._file.close()
        self._partial.unlink()


class _Unbuffered:
    """A new file in which everything stands as soon as it has been written."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
        self._position = 0
        self._is_open = True

    def write(self, data: bytes) -> int:
        """Write all of *data*; what the system objects names the file."""
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[os.write(self._descriptor, rest) :]
        except OSError as fault:
            raise OSError(fault.errno, fault.strerror, str(self._path)) from fault
        self._position += len(data)
        return len(data)

    def tell(self) -> int:
        """Return how much has been written."""
        return self._position

    def close(self) -> None:
        """Close the file, unless that has been done."""
        if self._is_open:
            self._is_open = False
            os.close(self._descriptor)

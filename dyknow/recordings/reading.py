"""The file that is being read: what it holds, and its messages in order of time."""

from collections import OrderedDict
from collections.abc import Collection, Iterator
from operator import itemgetter
from pathlib import Path
from struct import error as struct_error
from typing import BinaryIO

from mcap.exceptions import McapError
from mcap.records import Header

from dyknow.recordings.container import (
    MAGIC,
    RawMessage,
    contents_of,
    data_of_chunk,
    entry_at,
    stream_of,
)
from dyknow.recordings.errors import (
    DamagedRecordingError,
    NotARecordingError,
    RecordingVersionError,
)
from dyknow.recordings.formats import FORMAT, PROFILE
from dyknow.recordings.index import (
    ChunkEntry,
    Damage,
    Index,
    Losses,
    index_from_summary,
    index_of_whole_chunks,
)

__all__ = ["FileReader"]

_CACHED_CHUNKS = 8
_END_OF_TIME = 1 << 64
_log_time = itemgetter(0)


class FileReader:
    """Reads one MCAP file that is a recording.

    Attributes:
        path: The file.
        index: What is where in it.
        damage: What is missing, if it was not closed well, or made of one that was not.
    """

    def __init__(self, path: Path) -> None:
        """Open a file and find out what is in it.

        Raises:
            NotARecordingError, RecordingVersionError, DamagedRecordingError: It cannot be read.
        """
        self.path = path
        self._cache: OrderedDict[int, list[RawMessage]] = OrderedDict()
        self._file: BinaryIO = path.open("rb")
        try:
            self.index, self.damage = self._open()
        except BaseException:
            self._file.close()
            raise

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def messages(self, channels: Collection[int]) -> Iterator[RawMessage]:
        """Yield the messages of *channels* in order of log time, then in that of the file."""
        wanted = frozenset(channels)
        chunks = sorted(self._chunks_with(wanted), key=lambda chunk: chunk.first)
        pending: list[RawMessage] = []
        for at, chunk in enumerate(chunks):
            limit = chunks[at + 1].first if at + 1 < len(chunks) else _END_OF_TIME
            pending += [each for each in self._messages_in(chunk) if each[1] in wanted]
            pending.sort(key=_log_time)
            if pending and pending[-1][0] < limit:
                yield from pending
                pending = []
            else:
                ready = [each for each in pending if each[0] < limit]
                yield from ready
                pending = pending[len(ready) :]

    def messages_at(self, channels: Collection[int], log_time: int) -> list[RawMessage]:
        """Return the messages of *channels* with exactly this log time."""
        wanted = frozenset(channels)
        return [
            message
            for chunk in self._chunks_with(wanted)
            if chunk.first <= log_time <= chunk.last
            for message in self._messages_in(chunk)
            if message[0] == log_time and message[1] in wanted
        ]

    def extent(self, channels: Collection[int]) -> tuple[int, int] | None:
        """Return the log times of the first and the last message of *channels*."""
        wanted = frozenset(channels)
        chunks = self._chunks_with(wanted)
        if not chunks:
            return None
        first, last = _END_OF_TIME, -1
        for chunk in sorted(chunks, key=lambda chunk: chunk.first):
            if chunk.first <= first:
                first = min(first, *self._times_in(chunk, wanted))
        for chunk in sorted(chunks, key=lambda chunk: -chunk.last):
            if chunk.last >= last:
                last = max(last, *self._times_in(chunk, wanted))
        return first, last

    def _open(self) -> tuple[Index, Damage | Losses | None]:
        size = self.path.stat().st_size
        self._check_header(size)
        damage: Damage | Losses | None
        index = index_from_summary(self.path, self._file, size)
        if index is None:
            index, damage = index_of_whole_chunks(self.path, self._file, size)
        else:
            damage = index.losses
        if not index.format:
            fault = "it does not say which format the recording has"
            raise DamagedRecordingError(self.path, "the beginning", fault)
        if index.format != FORMAT:
            raise RecordingVersionError(self.path, FORMAT, index.format)
        return index, damage

    def _check_header(self, size: int) -> None:
        if size == 0:
            raise NotARecordingError(self.path, "an empty file")
        if self._file.read(len(MAGIC)) != MAGIC:
            raise NotARecordingError(self.path, "something else, by its first bytes")
        entry = entry_at(self._file, len(MAGIC), size)
        if entry is None:
            fault = "the file ends within it"
            raise DamagedRecordingError(self.path, "the beginning", fault)
        try:
            profile = Header.read(stream_of(self._file, entry)).profile
        except (McapError, struct_error, UnicodeDecodeError) as fault:
            raise DamagedRecordingError(self.path, "the header", str(fault)) from fault
        if profile != PROFILE:
            raise NotARecordingError(self.path, f"an MCAP file of the profile '{profile}'")

    def _chunks_with(self, channels: frozenset[int]) -> list[ChunkEntry]:
        return [chunk for chunk in self.index.chunks if chunk.channels & channels]

    def _times_in(self, chunk: ChunkEntry, channels: frozenset[int]) -> list[int]:
        return [each[0] for each in self._messages_in(chunk) if each[1] in channels]

    def _messages_in(self, chunk: ChunkEntry) -> list[RawMessage]:
        """Return the messages of a chunk, read anew or remembered."""
        messages = self._cache.get(chunk.number)
        if messages is None:
            messages = self._cache[chunk.number] = self._read(chunk)
            if len(self._cache) > _CACHED_CHUNKS:
                self._cache.popitem(last=False)
        self._cache.move_to_end(chunk.number)
        return messages

    def _read(self, chunk: ChunkEntry) -> list[RawMessage]:
        try:
            messages = contents_of(data_of_chunk(self._file, chunk.record)).messages
        except (McapError, struct_error, UnicodeDecodeError, ValueError) as fault:
            raise DamagedRecordingError(self.path, chunk.name, str(fault)) from fault
        unknown = {message[1] for message in messages} - self.index.channels.keys()
        if unknown:
            found = f"it has messages of channel {min(unknown)}, which nothing declares"
            raise DamagedRecordingError(self.path, chunk.name, found)
        return messages

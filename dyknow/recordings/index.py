"""What is where in a file: by its summary, or by going through it."""

import zlib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from struct import error as struct_error
from typing import BinaryIO

from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    Footer,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)
from mcap.stream_reader import StreamReader

from dyknow.recordings.container import (
    MAGIC,
    RecordEntry,
    contents_of,
    data_of_chunk,
    entries_from,
    entry_at,
    stream_of,
)
from dyknow.recordings.errors import DamagedRecordingError
from dyknow.recordings.formats import (
    FORMAT_RECORD,
    LOSSES_RECORD,
    TEXTS_RECORD,
    checked_texts,
    sealed_texts,
)
from dyknow.time import TimePoint, text_from_duration

__all__ = [
    "ChunkEntry",
    "Damage",
    "Index",
    "Losses",
    "index_from_summary",
    "index_of_whole_chunks",
]

_FOOTER_SIZE = 9 + 20
_SUMMED_OF_FOOTER = 9 + 16
_MALFORMED = (McapError, struct_error, UnicodeDecodeError, ValueError)
"""What the library for MCAP raises for bytes that are not a record."""


@dataclass(frozen=True, slots=True)
class ChunkEntry:
    """A chunk and what it holds.

    Attributes:
        number: Its number, from 1.
        record: Where it is.
        first: The earliest log time of its messages.
        last: The latest.
        channels: The numbers of the channels of its messages.
    """

    number: int
    record: RecordEntry
    first: int
    last: int
    channels: frozenset[int]

    @property
    def name(self) -> str:
        """What an error calls it."""
        times = " to ".join(text_from_duration(time) for time in (self.first, self.last))
        return f"chunk {self.number} ({times} ms, at byte {self.record.start})"


@dataclass(frozen=True, slots=True)
class Damage:
    """What is missing of a file that was not closed well.

    Attributes:
        path: The file.
        n_chunks: How many whole chunks it has.
        until: The log time of the last message in them; None without any.
        lost_bytes: How many bytes at its end belong to nothing whole.
    """

    path: Path
    n_chunks: int
    until: TimePoint | None
    lost_bytes: int

    def __str__(self) -> str:
        what = f"{self.n_chunks} whole chunk" + ("" if self.n_chunks == 1 else "s")
        until = "" if self.until is None else f", up to {text_from_duration(self.until)} ms"
        return (
            f"{self.path}: the recording is cut off; it is read as far as it is whole: "
            f"{what}{until}; {self.lost_bytes} bytes at the end are lost"
        )


@dataclass(frozen=True, slots=True)
class Losses:
    """What is missing of a recording that was made of a damaged one.

    Attributes:
        path: The file.
        what: What was lost, in words.
        until: Before this available time nothing is missing; None if only the end is.
    """

    path: Path
    what: str
    until: TimePoint | None

    def __str__(self) -> str:
        whole = "" if self.until is None else f"; whole up to {text_from_duration(self.until)} ms"
        return f"{self.path}: recovered from a damaged recording: {self.what}{whole}"

    def as_metadata(self) -> dict[str, str]:
        """Return what a file says of it."""
        until = {} if self.until is None else {"until": str(self.until)}
        return sealed_texts({"what": self.what, **until})

    @classmethod
    def from_metadata(cls, path: Path, metadata: Mapping[str, str]) -> "Losses":
        """Return what the file at *path* says.

        Raises:
            ValueError, KeyError: It is not what was written.
        """
        said = checked_texts(metadata)
        until = TimePoint(int(said["until"])) if "until" in said else None
        return cls(path, said["what"], until)


@dataclass(slots=True)
class Index:
    """What is where in a file.

    Attributes:
        schemas: By number.
        channels: By number.
        counts: How many messages there are, by number of channel.
        chunks: In the order of the file.
        texts: The texts about the whole recording.
        format: The format of the recording; empty if the file does not say.
        losses: What is missing, of a recording that was recovered.
    """

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    counts: Counter[int] = field(default_factory=Counter)
    chunks: list[ChunkEntry] = field(default_factory=list)
    texts: dict[str, str] = field(default_factory=dict)
    format: str = ""
    losses: Losses | None = None

    def add_metadata(
        self, path: Path, file: BinaryIO, entry: RecordEntry, name: str | None = None
    ) -> None:
        """Take in a metadata record, which must have a *name* if one is known.

        Raises:
            DamagedRecordingError: It is not what was written.
        """
        try:
            record = Metadata.read(stream_of(file, entry))
            if name is not None and record.name != name:
                raise ValueError("its name is wrong")
            if record.name == FORMAT_RECORD:
                self.format = checked_texts(record.metadata)["format"]
            elif record.name == TEXTS_RECORD:
                self.texts.update(checked_texts(record.metadata))
            elif record.name == LOSSES_RECORD:
                self.losses = Losses.from_metadata(path, record.metadata)
        except (*_MALFORMED, KeyError) as fault:
            where = f"the metadata at byte {entry.start}"
            raise DamagedRecordingError(path, where, str(fault)) from fault


def index_from_summary(path: Path, file: BinaryIO, size: int) -> Index | None:
    """Return what the summary of a file says; None if it has no whole one."""
    summary = _summary(file, size)
    if summary is None:
        return None
    index = Index()
    for record in StreamReader(BytesIO(summary + MAGIC), skip_magic=True).records:
        match record:
            case Schema():
                index.schemas[record.id] = record
            case Channel():
                index.channels[record.id] = record
            case Statistics():
                index.counts.update(record.channel_message_counts)
            case ChunkIndex():
                index.chunks.append(_chunk_entry(len(index.chunks) + 1, record))
            case MetadataIndex():
                index.add_metadata(path, file, _entry(record.offset, record.length), record.name)
            case _:
                pass
    return index


def index_of_whole_chunks(path: Path, file: BinaryIO, size: int) -> tuple[Index, Damage]:
    """Return what the whole chunks of a file are, and what is missing.

    Raises:
        DamagedRecordingError: A chunk that is all there is not what was written.
    """
    index = Index()
    end = len(MAGIC)
    for entry in entries_from(file, end, size):
        end = entry.end
        if entry.opcode == Opcode.METADATA:
            index.add_metadata(path, file, entry)
        elif entry.opcode == Opcode.CHUNK:
            _add_chunk(index, path, file, entry)
    until = TimePoint(max(chunk.last for chunk in index.chunks)) if index.chunks else None
    return index, Damage(path, len(index.chunks), until, size - end)


def _add_chunk(index: Index, path: Path, file: BinaryIO, entry: RecordEntry) -> None:
    number = len(index.chunks) + 1
    try:
        contents = contents_of(data_of_chunk(file, entry))
    except _MALFORMED as fault:
        where = f"chunk {number} (at byte {entry.start})"
        raise DamagedRecordingError(path, where, str(fault)) from fault
    index.schemas.update(contents.schemas)
    index.channels.update(contents.channels)
    counts = Counter(message[1] for message in contents.messages)
    index.counts.update(counts)
    times = [message[0] for message in contents.messages]
    if times:
        chunk = ChunkEntry(number, entry, min(times), max(times), frozenset(counts))
        index.chunks.append(chunk)


def _summary(file: BinaryIO, size: int) -> bytes | None:
    """Return the summary and the footer, if they are what was written."""
    footer_start = size - len(MAGIC) - _FOOTER_SIZE
    if footer_start < len(MAGIC):
        return None
    footer_entry = entry_at(file, footer_start, size)
    if footer_entry is None or footer_entry != RecordEntry(
        Opcode.FOOTER, footer_start + 9, size - len(MAGIC)
    ):
        return None
    footer = Footer.read(stream_of(file, footer_entry))
    if not len(MAGIC) <= footer.summary_start < footer_start:
        return None
    file.seek(footer.summary_start)
    summary = file.read(footer_start + _FOOTER_SIZE - footer.summary_start)
    summed = summary[: _SUMMED_OF_FOOTER - _FOOTER_SIZE]
    is_whole = file.read(len(MAGIC)) == MAGIC and zlib.crc32(summed) == footer.summary_crc
    return summary if is_whole else None


def _chunk_entry(number: int, index: ChunkIndex) -> ChunkEntry:
    return ChunkEntry(
        number,
        _entry(index.chunk_start_offset, index.chunk_length),
        index.message_start_time,
        index.message_end_time,
        frozenset(index.message_index_offsets),
    )


def _entry(start: int, length: int) -> RecordEntry:
    return RecordEntry(Opcode.CHUNK, start + 9, start + length)

"""The records of an MCAP file, as they stand in it: whole, cut off, or damaged.

The library for MCAP reads what a record holds; finding records, chunks and messages in a file that
may end anywhere is done here, as well as taking messages out of chunks, which is done for every
sample and is three times as fast without an object for each.
"""

import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from struct import Struct
from typing import BinaryIO

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Schema

__all__ = [
    "MAGIC",
    "Contents",
    "RawMessage",
    "RecordEntry",
    "contents_of",
    "data_of_chunk",
    "entries_from",
    "entry_at",
    "stream_of",
]

MAGIC = b"\x89MCAP0\r\n"
"""The beginning and the end of each file."""

RawMessage = tuple[int, int, int, bytes, int]
"""Log time, number of the channel, sequence number, content, publish time."""

_RECORD = Struct("<BQ")
_CHUNK = Struct("<QQQII")
_LENGTH = Struct("<Q")
_MESSAGE = Struct("<BQHIQQ")
_ZSTD = b"zstd"


@dataclass(frozen=True, slots=True)
class RecordEntry:
    """Where a record is.

    Attributes:
        opcode: What kind of record it is.
        begin: Where its content begins.
        end: Where the next record begins.
    """

    opcode: int
    begin: int
    end: int

    @property
    def start(self) -> int:
        """Where the record itself begins."""
        return self.begin - _RECORD.size


@dataclass(slots=True)
class Contents:
    """What a chunk holds.

    Attributes:
        schemas: By number.
        channels: By number.
        messages: In the order in which they were written.
    """

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    messages: list[RawMessage] = field(default_factory=list)


def entry_at(file: BinaryIO, start: int, size: int) -> RecordEntry | None:
    """Return the record that begins at *start*; None if the file of *size* bytes cuts it off."""
    file.seek(start)
    head = file.read(_RECORD.size)
    if len(head) < _RECORD.size:
        return None
    opcode, length = _RECORD.unpack(head)
    begin = start + _RECORD.size
    return RecordEntry(opcode, begin, begin + length) if begin + length <= size else None


def entries_from(file: BinaryIO, start: int, size: int) -> Iterator[RecordEntry]:
    """Yield the whole records from *start* on, up to the end of the data or to one cut off."""
    while (entry := entry_at(file, start, size)) is not None:
        yield entry
        if entry.opcode == Opcode.DATA_END:
            return
        start = entry.end


def stream_of(file: BinaryIO, entry: RecordEntry) -> ReadDataStream:
    """Return the content of a record for the library to read."""
    file.seek(entry.begin)
    return ReadDataStream(BytesIO(file.read(entry.end - entry.begin)))


def data_of_chunk(file: BinaryIO, entry: RecordEntry) -> bytes:
    """Return the records in a chunk.

    Raises:
        ValueError: They are not what was written.
    """
    file.seek(entry.begin)
    content = file.read(entry.end - entry.begin)
    if len(content) < _CHUNK.size:
        raise ValueError("it is too short")
    _, _, size, crc, n_letters = _CHUNK.unpack_from(content)
    at = _CHUNK.size + n_letters
    if content[_CHUNK.size : at] != _ZSTD:
        raise ValueError("it is not compressed with zstd")
    at += _LENGTH.size
    if content[at - _LENGTH.size : at] != _LENGTH.pack(len(content) - at):
        raise ValueError("its length is wrong")
    return _decompressed(content[at:], size, crc)


def contents_of(data: bytes) -> Contents:
    """Return what the records in a chunk are.

    Raises:
        ValueError: They are not records of a chunk.
    """
    contents = Contents()
    messages = contents.messages
    unpack, skip = _MESSAGE.unpack_from, _MESSAGE.size
    at, end = 0, len(data)
    while at < end:
        if data[at] == Opcode.MESSAGE and at + skip <= end:
            _, length, channel, sequence, log_time, publish_time = unpack(data, at)
            begin, at = at + skip, at + _RECORD.size + length
            messages.append((log_time, channel, sequence, data[begin:at], publish_time))
        else:
            at = _declared(data, at, contents)
    if at > end:
        raise ValueError("its last record is cut off")
    return contents


def _decompressed(content: bytes, size: int, crc: int) -> bytes:
    try:
        if zstandard.frame_content_size(content) != size:
            raise ValueError("its size is wrong")
        data = zstandard.ZstdDecompressor().decompress(content)
    except zstandard.ZstdError as fault:
        raise ValueError(f"it cannot be decompressed ({fault})") from None
    if zlib.crc32(data) != crc:
        raise ValueError("its checksum is wrong")
    return data


def _declared(data: bytes, at: int, contents: Contents) -> int:
    """Take in the schema or channel that is declared at *at*; return where the next record is."""
    opcode, length = _RECORD.unpack_from(data, at)
    begin = at + _RECORD.size
    end = begin + int(length)
    stream = ReadDataStream(BytesIO(data[begin:end]))
    if opcode == Opcode.SCHEMA:
        schema = Schema.read(stream)
        contents.schemas[schema.id] = schema
    elif opcode == Opcode.CHANNEL:
        channel = Channel.read(stream)
        contents.channels[channel.id] = channel
    return end

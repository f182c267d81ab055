"""Making a valid recording of what is whole in a damaged one.

Chunks and metadata are looked for by the bytes that they begin with, wherever they are, and taken
if their checksums are right. So it does not matter where a file is cut off or damaged: what is
whole is found.
"""

import mmap
import struct
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Schema

from dyknow.recordings.channels import ChannelRole, Description
from dyknow.recordings.container import (
    Contents,
    RawMessage,
    RecordEntry,
    contents_of,
    data_of_chunk,
    entry_at,
)
from dyknow.recordings.errors import (
    DamagedRecordingError,
    NotARecordingError,
    RecordingVersionError,
)
from dyknow.recordings.formats import (
    FORMAT,
    FORMAT_RECORD,
    LOSSES_RECORD,
    TEXTS_RECORD,
    sealed_texts,
)
from dyknow.recordings.index import Index, Losses, index_from_summary
from dyknow.recordings.messages import Reference, message_reader, times_of
from dyknow.recordings.origins import N_ORIGINS
from dyknow.recordings.writing import FileWriter
from dyknow.time import TimePoint, text_from_duration

__all__ = ["RecoveryReport", "recover"]

_NAME_OF_COMPRESSION = b"\x04\x00\x00\x00zstd"
_BEFORE_NAME = 9 + 28
"""Bytes of a chunk's record that come before the name of its compression."""

Progress = Callable[[float], None]
"""Is told what part of a file has been gone through, from 0 to 1."""


@dataclass(frozen=True, slots=True)
class RecoveryReport:
    """What came of a recovery.

    Attributes:
        path: The damaged file.
        out: The recording that was made of it.
        is_whole: Whether nothing was wrong with the file.
        n_chunks: How many whole chunks it has.
        n_messages: How many messages have been copied.
        n_missing: How many messages are known to be missing, of streams that go on after them;
            what came after the last whole chunk is not known.
        n_dangling: How many samples were left out because the value they refer to is missing.
        until: The available time of the last message; None without any.
        faults: What else is wrong.
    """

    path: Path
    out: Path
    is_whole: bool
    n_chunks: int
    n_messages: int
    n_missing: int
    n_dangling: int
    until: TimePoint | None
    faults: tuple[str, ...]

    def __str__(self) -> str:
        until = "" if self.until is None else f", up to {text_from_duration(self.until)} ms"
        messages = _amount(self.n_messages, "message")
        begin = f"{self.out}: {messages} of {_amount(self.n_chunks, 'whole chunk')}{until}"
        return "; ".join([begin, *self.losses])

    @property
    def losses(self) -> tuple[str, ...]:
        """What was lost, and what else is wrong."""
        parts = []
        if self.n_missing:
            parts.append(f"{_amount(self.n_missing, 'message')} missing in between")
        if self.n_dangling:
            parts.append(f"{_amount(self.n_dangling, 'sample')} left out for want of a value")
        return (*parts, *self.faults)


def _amount(count: int, what: str) -> str:
    return f"{count} {what}" + ("" if count == 1 else "s")


def recover(
    path: Path | str, out: Path | str, on_progress: Progress | None = None
) -> RecoveryReport:
    """Write the whole chunks of *path*, cut off or damaged anywhere, to a new recording *out*.

    Raises:
        NotARecordingError: There is nothing of a recording in the file.
        RecordingVersionError: It is of a format that is not read here.
        RecordingExistsError: There is a file called *out*.
        OSError: A file cannot be read or written.
    """
    path, out = Path(path), Path(out)
    size = path.stat().st_size
    if size == 0:
        raise NotARecordingError(path, "an empty file")
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as view:
        found = _Found(path, file, view, size)
        copy = _Copy(found, FileWriter(out, partial=out.with_name(f"{out.name}.recovering")))
        try:
            for contents, end in found.chunks():
                copy.add(contents)
                if on_progress is not None:
                    on_progress(end / size)
            copy.publish()
        except BaseException:
            copy.discard()
            raise
    return copy.report(out)


class _Found:
    """What can be found in a damaged file.

    Attributes:
        path: The file.
        texts: The texts about the whole recording.
        schemas: By number, as far as the summary has them; chunks add to them.
        channels: Likewise.
        losses: What was missing before, if the file was recovered already.
        n_chunks: How many chunks there are by the summary; None without one.
        faults: What is wrong.
    """

    def __init__(self, path: Path, file: BinaryIO, view: mmap.mmap, size: int) -> None:
        self.path = path
        self._file = file
        self._view = view
        self._size = size
        self.faults: list[str] = []
        summary = self._summary()
        self.n_chunks = None if summary is None else len(summary.chunks)
        self.schemas: dict[int, Schema] = {} if summary is None else summary.schemas
        self.channels: dict[int, Channel] = {} if summary is None else summary.channels
        index = self._metadata()
        self.texts = index.texts
        self.has_format = bool(index.format)
        self.losses = index.losses
        if index.format not in {"", FORMAT}:
            raise RecordingVersionError(path, FORMAT, index.format)

    def chunks(self) -> Iterator[tuple[Contents, int]]:
        """Yield what each whole chunk holds, and where it ends."""
        at = 0
        while (name := self._view.find(_NAME_OF_COMPRESSION, at)) >= 0:
            at = name + 1
            entry = self._entry(name - _BEFORE_NAME, Opcode.CHUNK)
            contents = None if entry is None else self._contents(entry)
            if entry is not None and contents is not None:
                at = entry.end
                self.schemas.update(contents.schemas)
                self.channels.update(contents.channels)
                yield contents, at

    def _summary(self) -> Index | None:
        try:
            summary = index_from_summary(self.path, self._file, self._size)
        except DamagedRecordingError:
            return None  # the metadata are looked for by themselves
        if summary is None:
            self.faults.append("the end of the file is missing or damaged")
        return summary

    def _metadata(self) -> Index:
        index = Index()
        for name in (FORMAT_RECORD, TEXTS_RECORD, LOSSES_RECORD):
            mark = struct.pack("<I", len(name)) + name.encode()
            at = 0
            while (found := self._view.find(mark, at)) >= 0:
                at = found + 1
                entry = self._entry(found - 9, Opcode.METADATA)
                if entry is not None:
                    self._add_metadata(index, entry)
        return index

    def _add_metadata(self, index: Index, entry: RecordEntry) -> None:
        try:
            index.add_metadata(self.path, self._file, entry)
        except DamagedRecordingError as fault:
            self.faults.append(f"{fault.where} is damaged and left out")

    def _entry(self, start: int, opcode: Opcode) -> RecordEntry | None:
        entry = entry_at(self._file, start, self._size) if start >= 0 else None
        return entry if entry is not None and entry.opcode == opcode else None

    def _contents(self, entry: RecordEntry) -> Contents | None:
        try:
            return contents_of(data_of_chunk(self._file, entry))
        except (McapError, struct.error, ValueError) as fault:
            self.faults.append(f"the chunk at byte {entry.start} is left out: {fault}")
            return None


class _Copy:
    """The recording that is made of what has been found."""

    def __init__(self, found: _Found, writer: FileWriter) -> None:
        self._found = found
        self._writer = writer
        self._numbers: dict[int, int] = {}
        self._descriptions: dict[int, Description] = {}
        self._last: dict[str, int] = {}
        self._origins: dict[str, deque[TimePoint]] = {}
        self._n_chunks = self._n_messages = self._n_missing = self._n_dangling = 0
        self._n_unknown = 0
        self._until: TimePoint | None = None
        self._begin_of_chunk = TimePoint(0)
        self._whole_until: TimePoint | None = None
        writer.add_metadata(FORMAT_RECORD, sealed_texts({"format": FORMAT}))
        writer.add_metadata(TEXTS_RECORD, sealed_texts(found.texts))

    def add(self, contents: Contents) -> None:
        """Write the messages of a chunk."""
        self._n_chunks += 1
        n_missing, begin_before = self._n_missing, self._begin_of_chunk
        for message in contents.messages:
            if message[1] in self._found.channels:
                self._add(message)
            else:
                self._n_unknown += 1
        if contents.messages:
            self._begin_of_chunk = TimePoint(min(message[0] for message in contents.messages))
        if self._n_missing > n_missing and self._whole_until is None:
            self._whole_until = begin_before  # some streams are ahead of others in a chunk

    def publish(self) -> None:
        """Give the recording its name."""
        if not self._n_chunks and not self._found.has_format:
            raise NotARecordingError(self._found.path, "nothing that is whole in one")
        for number in self._found.channels:
            self._open(number)
        losses = self._losses()
        if losses is not None:
            self._writer.add_metadata(LOSSES_RECORD, losses.as_metadata())
        self._writer.publish()

    def discard(self) -> None:
        """Leave nothing behind."""
        self._writer.discard()

    def report(self, out: Path) -> RecoveryReport:
        """Return what came of it."""
        found = self._found
        faults = list(found.faults)
        if self._n_unknown:
            faults.append(f"{self._n_unknown} messages are of streams that nothing declares")
        return RecoveryReport(
            path=found.path,
            out=out,
            is_whole=not faults and self._n_chunks == found.n_chunks,
            n_chunks=self._n_chunks,
            n_messages=self._n_messages,
            n_missing=self._n_missing,
            n_dangling=self._n_dangling,
            until=self._until,
            faults=tuple(faults),
        )

    def _losses(self) -> Losses | None:
        """Return what is missing of the recording, now or before; None if nothing is."""
        path, before = self._writer.path, self._found.losses
        report = self.report(path)
        if report.is_whole:
            return before
        what = "; ".join(report.losses) or "the last chunks are missing"
        return Losses(path, what, self._whole_until)

    def _add(self, message: RawMessage) -> None:
        log_time, old, sequence, data, publish_time = message
        number = self._open(old)
        topic = self._found.channels[old].topic
        self._n_missing += max(0, sequence - self._last.get(topic, 0) - 1)
        self._last[topic] = sequence
        if not self._has_value(topic, self._descriptions[old], data):
            self._n_dangling += 1
            return
        self._writer.add_message(number, log_time, data, publish_time, sequence)
        self._n_messages += 1
        self._until = TimePoint(max(self._until or 0, log_time))

    def _has_value(self, topic: str, description: Description, data: bytes) -> bool:
        """Return whether the value of a message has been copied, in it or before it."""
        if description.role is ChannelRole.GENERATOR:
            origins = self._origins.setdefault(topic, deque(maxlen=2 * N_ORIGINS))
            origins.append(times_of(data)[1])
        elif description.role is ChannelRole.STREAM and description.layout is None:
            said = message_reader(description, {})(data)
            if isinstance(said, Reference):
                return said.origin in self._origins.get(description.provider, ())
        return True

    def _open(self, old: int) -> int:
        """Return the number in the copy of a channel."""
        if old not in self._numbers:
            channel = self._found.channels[old]
            try:
                self._descriptions[old] = Description.from_metadata(channel.metadata)
            except (KeyError, TypeError, ValueError):
                found = "an MCAP file with other things than streams"
                raise NotARecordingError(self._found.path, found) from None
            schema = self._found.schemas[channel.schema_id]
            self._numbers[old] = self._writer.add_channel(
                channel.topic, (schema.name, schema.data), channel.metadata
            )
        return self._numbers[old]

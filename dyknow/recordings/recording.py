"""Reading a recording: which streams it has, and their samples, as they were."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Self

from dyknow.errors import ValueNotAvailableError
from dyknow.recordings.channels import ChannelRole, Description
from dyknow.recordings.codecs import Codec
from dyknow.recordings.errors import (
    DamagedRecordingError,
    MissingCodecError,
    MissingOriginError,
    MissingStreamError,
)
from dyknow.recordings.index import Damage, Losses
from dyknow.recordings.layout import Layout
from dyknow.recordings.messages import (
    ReadMessage,
    Reference,
    available_time_of,
    message_reader,
)
from dyknow.recordings.origins import Origins
from dyknow.recordings.reading import FileReader
from dyknow.recordings.violations import VIOLATIONS, violation_from_sample
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.process import Element
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = [
    "RecordedMessage",
    "RecordedSource",
    "RecordedStream",
    "Recording",
    "open_recording",
]


@dataclass(frozen=True, slots=True)
class RecordedStream:
    """What a recording knows of one topic.

    Attributes:
        topic: Its name: the label of a generator, or the name of an adapted stream or of a view.
        role: What its messages are.
        provider: Of an adapted stream: the label of the generator whose samples it has.
        about: What the recorder was told about it.
        schema: The name of the type of its messages.
        count: How many messages there are, heartbeats included.
        first: The available time of the first message; None if there is none.
        last: That of the last one.
    """

    topic: str
    role: ChannelRole
    provider: str
    about: Mapping[str, str]
    schema: str
    count: int
    first: TimePoint | None
    last: TimePoint | None


class RecordedMessage(NamedTuple):
    """A message as it was written.

    Attributes:
        topic: Its topic.
        layout: How its value is laid out; None if it refers to one of the provider.
        data: Its bytes.
    """

    topic: str
    layout: Layout | None
    data: bytes


def open_recording(path: Path | str, codecs: Sequence[Codec] = ()) -> "Recording":
    """Open a recording; *codecs* read the values of the application.

    A file that is cut off is read as far as it is whole; `Recording.damage` says what is missing.

    Raises:
        RecordingError: The file is no recording, of another format, or damaged.
        OSError: The file cannot be opened.
    """
    return Recording(FileReader(Path(path)), codecs)


class Recording:
    """A recording that is read: a context manager.

    Attributes:
        path: The file.
        damage: What is missing, if the file was not closed well, or was made of one that was not.
        version: The format of the file.
        metadata: The texts about the whole recording.
    """

    def __init__(self, file: FileReader, codecs: Sequence[Codec] = ()) -> None:
        """Read *file*, which has been opened; *codecs* read the values of the application.

        Raises:
            DamagedRecordingError: A channel does not say what it is.
        """
        self.path = file.path
        self.damage: Damage | Losses | None = file.damage
        self.version = file.index.format
        self.metadata: Mapping[str, str] = dict(file.index.texts)
        self._file = file
        self._codecs = {codec.name: codec for codec in codecs}
        self._descriptions = _descriptions(file)
        self._readers: dict[int, ReadMessage] = {}
        self._channels: dict[str, list[int]] = {}
        for number, channel in file.index.channels.items():
            self._channels.setdefault(channel.topic, []).append(number)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        error_type: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @property
    def gap(self) -> TimePoint | None:
        """Before this time nothing is missing; None if nothing is, or only the end."""
        return self.damage.until if isinstance(self.damage, Losses) else None

    @property
    def streams(self) -> Mapping[str, RecordedStream]:
        """What has been recorded, by topic, in the order in which it was first written."""
        return {topic: self._stream(topic, numbers) for topic, numbers in self._channels.items()}

    @property
    def topics(self) -> frozenset[str]:
        """The topics of all streams that are not for viewers alone."""
        return frozenset(
            topic
            for topic, numbers in self._channels.items()
            if self._descriptions[numbers[0]].role is not ChannelRole.VIEW
        )

    def samples(self, topic: str) -> Iterator[Sample[Any]]:
        """Yield the samples of one topic in order of available time; read as they are asked for.

        Raises:
            MissingStreamError: There is no stream of this topic.
            MissingCodecError: Its values need a codec that is not there.
            DamagedRecordingError: A chunk is not what was written.
        """
        return (element for _, element in self.merged(topic) if isinstance(element, Sample))

    def contents(self, topic: str) -> Iterator[Element]:
        """Yield the samples and heartbeats of one topic in order of available time.

        It raises what `samples` does.
        """
        return (element for _, element in self.merged(topic))

    def merged(self, *topics: str) -> Iterator[tuple[str, Element]]:
        """Yield the samples and heartbeats of several topics in order of available time.

        At one time they come in the order in which they were written. It raises what `samples`
        does, part of it when the first is asked for.
        """
        topic_by_channel = {number: topic for topic in topics for number in self._known(topic)}
        for number in topic_by_channel:
            self._reader(number)  # what is missing is told at once
        providers = {topic: self._provider(topic) for topic in topics}
        return self._merged(topic_by_channel, providers)

    def source(self, topic: str) -> "RecordedSource":
        """Return a source that gives the samples and heartbeats of a topic again.

        Raises:
            MissingStreamError: There is no stream of this topic.
            MissingCodecError: Its values need a codec that is not there.
        """
        self.merged(topic)
        return RecordedSource(self, topic)

    def value(self, topic: str, available_time: TimePoint) -> Any:
        """Return the value of the sample that became available at a time.

        Raises:
            ValueNotAvailableError: There is no such sample.
            MissingStreamError, MissingCodecError, DamagedRecordingError: As `samples`.
        """
        sample = self._find(topic, available_time)
        if sample is None:
            wanted = f"sample that became available at {available_time} ns"
            raise ValueNotAvailableError(topic, wanted)
        return sample.value

    def violations(self) -> Iterator[StreamViolation]:
        """Yield the violations of policies in order of the time when they were noticed."""
        if VIOLATIONS in self._channels:
            for sample in self.samples(VIOLATIONS):
                yield violation_from_sample(sample, self._find_if_known)

    def messages(self, topics: Collection[str]) -> Iterator[RecordedMessage]:
        """Yield the messages of some topics as they were written, in order of available time."""
        origin = {
            number: (topic, self._descriptions[number].layout)
            for topic in topics
            for number in self._known(topic)
        }
        for _, number, _, data, _ in self._file.messages(origin):
            yield RecordedMessage(*origin[number], data)

    def _merged(
        self,
        topic_by_channel: Mapping[int, str],
        providers: Mapping[str, str],
    ) -> Iterator[tuple[str, Element]]:
        origins = {
            provider: Origins(partial(self._find, provider))
            for provider in providers.values()
            if provider
        }
        origins_by_channel = {
            number: kept for provider, kept in origins.items() for number in self._known(provider)
        }
        for _, number, _, data, _ in self._file.messages({*topic_by_channel, *origins_by_channel}):
            read: Callable[[], Element | Reference] = partial(self._reader(number), data)
            if number in origins_by_channel:
                read = origins_by_channel[number].keep(data, self._reader(number))
            if number in topic_by_channel:
                topic, element = topic_by_channel[number], read()
                if isinstance(element, Reference):
                    element = self._resolved(element, topic, origins[providers[topic]])
                yield topic, element

    def _resolved(self, reference: Reference, topic: str, origins: Origins) -> Sample[Any]:
        origin = origins.sample(reference.origin)
        if origin is None:
            provider = self._provider(topic)
            raise MissingOriginError(self.path, topic, provider, reference.origin)
        return Sample(origin.value, reference.valid_time, reference.available_time)

    def _find(self, topic: str, available_time: TimePoint) -> Sample[Any] | None:
        """Return the sample of a topic that became available at a time, wherever it is."""
        numbers = self._known(topic)
        for _, number, _, data, _ in self._file.messages_at(numbers, max(0, available_time)):
            if available_time_of(data) == available_time:
                element = self._reader(number)(data)
                if isinstance(element, Reference):
                    find = partial(self._find, self._provider(topic))
                    return self._resolved(element, topic, Origins(find))
                if isinstance(element, Sample):
                    return element
        return None

    def _find_if_known(self, topic: str, available_time: TimePoint) -> Sample[Any] | None:
        return self._find(topic, available_time) if topic in self._channels else None

    def _known(self, topic: str) -> Sequence[int]:
        """Return the numbers of the channels of a topic that has samples."""
        numbers = self._channels.get(topic, [])
        if not numbers or self._descriptions[numbers[0]].role is ChannelRole.VIEW:
            known = [each for each in self._channels if each != topic]
            raise MissingStreamError(self.path, topic, known)
        return numbers

    def _provider(self, topic: str) -> str:
        """Return the provider to whose samples those of *topic* refer; empty if they do not."""
        for number in self._known(topic):
            if self._descriptions[number].layout is None:
                return self._descriptions[number].provider
        return ""

    def _reader(self, number: int) -> ReadMessage:
        if number not in self._readers:
            try:
                read = message_reader(self._descriptions[number], self._codecs)
            except KeyError as codec:
                topic = self._file.index.channels[number].topic
                raise MissingCodecError(self.path, topic, codec.args[0]) from None
            self._readers[number] = read
        return self._readers[number]

    def _stream(self, topic: str, numbers: Sequence[int]) -> RecordedStream:
        index = self._file.index
        description = self._descriptions[numbers[0]]
        schema = index.schemas.get(index.channels[numbers[0]].schema_id)
        extent = self._file.extent(numbers)
        first, last = (None, None) if extent is None else map(TimePoint, extent)
        return RecordedStream(
            topic=topic,
            role=description.role,
            provider=description.provider,
            about=description.about,
            schema="" if schema is None else schema.name,
            count=sum(index.counts[number] for number in numbers),
            first=first,
            last=last,
        )


class RecordedSource:
    """A source that gives again what was recorded of a stream."""

    def __init__(self, recording: Recording, topic: str) -> None:
        self._recording = recording
        self._topic = topic

    def samples(self) -> Iterator[Element]:
        """Yield the samples and heartbeats in order of available time, read lazily."""
        return self._recording.contents(self._topic)


def _descriptions(file: FileReader) -> dict[int, Description]:
    descriptions = {}
    for number, channel in file.index.channels.items():
        try:
            descriptions[number] = Description.from_metadata(channel.metadata)
        except (KeyError, TypeError, ValueError) as fault:
            where = f"channel {number} ('{channel.topic}')"
            raise DamagedRecordingError(file.path, where, "it does not say what it is") from fault
    return descriptions

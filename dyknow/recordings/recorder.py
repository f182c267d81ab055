"""Writing what flows in a network to a file, while it flows."""

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from google.protobuf.message import Message

from dyknow.kpl.network import Network
from dyknow.recordings.attaching import Attachment
from dyknow.recordings.channels import ChannelRole, Description
from dyknow.recordings.codecs import Codec
from dyknow.recordings.formats import FORMAT, FORMAT_RECORD, TEXTS_RECORD, sealed_texts
from dyknow.recordings.layout import EMPTY, Layout, grown
from dyknow.recordings.schemas import schema_of_message
from dyknow.recordings.taps import GeneratorTap, StreamTap, ViewTap
from dyknow.recordings.topics import Topic
from dyknow.recordings.violations import VIOLATIONS, layout_of_violations, sample_from_violation
from dyknow.recordings.writing import CHUNK_SIZE, FileWriter
from dyknow.runtime.generators import Label
from dyknow.runtime.kernel import Kernel
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.sample import Sample

__all__ = ["Recorder"]


class Recorder:
    """Writes a recording: a context manager.

    The file has its name from the moment when the block is left without an error; until then,
    and after an error, it is called `….partial`. What it has of each stream is complete up to
    the last chunk that was written.
    """

    def __init__(
        self,
        path: Path | str,
        *,
        metadata: Mapping[str, str],
        codecs: Sequence[Codec] = (),
        chunk_size: int = CHUNK_SIZE,
    ) -> None:
        """Begin a file.

        Args:
            path: What the recording will be called.
            metadata: Texts about the whole recording: specification, parameters, network.
            codecs: How values that are not plain are written; the first that handles one counts.
            chunk_size: After how many bytes of messages a chunk is closed.

        Raises:
            RecordingExistsError: There is a file of this name.
        """
        self._writer = FileWriter(Path(path), chunk_size)
        self._codecs = tuple(codecs)
        self._generators: dict[str, GeneratorTap] = {}
        self._topics: dict[str, Topic] = {}
        self._names: set[str] = set()
        self._attachments: list[Attachment] = []
        self._violations: GeneratorTap | None = None
        self._writer.add_metadata(FORMAT_RECORD, sealed_texts({"format": FORMAT}))
        self.annotate(metadata)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        error_type: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if error_type is None:
            self.close()
        else:
            self._finish()

    @property
    def path(self) -> Path:
        """What the recording will be called."""
        return self._writer.path

    def annotate(self, metadata: Mapping[str, str]) -> None:
        """Add texts about the whole recording; later ones replace earlier ones of their name."""
        self._writer.add_metadata(TEXTS_RECORD, sealed_texts(metadata))

    def generator(
        self, label: str, about: Mapping[str, str] | None = None, *, example: object = None
    ) -> GeneratorTap:
        """Return what writes the samples of the generator *label* that it is called with.

        Args:
            label: The topic.
            about: Texts about the stream, for those who read the file.
            example: A value that is like those to come; what a first value lacks, such as the
                items of an empty tuple, is then in the schema from the start.

        Raises:
            ValueError: There is a topic of this name already.
        """
        description = Description(ChannelRole.GENERATOR, about=about or {})
        layout = EMPTY if example is None else grown(EMPTY, example, self._codecs)
        tap = GeneratorTap(self._topic(label, description, layout))
        self._generators[label] = tap
        return tap

    def stream(
        self, topic: str, provider: str, about: Mapping[str, str] | None = None
    ) -> StreamTap:
        """Return what writes the samples of an adapted stream that it is called with.

        Args:
            topic: The topic, such as `world_objects/1` for the first input of world_objects.
            provider: The label of the generator whose samples the stream has. If that is recorded
                too, values are written once, there, and referred to here.
            about: Texts about the stream, for those who read the file.

        Raises:
            ValueError: There is a topic of this name already.
        """
        description = Description(ChannelRole.STREAM, provider, about=about or {})
        return StreamTap(self._topic(topic, description), self._generators.get(provider))

    def view(
        self,
        topic: str,
        message_type: type[Message],
        convert: Callable[[Sample[Any]], Message | bytes | None],
        about: Mapping[str, str] | None = None,
    ) -> ViewTap:
        """Return what writes, for viewers alone, what *convert* makes of samples.

        Args:
            topic: The topic.
            message_type: What *convert* returns, as a message or as its bytes; or else None,
                when a sample shows nothing.
            convert: Makes a message of a sample.
            about: Texts about the view, for those who read the file.

        Raises:
            ValueError: There is a topic of this name already.
        """
        self._claim(topic)
        schema = message_type.DESCRIPTOR.full_name, schema_of_message(message_type)
        metadata = Description(ChannelRole.VIEW, layout=None, about=about or {}).as_metadata()
        return ViewTap(self._writer, self._writer.add_channel(topic, schema, metadata), convert)

    def violation(self, violation: StreamViolation) -> None:
        """Write that a policy has been violated in a stream."""
        self._violations_tap()(sample_from_violation(violation))

    def attach(
        self,
        network: Network | Kernel,
        labels: Collection[str] | None = None,
        without: Collection[str] = (),
    ) -> Attachment:
        """Record the streams of a network from now on, and its violations.

        Recorded are the samples and heartbeats of each stream generator, those of each input of
        a process, as RECEIVER/NUMBER, and those of each declared output, as `output/NAME`.

        Args:
            network: The network, or its kernel alone, which does not know outputs and policies
                as they were written.
            labels: The generators whose streams are wanted; all if None.
            without: Those that are not.

        Raises:
            NoSuchLabelError: There is no generator of one of these names now.
        """
        kernel = network if isinstance(network, Kernel) else network.kernel
        for label in (*(labels or ()), *without):
            kernel.generator(Label(label))
        chosen, left_out = None if labels is None else set(labels), set(without)

        def is_wanted(label: str) -> bool:
            return (chosen is None or label in chosen) and label not in left_out

        self._violations_tap()  # that there were none is worth knowing too
        attachment = Attachment(self, network, is_wanted)
        self._attachments.append(attachment)
        return attachment

    def close(self) -> None:
        """Write what is still open, and give the file its name."""
        self._settle()
        self._writer.publish()

    def _finish(self) -> None:
        self._settle()
        self._writer.finish()

    def _settle(self) -> None:
        for attachment in self._attachments:
            attachment.end()
        for generator in self._generators.values():
            generator.settle()
        for topic in self._topics.values():
            topic.open()

    def _violations_tap(self) -> GeneratorTap:
        if self._violations is None:
            description = Description(ChannelRole.VIOLATIONS)
            layout = layout_of_violations()
            self._violations = GeneratorTap(self._topic(VIOLATIONS, description, layout))
        return self._violations

    def _topic(self, name: str, description: Description, layout: Layout = EMPTY) -> Topic:
        self._claim(name)
        topic = Topic(self._writer, name, description, self._codecs, layout)
        self._topics[name] = topic
        return topic

    def _claim(self, name: str) -> None:
        if name in self._names:
            raise ValueError(f"there is a topic called '{name}' already")
        self._names.add(name)

"""The channels of one topic in a file that is being written."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from dyknow.recordings.channels import REFERENCE, REFERENCE_TAG, ChannelRole, Description
from dyknow.recordings.codecs import Codec
from dyknow.recordings.encoding import MisfitError, writer_of
from dyknow.recordings.errors import UnrecordableValueError
from dyknow.recordings.layout import EMPTY, Layout, grown
from dyknow.recordings.schemas import schema_of_samples, type_name
from dyknow.recordings.writing import FileWriter
from dyknow.streams.sample import Sample
from dyknow.time import TimePoint

__all__ = ["Topic"]

_NONE_YET = 0
_LARGEST_SEQUENCE = 0xFFFF_FFFF


class Topic:
    """Writes the messages of one topic, and gives it a further channel for each layout it needs.

    Attributes:
        name: What it is called in the file.
    """

    def __init__(
        self,
        writer: FileWriter,
        name: str,
        description: Description,
        codecs: Sequence[Codec] = (),
        layout: Layout = EMPTY,
    ) -> None:
        self.name = name
        self._writer = writer
        self._description = description
        self._codecs = codecs
        self._layout = layout
        self._write = writer_of(layout, codecs)
        self._values = _NONE_YET
        self._references = _NONE_YET
        self._count = 0

    def open(self) -> None:
        """Let there be a channel, if no message has needed one."""
        self._any_channel()

    def put_value(self, head: bytes, sample: Sample[Any]) -> int:
        """Write a sample with its value; return how many bytes that takes.

        Raises:
            UnrecordableValueError: There is no way to write a value like this.
        """
        try:
            data = head + self._encoded(sample.value)
        except (TypeError, UnicodeError) as fault:
            raise UnrecordableValueError(self._writer.path, self.name, str(fault)) from fault
        if not self._values:
            self._values = self._add_channel(self._layout)
        self._put(self._values, data, sample.available_time, sample.valid_time)
        return len(data)

    def put(self, data: bytes, available_time: TimePoint, valid_time: TimePoint) -> None:
        """Write a message without a value."""
        self._put(self._any_channel(), data, available_time, valid_time)

    def put_reference(self, head: bytes, sample: Sample[Any], origin: TimePoint) -> None:
        """Write a sample that has the value of the one of its provider available at *origin*."""
        if not self._references:
            self._references = self._add_channel(None)
        data = head + REFERENCE.pack(REFERENCE_TAG, origin)
        self._put(self._references, data, sample.available_time, sample.valid_time)

    def _put(
        self, channel: int, data: bytes, available_time: TimePoint, valid_time: TimePoint
    ) -> None:
        """Write a message; its container knows no times before 0, the message itself does."""
        self._count = self._count + 1 & _LARGEST_SEQUENCE
        log_time = available_time if available_time > 0 else 0
        publish_time = valid_time if valid_time > 0 else 0
        self._writer.add_message(channel, log_time, data, publish_time, self._count)

    def _encoded(self, value: Any) -> bytes:
        try:
            return self._write(value)
        except MisfitError:
            self._layout = grown(self._layout, value, self._codecs)
            self._write = writer_of(self._layout, self._codecs)
            self._values = _NONE_YET
            return self._write(value)

    def _any_channel(self) -> int:
        """Return the number of a channel for messages without values, which all can have."""
        if not self._values and not self._references:
            if self._description.role is ChannelRole.STREAM:
                self._references = self._add_channel(None)
            else:
                self._values = self._add_channel(self._layout)
        return self._values or self._references

    def _add_channel(self, layout: Layout | None) -> int:
        schema = schema_of_samples(self.name, layout)
        metadata = replace(self._description, layout=layout).as_metadata()
        return self._writer.add_channel(self.name, (type_name(self.name), schema), metadata)

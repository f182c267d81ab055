"""From the messages of a channel to what a stream has said."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from dyknow.recordings.channels import (
    HEAD,
    HEARTBEAT,
    NO_VALUE_MARK,
    REFERENCE,
    Description,
)
from dyknow.recordings.codecs import Codec
from dyknow.recordings.decoding import reader_of
from dyknow.recordings.layout import EMPTY
from dyknow.streams.process import Element
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.time import TimePoint

__all__ = ["ReadMessage", "Reference", "available_time_of", "message_reader", "times_of"]


@dataclass(slots=True)
class Reference:
    """A sample that has the value of another one.

    Attributes:
        valid_time: Of the sample.
        available_time: Of the sample.
        origin: When the one of the provider became available that has the value.
    """

    valid_time: TimePoint
    available_time: TimePoint
    origin: TimePoint


ReadMessage = Callable[[bytes], Element | Reference]
"""Returns what a message says."""

_VALUE = HEAD.size


def message_reader(description: Description, codecs: Mapping[str, Codec]) -> ReadMessage:
    """Return what reads the messages of a channel.

    Raises:
        KeyError: There is no codec of a name that the channel's values need.
    """
    is_reference = description.layout is None
    read_value = reader_of(description.layout or EMPTY, codecs)

    def read(data: bytes) -> Element | Reference:
        _, valid_time, _, available_time = HEAD.unpack_from(data)
        mark = data[_VALUE : _VALUE + 2]
        if mark == NO_VALUE_MARK:
            return Sample(NO_VALUE, valid_time, available_time)
        if mark == HEARTBEAT:
            return Heartbeat(valid_time, available_time)
        if is_reference:
            return Reference(valid_time, available_time, REFERENCE.unpack_from(data, _VALUE)[1])
        return Sample(read_value(data, _VALUE, len(data)), valid_time, available_time)

    return read


def available_time_of(data: bytes) -> TimePoint:
    """Return the available time of a message, without reading its value."""
    return TimePoint(HEAD.unpack_from(data)[3])


def times_of(data: bytes) -> tuple[TimePoint, TimePoint]:
    """Return the valid time and the available time of a message, without reading its value."""
    _, valid_time, _, available_time = HEAD.unpack_from(data)
    return TimePoint(valid_time), TimePoint(available_time)

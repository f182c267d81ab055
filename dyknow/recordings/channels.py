"""What a channel of a recording is: its role, whose values it has, and how they are laid out."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from struct import Struct

from dyknow.recordings.layout import EMPTY, Layout, layout_from_plain, plain_from_layout

__all__ = [
    "HEAD",
    "HEAD_TAGS",
    "HEARTBEAT",
    "NO_VALUE_MARK",
    "REFERENCE",
    "REFERENCE_TAG",
    "ChannelRole",
    "Description",
]

HEAD = Struct("<BqBq")
"""The beginning of the message of a sample: valid time and available time with their tags."""

HEAD_TAGS = (0x09, 0x11)
"""The tags in it."""

NO_VALUE_MARK = b"\x18\x01"
"""What follows if the value is NO_VALUE."""

HEARTBEAT = b"\x18\x02"
"""What follows in the message of a heartbeat, whose valid time is what it says."""

REFERENCE = Struct("<Bq")
"""What follows in the message of a sample that refers to one of the provider."""

REFERENCE_TAG = 0x21
"""The tag in it."""


class ChannelRole(StrEnum):
    """What the messages of a channel are.

    Members:
        GENERATOR: The samples of a stream generator, and its heartbeats.
        STREAM: The samples of a stream that has been adapted to a policy.
        VIOLATIONS: The violations of all streams.
        VIEW: Pictures of samples, for viewers alone.
    """

    GENERATOR = "generator"
    STREAM = "stream"
    VIOLATIONS = "violations"
    VIEW = "view"


@dataclass(frozen=True)
class Description:
    """What a file says of a channel.

    Attributes:
        role: What its messages are.
        provider: Of a stream: the topic of the generator whose samples it has.
        layout: How values are laid out; None if the messages refer to those of the provider.
        about: What the recorder has been told about the stream.
    """

    role: ChannelRole
    provider: str = ""
    layout: Layout | None = EMPTY
    about: Mapping[str, str] = field(default_factory=dict)

    def as_metadata(self) -> dict[str, str]:
        """Return the description as the metadata of a channel."""
        own = {_ROLE: self.role.value}
        if self.provider:
            own[_PROVIDER] = self.provider
        if self.layout is not None:
            own[_LAYOUT] = json.dumps(plain_from_layout(self.layout), separators=(",", ":"))
        return {**self.about, **own}

    @classmethod
    def from_metadata(cls, metadata: Mapping[str, str]) -> "Description":
        """Return the description that `as_metadata` has written.

        Raises:
            KeyError, TypeError, ValueError: It is something else.
        """
        layout = metadata.get(_LAYOUT)
        return cls(
            role=ChannelRole(metadata[_ROLE]),
            provider=metadata.get(_PROVIDER, ""),
            layout=None if layout is None else layout_from_plain(json.loads(layout)),
            about={key: value for key, value in metadata.items() if key not in _OWN},
        )


_ROLE = "dyknow.role"
_PROVIDER = "dyknow.provider"
_LAYOUT = "dyknow.layout"
_OWN = {_ROLE, _PROVIDER, _LAYOUT}

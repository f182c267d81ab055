"""Recordings written again with something altered."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from dyknow.recordings.channels import ChannelRole
from dyknow.recordings.codecs import Codec
from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.process import Element

__all__ = ["rewrite"]

Alter = Callable[[list[Element]], Sequence[Element]]
"""Returns what there shall be in place of a stream."""


def rewrite(
    path: Path,
    out: Path,
    alter: Mapping[str, Alter],
    violations: Callable[[list[StreamViolation]], Sequence[StreamViolation]] = list,
    codecs: Sequence[Codec] = (),
) -> Path:
    """Write the recording *path* again to *out*, with some streams altered; views are left out."""
    with (
        open_recording(path, codecs) as recording,
        Recorder(out, metadata=recording.metadata, codecs=codecs) as recorder,
    ):
        writers, contents = {}, []
        for topic, stream in recording.streams.items():
            if stream.role is ChannelRole.GENERATOR:
                writers[topic] = recorder.generator(topic, stream.about)
            elif stream.role is ChannelRole.STREAM:
                writers[topic] = recorder.stream(topic, "", stream.about)
        for topic in writers:
            elements = list(recording.contents(topic))
            changed = alter.get(topic, list)(elements)
            contents.extend((topic, element) for element in changed)
        for topic, element in contents:
            writers[topic](element)
        for violation in violations(list(recording.violations())):
            recorder.violation(violation)
    return out

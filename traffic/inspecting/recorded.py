"""What a recording tells of the network that was recorded.

A recording knows processes, policies, and when every sample was valid and available; what the
processes cost, and what the caches held, it does not know. Values are not read.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dyknow.inspection.snapshot import Kind, ProcessFigures, Snapshot, StreamFigures
from dyknow.kpl.description import (
    GeneratorDescription,
    InputDescription,
    NetworkDescription,
    OutputDescription,
)
from dyknow.recordings.channels import HEAD, HEARTBEAT
from dyknow.recordings.messages import times_of
from dyknow.recordings.recording import Recording, open_recording
from dyknow.recordings.violations import VIOLATIONS
from dyknow.runtime.names import OUTPUT, input_name, output_name
from dyknow.runtime.statistics import Delays, Statistics
from dyknow.streams.sample import NO_VALUE, Sample
from dyknow.time import TimePoint
from traffic.errors import ResultError

__all__ = ["network_from_recording"]

_NETWORK = "network"


def network_from_recording(path: Path) -> tuple[Snapshot, str | None]:
    """Return the network of a recording with the figures of its streams, and what is missing.

    Raises:
        RecordingError: The file is no recording, or damaged.
        ResultError: It does not say what the network was.
        OSError: The file cannot be read.
    """
    with open_recording(path) as recording:
        described = _description(recording)
        counts = _counts_of_samples(recording)
        _count_violations(recording, described, counts)
        damage = recording.damage
    return _snapshot(described, counts), None if damage is None else str(damage)


@dataclass(slots=True)
class _Counts:
    """The running figures of one topic."""

    delays: Delays = field(default_factory=Delays)
    first: TimePoint | None = None
    last: Sample[Any] | None = None
    violations: int = 0
    late: int = 0
    heartbeats: int = 0

    def note(self, valid_time: TimePoint, available_time: TimePoint) -> None:
        """Count a sample."""
        if self.first is None:
            self.first = valid_time
        self.last = Sample(NO_VALUE, valid_time, available_time)
        self.delays.add(available_time - valid_time)

    @property
    def statistics(self) -> Statistics:
        """The figures as they stand."""
        return Statistics.of(self)


def _description(recording: Recording) -> NetworkDescription:
    """Return what the recording says of the network, as it was when recording began."""
    try:
        described: NetworkDescription = json.loads(recording.metadata[_NETWORK])
    except (KeyError, ValueError) as error:
        fault = "expected a recording that says what its network was, found none"
        raise ResultError(f"'{recording.path}': {fault}") from error
    return described


def _counts_of_samples(recording: Recording) -> dict[str, _Counts]:
    counts = {topic: _Counts() for topic in recording.topics if topic != VIOLATIONS}
    for topic, _, data in recording.messages(counts.keys()):
        if data.startswith(HEARTBEAT, HEAD.size):
            counts[topic].heartbeats += 1
        else:
            counts[topic].note(*times_of(data))
    return counts


def _count_violations(
    recording: Recording, described: NetworkDescription, counts: Mapping[str, _Counts]
) -> None:
    """Count violations in the streams in which they happened.

    Of outputs a violation only says what provides them, and stands in all of those.
    """
    if VIOLATIONS not in recording.streams:
        return
    outputs: dict[str, list[str]] = {}
    for output in described["outputs"]:
        outputs.setdefault(output["provider"], []).append(output_name(output["name"]))
    for sample in recording.samples(VIOLATIONS):
        for topic in _topics_of(sample.value, outputs):
            if topic in counts:
                counts[topic].violations += 1
                counts[topic].late += sample.value["sample_available_time"] is not None


def _topics_of(told: Mapping[str, Any], outputs: Mapping[str, list[str]]) -> list[str]:
    if told["number"]:
        return [input_name(told["receiver"], told["number"])]
    return outputs.get(told["provider"], []) if told["receiver"] == OUTPUT else [told["receiver"]]


def _snapshot(described: NetworkDescription, counts: Mapping[str, _Counts]) -> Snapshot:
    generators = described["generators"]
    depths: dict[str, int] = {}
    for generator in generators:
        inputs = [depths.get(each["provider"], 0) for each in generator["inputs"]]
        depths[generator["label"]] = 1 + max(inputs, default=-1)
    streams = [
        *(_input(g["label"], each, counts) for g in generators for each in g["inputs"]),
        *(_output(each, counts) for each in described["outputs"]),
    ]
    ends = [count.last.available_time for count in counts.values() if count.last is not None]
    return Snapshot(
        now=TimePoint(max(ends, default=0)),
        processes=tuple(_process(g, depths[g["label"]], counts) for g in generators),
        streams=tuple(streams),
        outputs=tuple(output["name"] for output in described["outputs"]),
    )


def _process(
    described: GeneratorDescription, depth: int, counts: Mapping[str, _Counts]
) -> ProcessFigures:
    label = described["label"]
    figures = counts.get(label, _Counts()).statistics
    inputs = [counts.get(input_name(label, each["number"])) for each in described["inputs"]]
    own = figures.violations
    return ProcessFigures(
        label=label,
        kind=Kind(described["kind"]),
        text=described["process"],
        depth=depth,
        policy=described["output_policy"],
        on_failure=described["on_failure"],
        calls=None,
        seconds=None,
        samples=figures.samples,
        heartbeats=figures.heartbeats,
        violations=own + sum(each.violations for each in inputs if each is not None),
    )


def _input(
    receiver: str, described: InputDescription, counts: Mapping[str, _Counts]
) -> StreamFigures:
    number = described["number"]
    figures = counts.get(input_name(receiver, number), _Counts()).statistics
    return StreamFigures.of(described["provider"], receiver, number, described["policy"], figures)


def _output(described: OutputDescription, counts: Mapping[str, _Counts]) -> StreamFigures:
    name = described["name"]
    figures = counts.get(output_name(name), _Counts()).statistics
    return StreamFigures.of(described["provider"], name, 0, described["policy"], figures)

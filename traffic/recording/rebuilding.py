"""The system of a run again, from its recording: the same map, cameras, chance and parameters.

What came from outside comes from the recording. Random numbers are drawn from the same seed in the
same order, so that every process does again what it did.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain, takewhile
from pathlib import Path
from typing import Any

from dyknow.kpl.names import Declarations
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    Declaration,
    GeneratorDeclaration,
    Name,
    Sort,
    SourceDeclaration,
    SourceInstance,
    Specification,
)
from dyknow.recordings.channels import ChannelRole
from dyknow.recordings.recording import Recording, open_recording
from dyknow.source_text import nearest_name
from dyknow.streams.process import Source
from dyknow.streams.sample import Sample
from networks.reading import read_road_map
from traffic.bundled import data_folder
from traffic.errors import ReplayError, RequestError
from traffic.origin import Origin, digest_of
from traffic.recording.codecs import CODECS
from traffic.recording.describing import RunDescription
from traffic.request import View
from traffic.sumo.replayed import TRUTH, ReplayedSimulation
from traffic.system import MonitoringSystem, outputs_of, sort_of
from traffic.world import World, camera_of, generators_of

__all__ = [
    "describe",
    "network_of_origin",
    "open_run",
    "recorded_labels",
    "recorded_sources",
    "simulation_of",
    "system_of",
    "take",
    "world_of",
]

_OF_THE_WORLD = frozenset({"camera_pose", "link_turns"})
"""Sources that say nothing but what the world does, and so need not be recorded."""


def open_run(path: Path) -> Recording:
    """Open the recording of a run, in a `with` block.

    Raises:
        RecordingError: It is no recording, of another format, or damaged.
        OSError: The file cannot be opened.
    """
    return open_recording(path, CODECS)


def describe(recording: Recording) -> RunDescription:
    """Return what a recording says of its run.

    Raises:
        ReplayError: It is not a recording of 'traffic run'.
    """
    said = RunDescription.from_metadata(recording.metadata, recording.path)
    return said if recording.damage is None else replace(said, is_complete=False)


def world_of(recording: Recording) -> World:
    """Return what surrounded the system when it was recorded, chance at its beginning.

    Raises:
        ReplayError: The network is not what it was, or nowhere to be found.
        NetworkError: The network cannot be read.
    """
    origin = describe(recording).origin
    road_map = read_road_map(network_of_origin(origin, recording.path))
    is_vision = origin.request["view"] == View.VISION
    camera = camera_of(origin.scenario.camera, road_map) if is_vision else None
    _, sensors = generators_of(int(origin.request["seed"] or 0))
    return World(road_map, _Nowhere(), camera, sensors)


def system_of(
    recording: Recording,
    specification: Specification | None = None,
    world: World | None = None,
    outputs: Sequence[str] | None = None,
    parameters: Mapping[str, object] | None = None,
) -> MonitoringSystem:
    """Return the system of a recorded run, fed with what was recorded.

    Each source is the recorded stream of a generator that the specification makes of it, or that
    is called like it. A source that was not recorded is made again if it says only what the world
    does, such as where the camera is.

    Args:
        recording: The recording of a run.
        specification: Which processes and streams there are, if not those that were recorded. Of
            the recorded parameters it gets those that it has.
        world: What surrounds the system, chance at its beginning; by default `world_of` the
            recording.
        outputs: The output streams that are wanted; by default those that were, or all but
            images of a changed specification.
        parameters: Values in place of recorded ones.

    Raises:
        ReplayError: It is not a recording of 'traffic run', or its network has changed.
        SpecificationErrors: The specification has faults, or a source that is not recorded.
    """
    description = describe(recording)
    if outputs is None:
        outputs = description.outputs if specification is None else outputs_of(specification)
    specification = specification or description.specification
    declared = Declarations(specification).parameters
    values = {**description.parameters, **(parameters or {})}
    return MonitoringSystem(
        world or world_of(recording),
        {name: value for name, value in values.items() if name in declared},
        tuple(outputs),
        specification=specification,
        sources=_recorded_sources(recording, specification),
    )


def take(
    labels: Collection[str], specification: Specification, recording: Recording
) -> Specification:
    """Return *specification* with recorded streams in place of the processes of *labels*.

    Raises:
        RequestError: A label is not declared, or not recorded.
    """
    declared = {
        text_from(each.label): each
        for each in specification.declarations
        if isinstance(each, GeneratorDeclaration)
    }
    known = recorded_labels(recording)
    for label in labels:
        if label not in declared or label not in known:
            names = [each for each in known if each in declared]
            nearest = nearest_name(label, names)
            hint = f"'{nearest}' or another one of " if nearest else ""
            raise RequestError(
                "--from", f"labels that were recorded: {hint}{_listed(names)}", label
            )
    replaced: dict[Declaration, tuple[Declaration, ...]] = {}
    for number, label in enumerate(labels):
        name = Name(f"recorded_{number}")
        sort = Sort(sort_of(specification, label))
        replaced[declared[label]] = (
            SourceDeclaration(sort, name),
            replace(declared[label], process=SourceInstance(name)),
        )
    parts = (replaced.get(each, (each,)) for each in specification.declarations)
    return replace(specification, declarations=tuple(chain.from_iterable(parts)))


def simulation_of(recording: Recording) -> ReplayedSimulation | None:
    """Return the recorded truth up to where some is missing, for scoring alone; None without."""
    if TRUTH not in recording.streams:
        return None
    gap = recording.gap
    frames = recording.samples(TRUTH)
    if gap is None:
        return ReplayedSimulation(frames)
    return ReplayedSimulation(takewhile(lambda frame: frame.available_time < gap, frames))


def recorded_labels(recording: Recording) -> tuple[str, ...]:
    """Return the labels of the stream generators that were recorded."""
    return tuple(
        topic
        for topic, stream in recording.streams.items()
        if stream.role is ChannelRole.GENERATOR and topic != TRUTH
    )


def recorded_sources(
    recording: Recording, specification: Specification
) -> dict[str, Callable[[], Source]]:
    """Return what makes each recorded source again, by the label under which it was recorded.

    Those that say only what the world does are left out: they can be made again without.
    """
    known = recorded_labels(recording)
    topics = (
        next((each for each in _topics_of(name, specification) if each in known), None)
        for name in Declarations(specification).sources
        if name not in _OF_THE_WORLD
    )
    return {topic: partial(recording.source, topic) for topic in topics if topic is not None}


def _recorded_sources(
    recording: Recording, specification: Specification
) -> dict[str, Callable[[], Source]]:
    """Return what makes each source that is recorded; the others explain why they cannot be."""
    known = recorded_labels(recording)
    found: dict[str, Callable[[], Source]] = {}
    for name in Declarations(specification).sources:
        topic = next((each for each in _topics_of(name, specification) if each in known), None)
        if topic is not None:
            found[name] = partial(recording.source, topic)
        elif name not in _OF_THE_WORLD:
            found[name] = partial(_refuse, name, known)
    return found


def _topics_of(source: str, specification: Specification) -> Iterator[str]:
    """Yield the labels of the generators made of a source, and its own name."""
    for declaration in specification.declarations:
        match declaration:
            case GeneratorDeclaration(label, SourceInstance(Name(name))) if name == source:
                yield text_from(label)
            case _:
                pass
    yield source


def _refuse(source: str, known: Sequence[str]) -> Source:
    nearest = nearest_name(source, known)
    hint = f" (did you mean '{nearest}'?)" if nearest else ""
    raise ValueError(
        f"the source '{source}' was not recorded{hint}; the recording has {_listed(known)}; "
        "'--from' begins with one of these"
    )


def _listed(labels: Sequence[str]) -> str:
    return ", ".join(labels) or "nothing"


def network_of_origin(origin: Origin, path: Path) -> Path:
    """Return the path of the network: where it was, or among the bundled ones.

    Args:
        origin: What a run was made from.
        path: Of the run or its recording, for messages.

    Raises:
        ReplayError: The network is not what it was, or nowhere to be found.
    """
    name = origin.network.name
    bundled = data_folder() / "networks" / name.removesuffix(".net.xml") / name
    there = [each for each in (origin.network, bundled) if each.is_file()]
    for each in there:
        if digest_of(each) == origin.network_sha256:
            return each
    if there:
        raise ReplayError(path, f"the network '{there[0]}' has changed since the recording")
    raise ReplayError(path, f"its network '{origin.network}' is not there any more")


class _Nowhere:
    """A source whose samples are to come from a recording."""

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield nothing."""
        return iter(())

"""Judging the recording of a run: does it satisfy its specification, or another one?"""

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

from dyknow.judging.declared import DeclaredNetwork
from dyknow.judging.judge import judge
from dyknow.judging.judgement import NOT_RECORDED, Breach, Finding, Judgement
from dyknow.judging.recorded import RecordedExecution
from dyknow.judging.specified import declared_network
from dyknow.kpl.names import Declarations
from dyknow.kpl.plan import Network
from dyknow.kpl.syntax import Specification
from dyknow.recordings.recording import Recording
from dyknow.streams.process import Source
from dyknow.streams.sample import Sample
from dyknow.time import MILLISECOND, TimePoint, text_from_duration
from traffic.errors import RequestError
from traffic.recording.describing import RunDescription
from traffic.recording.rebuilding import describe, open_run, world_of
from traffic.sorts import SORTS
from traffic.sumo.replayed import TRUTH
from traffic.system import (
    MonitoringSystem,
    image_labels,
    implementations_of,
    read_specification,
)
from traffic.world import World, generators_of

__all__ = ["JudgedRun", "document_from", "judge_recording"]

_SAID_AGAIN = frozenset({"camera_pose", "link_turns"})
"""Sources that say nothing but what the world does, whenever they are asked."""

_IMAGES = "images are not recorded, but computed again by a replay"
"""Why streams of images are not judged."""

OnProgress = Callable[[float, float], None]
"""Told how many declarations have been judged, and how many there are."""


@dataclass(frozen=True, slots=True)
class JudgedRun:
    """A recording and what was found about it.

    Attributes:
        recording: The file.
        specification: The file that it was judged by; None for what stands in the recording.
        judgement: What was found.
    """

    recording: Path
    specification: Path | None
    judgement: Judgement


def judge_recording(
    path: Path, specification: Path | None = None, on_progress: OnProgress | None = None
) -> JudgedRun:
    """Judge a recording, by its own specification if there is no other.

    Raises:
        RecordingError: The recording cannot be read.
        ReplayError: It is not a recording of 'traffic run', or its network has changed.
        SpecificationErrors: The specification has faults.
        RequestError: The specification cannot be read, or has none of the recorded outputs.
        NetworkError: The network of roads cannot be read.
    """
    with open_run(path) as recording:
        return JudgedRun(path, specification, _judged(recording, specification, on_progress))


def document_from(judged: JudgedRun) -> dict[str, Any]:
    """Return what was found as plain data; times are milliseconds."""
    judgement = judged.judgement
    return {
        "recording": str(judged.recording),
        "specification": None if judged.specification is None else str(judged.specification),
        "satisfied": judgement.is_satisfied,
        "streams": len(judgement.findings),
        "samples": sum(finding.samples for finding in judgement.findings),
        "breaches": judgement.breach_count,
        "unjudged": list(judgement.unjudged),
        "findings": [_plain_finding(finding) for finding in judgement.findings],
    }


def _plain_finding(finding: Finding) -> dict[str, Any]:
    return {
        "stream": finding.stream,
        "definition": str(finding.definition),
        "holds": finding.holds,
        "samples": finding.samples,
        "compared_with": finding.basis.value,
        "breach_count": finding.breach_count,
        "breaches": [_plain_breach(breach) for breach in finding.breaches],
        "unjudged": list(finding.unjudged),
    }


def _plain_breach(breach: Breach) -> dict[str, Any]:
    return {
        "definition": str(breach.definition),
        "valid_time": _plain_time(breach.valid_time),
        "available_time": _plain_time(breach.available_time),
        "expected": breach.expected,
        "found": breach.found,
    }


def _plain_time(time: TimePoint | None) -> float | None:
    return None if time is None else time / MILLISECOND


def _judged(recording: Recording, path: Path | None, on_progress: OnProgress | None) -> Judgement:
    description = describe(recording)
    specification = (
        description.specification if path is None else read_specification(path, "SPECIFICATION")
    )
    outputs = _outputs(specification, description, path)
    build = _Builder(description, specification, outputs, world_of(recording))
    network = declared_network(build, SORTS, _SAID_AGAIN)
    until = TimePoint(description.origin.scenario.duration)
    execution = RecordedExecution(
        recording, until, without=(TRUTH,), is_complete=description.is_complete
    )
    judgement = judge(network, execution, on_progress=on_progress)
    judgement = _about_images(judgement, network, image_labels(specification))
    if execution.is_whole:
        return judgement
    end = text_from_duration(execution.until + 1)
    rest = f"what came from {end} ms on: the recording ends there"
    return replace(judgement, unjudged=(*judgement.unjudged, rest))


def _outputs(
    specification: Specification, description: RunDescription, path: Path | None
) -> tuple[str, ...]:
    """Return the output streams of the run that the specification declares.

    Raises:
        RequestError: There is none.
    """
    declared = Declarations(specification).streams
    outputs = tuple(name for name in description.outputs if name in declared)
    if not outputs:
        wanted = f"a specification with one of the outputs {', '.join(description.outputs)}"
        raise RequestError("SPECIFICATION", wanted, path)
    return outputs


def _about_images(
    judgement: Judgement, network: DeclaredNetwork, images: Collection[str]
) -> Judgement:
    """Say of streams of images that they never are recorded, which is no news to anyone."""
    streams = [*network.outputs, *chain(*(each.inputs for each in network.processes.values()))]
    of_images = {stream.topic for stream in streams if stream.provider in images} | {*images}
    findings = tuple(
        replace(each, unjudged=(_IMAGES,))
        if each.stream in of_images and NOT_RECORDED in each.unjudged
        else each
        for each in judgement.findings
    )
    return replace(judgement, findings=findings)


class _Builder:
    """Makes the network of a run again and again; chance begins anew each time."""

    def __init__(
        self,
        description: RunDescription,
        specification: Specification,
        outputs: tuple[str, ...],
        world: World,
    ) -> None:
        declared = Declarations(specification)
        known = implementations_of(self._anew(world, description)).sources
        self._description = description
        self._specification = specification
        self._outputs = outputs
        self._world = world
        self._parameters = {
            name: value
            for name, value in description.parameters.items()
            if name in declared.parameters
        }
        self._foreign: dict[str, Callable[[], Source]] = {
            name: _Nowhere for name in declared.sources if name not in known
        }

    def __call__(
        self,
        specification: Specification | None = None,
        sources: Mapping[str, Callable[[], Source]] | None = None,
        outputs: Collection[str] = (),
    ) -> Network:
        """Return a network that nobody has run."""
        world = self._anew(self._world, self._description)
        system = MonitoringSystem(
            world,
            self._parameters,
            (*self._outputs, *outputs),
            specification=specification or self._specification,
            sources={**self._foreign, **(sources or {})},
        )
        return system.network

    @staticmethod
    def _anew(world: World, description: RunDescription) -> World:
        _, sensors = generators_of(int(description.origin.request["seed"] or 0))
        return replace(world, generator=sensors)


class _Nowhere:
    """A source whose samples are to come from a recording."""

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield nothing."""
        return iter(())

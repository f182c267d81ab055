"""One replay: the system of a recorded run, or a changed one, on what was recorded."""

import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path

from dyknow.kpl.syntax import Specification
from dyknow.recordings.comparing import Difference, compare
from dyknow.recordings.recording import Recording
from dyknow.recordings.violations import VIOLATIONS
from dyknow.time import MILLISECOND, Duration, TimePoint, text_from_duration
from traffic.explaining.keeping import explanations_kept
from traffic.origin import write_origin
from traffic.recording.changes import changes_since, detail_of
from traffic.recording.describing import RunDescription
from traffic.recording.periods import PeriodRepeater
from traffic.recording.rebuilding import (
    describe,
    open_run,
    recorded_labels,
    simulation_of,
    system_of,
    take,
    world_of,
)
from traffic.recording.writing import recorded
from traffic.request import RecordingRequest, labels_from
from traffic.results import Replay, RunResult, StreamDifference, run_folder, write_result
from traffic.running import scorer_for, write_network
from traffic.sumo.replayed import TRUTH, FramePacer
from traffic.system import outputs_behind, outputs_of, read_specification
from traffic.watching import OnProgress, Watch, told_of

__all__ = ["ReplayRequest", "replay"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayRequest:
    """What a user asks of a replay.

    Attributes:
        path: The recording.
        specification: File of the network of processes; None for the recorded one.
        taken: Labels of the streams that are taken from the recording, not computed.
        out: Folder for the result; None for none.
        recording: The streams of the replay in a file, if wanted.
        real_time: Whether to keep to the clock on the wall.
    """

    path: Path
    specification: Path | None = None
    taken: tuple[str, ...] = ()
    out: Path | None = None
    recording: RecordingRequest | None = None
    real_time: bool = False

    @classmethod
    def from_texts(
        cls,
        *,
        path: Path,
        specification: Path | None = None,
        taken: str | None = None,
        out: Path | None = None,
        record: Path | None = None,
        real_time: bool = False,
    ) -> "ReplayRequest":
        """Read what a user wrote on the command line.

        Raises:
            RequestError: An option is impossible.
        """
        return cls(
            path=path,
            specification=specification,
            taken=() if taken is None else labels_from(taken, "--from"),
            out=out,
            recording=RecordingRequest.from_texts(record=record),
            real_time=real_time,
        )


def replay(request: ReplayRequest, on_progress: OnProgress) -> RunResult:
    """Do what is asked; return the result, which says how the streams compare.

    Raises:
        RecordingError: The recording cannot be read.
        TrafficError: It cannot be replayed like this, or the result cannot be written.
        SpecificationErrors: The specification has faults.
        NetworkError: The network cannot be read.
    """
    with open_run(request.path) as recording:
        if request.out is None:
            return _Replay(request, recording).complete(on_progress)
        with run_folder(request.out) as folder:
            replayed = _Replay(request, recording)
            with replayed.explained(folder):
                result = replayed.complete(on_progress)
            replayed.write(result, folder)
        return result


class _Replay:
    """The parts of one replay, connected."""

    def __init__(self, request: ReplayRequest, recording: Recording) -> None:
        self._request = request
        self._recording = recording
        self._recorded = describe(recording)
        self._specification = self._recorded.specification
        text, place = self._recorded.text, self._recorded.place
        if request.specification is not None:
            self._specification = read_specification(request.specification)
            text, place = request.specification.read_text("utf-8"), str(request.specification)
        fed = take(request.taken, self._specification, recording)
        self._world = world_of(recording)
        self._system = system_of(recording, fed, self._world, self._outputs(fed))
        self._description = replace(
            self._recorded, text=text, place=place, outputs=self._system.network.outputs
        )
        self._changes = list(
            changes_since(self._recorded, self._specification, self._system.files)
        )
        if not self._recorded.is_complete:
            self._changes.append(f"a part of the run is missing: {_completeness(recording)}")
        self._is_changed = self._specification != self._recorded.specification
        self._notes = list(_notes(request, recording, self._recorded))

    def complete(self, on_progress: OnProgress) -> RunResult:
        """Run to the end, and compare what came with what was recorded."""
        with tempfile.TemporaryDirectory(prefix="traffic-") as folder:
            wanted = self._request.recording or RecordingRequest(
                Path(folder) / "replay.mcap", self._labels_to_compare()
            )
            result = self._run(wanted, on_progress)
            with open_run(wanted.path) as computed:
                said = self._compare(computed)
        return result.model_copy(update={"replay": said})

    def explained(self, folder: Path) -> AbstractContextManager[None]:
        """Keep what explains the recognitions in *folder* while the block lasts."""
        return explanations_kept(self._system, self._world.road_map, folder)

    def write(self, result: RunResult, folder: Path) -> None:
        """Write the result, its origin, and the network into *folder*."""
        said = self._description
        write_origin(said.origin, said.named_text, self._system.files, folder)
        write_network(self._system.network, folder)
        write_result(result, folder)

    def _outputs(self, fed: Specification) -> tuple[str, ...]:
        """Return the output streams to compute: not those that the recorded run had no use for."""
        taken = self._request.taken
        unwanted = set(outputs_of(self._recorded.specification)) - {*self._recorded.outputs}
        outputs = outputs_behind(fed, taken) if taken else outputs_of(fed)
        return tuple(name for name in outputs if name not in unwanted)

    def _run(self, wanted: RecordingRequest, on_progress: OnProgress) -> RunResult:
        truth = simulation_of(self._recording)
        scorer = None if truth is None else scorer_for(self._world, truth, self._system)
        watch = Watch(self._system, scorer, is_governed=False)
        told = told_of(self._description.origin)
        if not self._recorded.is_complete:
            told = replace(told, duration=Duration(_end_of(self._recording)))
        network = self._world.road_map, truth
        with recorded(wanted, self._description, self._system, *network) as keep:
            seen = [keep.observe] if scorer is None else [keep.observe, scorer.observe_frame]
            kernel = self._system.network.kernel
            companion = _Companion(
                PeriodRepeater(kernel, self._recorded.period_changes),
                None if truth is None else FramePacer(truth, seen),
            )
            return watch.complete(told, on_progress, companion, real_time=self._request.real_time)

    def _compare(self, computed: Recording) -> Replay:
        topics = self._topics_to_compare(computed)
        found = compare(self._recording, computed, topics)
        if not self._recorded.is_complete:
            found = [each for each in found if self._is_recorded(each)]
        return Replay(
            recording=str(self._recording.path),
            changes=self._changes,
            notes=self._notes,
            taken=list(self._request.taken),
            compared=len(topics),
            identical=len(topics) - len(found),
            differences=[
                StreamDifference(
                    stream=each.topic,
                    at=each.time / MILLISECOND,
                    what=each.what + detail_of(each, self._recording, computed),
                )
                for each in found
            ],
        )

    def _is_recorded(self, difference: Difference) -> bool:
        """Return whether the recording has a sample where a difference is, damaged as it is."""
        gap = self._recording.gap
        if gap is not None and difference.time >= gap:
            return False
        stream = self._recording.streams.get(difference.topic)
        return stream is not None and 0 < difference.number <= stream.count

    def _labels_to_compare(self) -> tuple[str, ...]:
        """Return the labels of what was recorded and is part of the replay."""
        built = self._system.network.kernel.labels
        return tuple(label for label in recorded_labels(self._recording) if label in built)

    def _topics_to_compare(self, computed: Recording) -> frozenset[str]:
        """Return the topics of the streams that were recorded and are computed.

        With the same specification these must be all; with another one, or when some streams
        are taken from the recording, it is what both recordings have.
        """
        kernel = self._system.network.kernel
        fed = {label for label in kernel.labels if kernel.generator(label).depth == 0}
        before, now = self._recording.topics - {TRUTH}, computed.topics - {TRUTH}
        if self._request.taken or self._is_changed:
            return (before & now) - fed - {VIOLATIONS}
        return (before | (now & {VIOLATIONS})) - fed


class _Companion:
    """Repeats what came to the recorded network from outside, besides its sources."""

    def __init__(self, periods: PeriodRepeater, truths: FramePacer | None) -> None:
        self._periods = periods
        self._truths = truths

    def advance(self, now: TimePoint) -> None:
        """Take note that the work of the instant *now* begins."""
        self._periods.advance(now)
        if self._truths is not None:
            self._truths.advance(now)

    def finish(self) -> None:
        """Take note that the run is over."""
        if self._truths is not None:
            self._truths.finish()


def _end_of(recording: Recording) -> TimePoint:
    """Return when the last sample became available before anything is missing."""
    times = [stream.last for stream in recording.streams.values() if stream.last is not None]
    end = max(times, default=TimePoint(0))
    return end if recording.gap is None else recording.gap


def _completeness(recording: Recording) -> str:
    if recording.damage is not None:
        return str(recording.damage)
    return f"it ends at {text_from_duration(_end_of(recording))} ms"


def _notes(
    request: ReplayRequest, recording: Recording, recorded: RunDescription
) -> Iterator[str]:
    """Yield what else a user should know."""
    place = Path(recorded.place)
    if request.specification is None and place.is_file() and place.read_text() != recorded.text:
        yield f"{place} has been edited since the recording; the recorded text is replayed"
    if TRUTH not in recording.streams:
        yield "no truth was recorded, so that nothing is scored"

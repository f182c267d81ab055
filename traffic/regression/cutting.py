"""A piece of the recording of a run, as a recording of its own that begins at time 0.

Only what came from outside is kept, and the truth for scoring: everything else is computed again
by whoever replays it.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import Recording
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import Duration, TimePoint, text_from_duration
from traffic.errors import ReplayError, RequestError
from traffic.recording.codecs import CODECS
from traffic.recording.describing import COMPLETE, RunDescription
from traffic.recording.rebuilding import (
    describe,
    open_run,
    recorded_sources,
    simulation_of,
)
from traffic.sumo.replayed import TRUTH, FrameKeeper

__all__ = ["Piece", "cut", "refuse_unfinished"]

_SINCE = "since"


@dataclass(frozen=True, slots=True)
class Piece:
    """From when to when.

    Attributes:
        begin: Where time 0 of the piece is.
        end: The time of its last samples.
    """

    begin: Duration
    end: Duration

    def shifted(self, samples: Iterable[Sample[Any] | Heartbeat]) -> Iterator[Sample[Any]]:
        """Yield the samples that are valid in the piece, in its own time."""
        for sample in samples:
            if isinstance(sample, Heartbeat) or not self._has(sample.valid_time):
                continue
            valid, available = sample.valid_time, sample.available_time
            value = self._in_own_time(sample.value)
            yield Sample(value, TimePoint(valid - self.begin), TimePoint(available - self.begin))

    def _in_own_time(self, value: Any) -> Any:
        """Return a value of a source; the only times in one are those since which signals show."""
        if isinstance(value, Table) and _SINCE in value:
            return value.with_columns(**{_SINCE: value[_SINCE] - self.begin})
        return value

    def _has(self, time: TimePoint) -> bool:
        return self.begin <= time <= self.end


def cut(path: Path, piece: Piece, out: Path, outputs: Sequence[str] | None = None) -> None:
    """Write a piece of the recording at *path* to *out*.

    Args:
        path: The recording of a run.
        piece: The piece.
        out: What is written.
        outputs: Output streams that a replay of the piece has; those of the run by default.

    Raises:
        RecordingError: It is no recording, or damaged, or *out* exists.
        RequestError: The piece is not in it.
        ReplayError: It is not a recording of 'traffic run', or does not go to its end.
    """
    with open_run(path) as recording:
        said = describe(recording)
        refuse_unfinished(recording, said)
        if outputs is not None:
            said = replace(said, outputs=tuple(outputs))
        length = said.origin.scenario.duration
        if not 0 <= piece.begin < piece.end <= length:
            whole = text_from_duration(length)
            found = f"{text_from_duration(piece.begin)} to {text_from_duration(piece.end)} ms"
            raise RequestError("--from, --to", f"a piece of the {whole} ms of '{path}'", found)
        metadata = _described(said, piece).as_metadata()
        with Recorder(out, metadata=metadata, codecs=CODECS) as recorder:
            for label, source in recorded_sources(recording, said.specification).items():
                write = recorder.generator(label)
                for sample in piece.shifted(source().samples()):
                    write(sample)
            _cut_truth(recording, piece, recorder)
            recorder.annotate(COMPLETE)


def refuse_unfinished(recording: Recording, said: RunDescription) -> None:
    """Raise a `ReplayError` if a recording does not have all of its run.

    What is missing would look like something that was not recognised.
    """
    if said.is_complete:
        return
    why = "it ends before its run does" if recording.damage is None else str(recording.damage)
    why = why.removeprefix(f"{recording.path}: ")
    raise ReplayError(recording.path, f"not all of its run is there: {why}")


def _described(said: RunDescription, piece: Piece) -> RunDescription:
    scenario = said.origin.scenario.model_copy(
        update={"duration": Duration(piece.end - piece.begin)}
    )
    return replace(said, origin=said.origin.model_copy(update={"scenario": scenario}))


def _cut_truth(recording: Recording, piece: Piece, recorder: Recorder) -> None:
    simulation = simulation_of(recording)
    if simulation is None:
        return
    write, keeper = recorder.generator(TRUTH), FrameKeeper(simulation)
    while (frame := simulation.step()) is not None and frame.time <= piece.end:
        if frame.time >= piece.begin:
            write(keeper.sample(replace(frame, time=TimePoint(frame.time - piece.begin))))

"""A piece of the recording of a run, as a recording of its own that begins at time 0.

Only what came from outside is kept, and the truth for scoring: everything else is computed again
by whoever replays it.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import Recording
from dyknow.streams.sample import Heartbeat, Sample
from dyknow.time import Duration, TimePoint, text_from_duration
from traffic.errors import RequestError
from traffic.recording.codecs import CODECS
from traffic.recording.describing import COMPLETE, RunDescription
from traffic.recording.rebuilding import (
    describe,
    open_run,
    recorded_sources,
    simulation_of,
)
from traffic.sumo.replayed import TRUTH, FrameKeeper

__all__ = ["Piece", "cut"]


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
            yield Sample(
                sample.value, TimePoint(valid - self.begin), TimePoint(available - self.begin)
            )

    def _has(self, time: TimePoint) -> bool:
        return self.begin <= time <= self.end


def cut(path: Path, piece: Piece, out: Path) -> None:
    """Write a piece of the recording at *path* to *out*.

    Raises:
        RecordingError: It is no recording, or damaged, or *out* exists.
        RequestError: The piece is not in it.
        ReplayError: It is not a recording of 'traffic run'.
    """
    with open_run(path) as recording:
        said = describe(recording)
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

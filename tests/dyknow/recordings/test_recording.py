"""Recordings give back what was recorded."""

from pathlib import Path

from dyknow.recordings.recorder import Recorder
from dyknow.recordings.recording import open_recording
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.time import TimePoint


def test_samples_come_back_as_they_were(tmp_path: Path) -> None:
    """What one stream has said is read again, value for value."""
    path = tmp_path / "run.mcap"
    said = [
        Sample(1.5, TimePoint(0), TimePoint(3)),
        Heartbeat(TimePoint(7), TimePoint(8)),
        Sample(NO_VALUE, TimePoint(9), TimePoint(9)),
        Sample("far", TimePoint(8), TimePoint(10)),
        Sample(None, TimePoint(-4), TimePoint(11)),
    ]

    with Recorder(path, metadata={"parameters": "{}"}) as recorder:
        tap = recorder.generator("distance[car1]")
        for element in said:
            tap(element)

    with open_recording(path) as recording:
        assert list(recording.contents("distance[car1]")) == said
        assert recording.metadata == {"parameters": "{}"}

"""A piece of a recording, as a recording of its own."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.sample import Heartbeat, Sample
from dyknow.streams.table import Table
from dyknow.time import TimePoint
from tests.support.regression import piece, seconds
from traffic.errors import ReplayError, RequestError
from traffic.recording.rebuilding import describe, open_run, recorded_labels, simulation_of
from traffic.regression.cutting import Piece, cut
from traffic.sumo.replayed import TRUTH


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    times=st.lists(st.integers(0, 50), unique=True).map(sorted),
    begin=st.integers(0, 40),
    length=st.integers(1, 30),
)
def test_the_samples_of_a_piece_are_those_between_both_times(
    times: list[int], begin: int, length: int
) -> None:
    """Each is as long after time 0 as it was after the beginning of the piece."""
    samples = [Sample(time, TimePoint(time), TimePoint(time + 3)) for time in times]

    found = list(Piece(seconds(0) + begin, begin + length).shifted([*samples, Heartbeat(1, 1)]))

    expected = [time for time in times if begin <= time <= begin + length]
    assert [sample.value for sample in found] == expected
    assert [sample.valid_time + begin for sample in found] == expected
    assert [sample.available_time + begin - 3 for sample in found] == expected


def test_times_in_values_are_of_the_piece_too() -> None:
    """Since when a signal shows what it shows; that may be before time 0."""
    since = np.array([0, seconds(12)], dtype=np.int64)
    table = Table("signal", (0, 1), {"since": since, "state": np.array([1, 2])})

    (found,) = piece(10, 20).shifted([Sample(table, seconds(12), seconds(12))])

    assert found.value["since"].tolist() == [-seconds(10), seconds(2)]
    assert found.value["state"].tolist() == [1, 2]


@pytest.mark.sumo
@pytest.mark.slow
def test_a_piece_has_the_sources_and_the_truth_in_its_own_time(
    recording: Path, tmp_path: Path
) -> None:
    """Sample by sample what was recorded between both times, the first of them at zero."""
    out = tmp_path / "piece.mcap"
    cut(recording, piece(5, 12), out)

    with open_run(recording) as whole, open_run(out) as part:
        assert {"vehicles", TRUTH} <= part.topics
        assert "cars" not in recorded_labels(part)
        expected = [
            (each.valid_time - seconds(5), each.value["position"].tolist())
            for each in whole.samples("vehicles")
            if seconds(5) <= each.valid_time <= seconds(12)
        ]
        found = [(s.valid_time, s.value["position"].tolist()) for s in part.samples("vehicles")]
        before, after = simulation_of(whole), simulation_of(part)
        assert before is not None
        assert after is not None
        first = after.step()
        while (frame := before.step()) is not None and frame.time < seconds(5):
            pass
        assert first is not None
        assert frame is not None
        assert describe(part).origin.scenario.duration == seconds(7)

    assert found == expected
    assert [after.names[i] for i in first.vehicles.ids] == [
        before.names[i] for i in frame.vehicles.ids
    ]


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize(("begin", "end"), [(5, 5), (6, 5), (0, 21), (-1, 3)])
def test_a_piece_must_be_in_the_recording(
    recording: Path, tmp_path: Path, begin: float, end: float
) -> None:
    """From before to, inside of the whole; nothing is written otherwise."""
    with pytest.raises(RequestError, match="a piece of the 20000 ms"):
        cut(recording, piece(begin, end), tmp_path / "x.mcap")
    assert not list(tmp_path.iterdir())


@pytest.mark.sumo
@pytest.mark.slow
def test_nothing_is_cut_out_of_a_recording_that_is_cut_off(
    recording: Path, tmp_path: Path
) -> None:
    """What is missing would look like what was not recognised."""
    half = tmp_path / "half.mcap"
    shutil.copy(recording, half)
    with half.open("r+b") as file:
        file.truncate(recording.stat().st_size // 2)

    with pytest.raises(ReplayError, match="not all of its run is there: the recording is cut off"):
        cut(half, piece(0, 1), tmp_path / "x.mcap")
    assert list(tmp_path.iterdir()) == [half]

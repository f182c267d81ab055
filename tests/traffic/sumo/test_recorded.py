"""Recorded poses and their replay."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import RecordingError
from traffic.sumo.recorded import RecordedSimulation, write_recording
from traffic.sumo.simulation import Frame, Simulation

HEAD = "t,vehicle,x,y,heading,speed,length,width\n"


def replay(simulation: Simulation) -> Iterator[Frame]:
    """Yield all frames."""
    while (frame := simulation.step()) is not None:
        yield frame


def recorded(text: str, folder: Path) -> RecordedSimulation:
    """Return the replay of a CSV text."""
    path = folder / "r.csv"
    path.write_text(text)
    return RecordedSimulation(path)


def test_rows_of_one_time_are_a_frame(tmp_path: Path) -> None:
    """Times need not be regular, vehicles come and go, and what is unknown has a default."""
    simulation = recorded(
        HEAD + "0,a,1,2,0,5,4,2\n0,b,3,4,1,6,5,2\n40.5,b,5,6,1,6,5,2\n", tmp_path
    )

    first, second = replay(simulation)

    assert simulation.names == ("a", "b")
    assert (first.time, second.time) == (0, 40.5 * MILLISECOND)
    assert first.vehicles.ids.tolist() == [0, 1]
    assert second.vehicles.ids.tolist() == [1]
    assert second.vehicles["position"].tolist() == [[5, 6]]
    assert second.vehicles["height"].tolist() == [1.5]
    assert second.hidden["lane"].tolist() == [-1]
    assert simulation.step() is None


def test_a_closed_replay_is_over(tmp_path: Path) -> None:
    """After closing there are no more frames; closing twice is no fault."""
    simulation = recorded(HEAD + "0,a,1,2,0,5,4,2\n", tmp_path)

    simulation.close()
    simulation.close()

    assert simulation.step() is None


def test_a_recording_without_rows_has_no_frames(tmp_path: Path) -> None:
    """Nothing recorded is nothing replayed."""
    assert recorded(HEAD, tmp_path).step() is None


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (HEAD.replace("heading", "headign"), "the column 'heading' is missing; is it 'headign'?"),
        (HEAD + "0,a,1,x,0,5,4,2\n", "row 1: expected a number for 'y', found 'x'"),
        (HEAD + "0,a,1,,0,5,4,2\n", "row 1: expected a number for 'y', found 'nan'"),
        (HEAD + "5,a,1,2,0,5,4,2\n0,a,1,2,0,5,4,2\n", "row 2: time 0 follows 5"),
        ((HEAD + "0,a,1,2,0,5,4,2\n") * 2, "row 2: expected a number for 't', found 't'"),
        (HEAD + "0,a,1,2,0,5,4,2\n0,a,1,2,0,5,4,2\n", "row 2: vehicle 'a' is there twice at 0"),
        (HEAD + "0,a,1,2,0,5,4,2,9\n", "is not a recording"),
        (HEAD + '0,"a', "is not a recording"),
        ("", "is not a recording"),
    ],
)
def test_faults_of_a_recording_are_told(text: str, fault: str, tmp_path: Path) -> None:
    """Each fault names the file, and the row if there is one."""
    with pytest.raises(RecordingError) as caught:
        recorded(text, tmp_path)

    assert fault in str(caught.value)
    assert str(tmp_path / "r.csv") in str(caught.value)


def test_missing_and_broken_files_are_told(tmp_path: Path) -> None:
    """A missing file and a file that is no archive give a message."""
    (tmp_path / "broken.npz").write_bytes(b"PK\x03\x04nothing")

    for name in ("missing.csv", "missing.npz", "broken.npz"):
        with pytest.raises(RecordingError, match=name):
            RecordedSimulation(tmp_path / name)


@given(
    moments=st.lists(st.lists(st.integers(0, 4), unique=True, min_size=1), max_size=5),
    suffix=st.sampled_from([".csv", ".npz"]),
)
@settings(derandomize=True, deadline=None, max_examples=40)
def test_what_is_recorded_is_replayed(
    moments: list[list[int]], suffix: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Writing frames and replaying them gives the same vehicles at the same times."""
    path = tmp_path_factory.mktemp("r") / f"r{suffix}"
    generator = np.random.default_rng(len(moments))
    frames = [_frame(i, ids, generator) for i, ids in enumerate(moments)]
    names = [f"vehicle {i}" for i in range(5)]

    write_recording(frames, names, ["lane_0", "lane_1"], path)
    simulation = RecordedSimulation(path)
    replayed = list(replay(simulation))

    assert [frame.time for frame in replayed] == [frame.time for frame in frames]
    for one, other in zip(replayed, frames, strict=True):
        assert [simulation.names[i] for i in one.vehicles.ids] == [
            names[i] for i in other.vehicles.ids
        ]
        for name, column in other.vehicles.columns.items():
            np.testing.assert_allclose(one.vehicles[name], column)
        lanes = [simulation.lanes[i] if i >= 0 else None for i in one.hidden["lane"]]
        assert lanes == [f"lane_{i}" if i >= 0 else None for i in other.hidden["lane"]]


def _frame(number: int, ids: list[int], generator: np.random.Generator) -> Frame:
    n = len(ids)
    columns = {
        "position": generator.normal(size=(n, 2)) * 100,
        **{
            name: generator.random(n) for name in ("heading", "speed", "length", "width", "height")
        },
        "colour": generator.integers(0, 256, size=(n, 3)).astype(np.uint8),
        "vehicle_class": generator.integers(0, 7, size=n).astype(np.int8),
    }
    hidden = {
        "lane": generator.integers(-1, 2, size=n).astype(np.int32),
        "lane_position": generator.random(n),
    }
    time = TimePoint(number * 40 * MILLISECOND)
    return Frame(time, Table("vehicle", ids, columns), Table("vehicle", ids, hidden))

"""The regression suite: cutting, replaying, telling what differs."""

import shutil
from pathlib import Path

import pytest

from dyknow.time import SECOND, Duration
from traffic.errors import RequestError
from traffic.recording.rebuilding import describe, open_run, recorded_labels, simulation_of
from traffic.regression.cutting import Piece, cut
from traffic.regression.regressing import Addition, add, regress, update
from traffic.regression.request import RegressionRequest
from traffic.regression.suite import Entry, bundled_suite, entries
from traffic.request import RecordingRequest, RunRequest
from traffic.running import run_scenario
from traffic.sumo.replayed import TRUTH

pytestmark = [pytest.mark.sumo, pytest.mark.slow]


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a recording of 20 s on the rural road, from positions that are 1 m wrong."""
    folder = tmp_path_factory.mktemp("recorded")
    request = RunRequest.from_texts(
        scenario="rural",
        view="truth",
        position_noise=1.0,
        duration="20 s",
        recognise="turns,overtakes",
        out=folder / "run",
        record=folder / "run.mcap",
    )
    assert request.recording == RecordingRequest(folder / "run.mcap")
    run_scenario(request, lambda *_: None)
    return folder / "run.mcap"


def seconds(value: float) -> Duration:
    """Return a duration of so many seconds."""
    return Duration(int(value * SECOND))


def test_a_piece_has_the_sources_and_the_truth_in_its_own_time(
    recording: Path, tmp_path: Path
) -> None:
    """Sample by sample what was recorded between both times, the first of them at zero."""
    out = tmp_path / "piece.mcap"
    cut(recording, Piece(seconds(5), seconds(12)), out)

    with open_run(recording) as whole, open_run(out) as piece:
        assert {"vehicles", TRUTH} <= piece.topics
        assert "cars" not in recorded_labels(piece)
        expected = [
            (each.valid_time - seconds(5), each.value["position"].tolist())
            for each in whole.samples("vehicles")
            if seconds(5) <= each.valid_time <= seconds(12)
        ]
        found = [(s.valid_time, s.value["position"].tolist()) for s in piece.samples("vehicles")]
        before, after = simulation_of(whole), simulation_of(piece)
        assert before is not None
        assert after is not None
        first = after.step()
        while (frame := before.step()) is not None and frame.time < seconds(5):
            pass
        assert first is not None
        assert frame is not None
        assert describe(piece).origin.scenario.duration == seconds(7)

    assert found == expected
    assert [after.names[i] for i in first.vehicles.ids] == [
        before.names[i] for i in frame.vehicles.ids
    ]


def test_what_is_recognised_otherwise_is_told_as_a_diff(recording: Path, tmp_path: Path) -> None:
    """A line too many and a line that is missing; nothing when all is as expected."""
    entry = add(Addition(recording, Piece(seconds(0), seconds(15)), Entry(tmp_path, "rural")))
    text = entry.expected.read_text("utf-8")
    lines = text.splitlines(keepends=True)

    (same,) = regress([entry])
    entry.expected.write_text("".join([*lines[:-1], "  1.0  2.0  flight[car1]\n"]))
    (different,) = regress([entry])
    changed = list(update([entry]))

    assert same.difference == ()
    assert "overtake[" in text
    assert "-  1.0  2.0  flight[car1]" in different.difference
    assert f"+{lines[-1].rstrip()}" in different.difference
    assert changed == [entry]
    assert entry.expected.read_text("utf-8") == text
    assert list(update([entry])) == []


@pytest.mark.parametrize(("begin", "end"), [(5, 5), (6, 5), (0, 21), (-1, 3)])
def test_a_piece_must_be_in_the_recording(
    recording: Path, tmp_path: Path, begin: float, end: float
) -> None:
    """From before to, inside of the whole; nothing is written otherwise."""
    with pytest.raises(RequestError, match="a piece of the 20000 ms"):
        cut(recording, Piece(seconds(begin), seconds(end)), tmp_path / "x.mcap")
    assert not list(tmp_path.iterdir())


def test_requests_are_checked(recording: Path, tmp_path: Path) -> None:
    """Options that have no meaning without others, names that are none, folders that are not."""
    shutil.copy(recording, tmp_path / "one.mcap")
    texts = RegressionRequest.from_texts

    assert texts(suite=tmp_path, names=["one"]).entries == (Entry(tmp_path, "one"),)
    assert texts(suite=tmp_path, add=recording, name="two").addition == Addition(
        recording, Piece(Duration(0), seconds(20)), Entry(tmp_path, "two")
    )
    for options, said in (
        ({"names": ["on"]}, "did you mean 'one'"),
        ({"suite": tmp_path / "no"}, "a folder with recordings"),
        ({"name": "x"}, "only has a meaning with --add"),
        ({"end": "3s"}, "only has a meaning with --add"),
        ({"add": recording}, "a name of small letters"),
        ({"add": recording, "name": "a b"}, "a name of small letters"),
        ({"add": recording, "name": "x", "update": True}, "neither names nor --update"),
        ({"add": recording, "name": "x", "begin": "soon"}, "a time such as"),
    ):
        with pytest.raises(RequestError, match=said):
            texts(**{"suite": tmp_path, **options})  # type: ignore[arg-type]


@pytest.mark.golden
@pytest.mark.parametrize("entry", entries(bundled_suite()), ids=lambda entry: entry.name)
def test_recorded_scenarios_are_recognised_as_expected(entry: Entry) -> None:
    """Every recording of the suite, with the specification and the chronicles as they are now."""
    (found,) = regress([entry])

    assert found.difference == ()

"""Replays: the same again, or with a changed specification, and blind to the truth."""

import ast
import shutil
from pathlib import Path

import pytest

from dyknow.errors import SpecificationErrors
from dyknow.recordings.errors import RecordingError
from tests.support.judging import assert_judged_correct
from traffic.errors import ReplayError, RequestError, ResultError
from traffic.features.moving import Moving
from traffic.replaying import ReplayRequest, replay
from traffic.request import RunRequest
from traffic.results import read_result
from traffic.running import run_scenario
from traffic.system import bundled_specification

ROOT = Path(__file__).parents[2]
FROM_PERCEPTS = """
source percepts seen
compunit world_objects WorldObject(percepts)
strmgen percepts[truth] = seen
strmgen world_objects = link(
    percepts[truth] with sample every 100, use most recent, max delay 0, from 0 to oo,
    WorldObject, establish = eventually [200, oo] true, reestablish = false, maintain = true,
    remove_after = 1 s)
stream world_objects = world_objects
"""


def again(path, **options):
    """Replay a recording and return the result."""
    return replay(ReplayRequest.from_texts(path=path, **options), lambda *_: None)


def edited(old, new, path):
    """Write the bundled specification to *path* with one text replaced."""
    text = bundled_specification().read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


@pytest.mark.sumo
def test_an_unchanged_replay_is_the_same_to_the_last_byte(recorded_run):
    """Every computed stream, every input and output, the recognitions and the score."""
    result = again(recorded_run.path)

    assert result.replay is not None
    assert result.replay.differences == []
    assert result.replay.changes == result.replay.notes == []
    assert result.replay.compared == result.replay.identical > 25
    for name in ("recognitions", "missed", "score", "settings", "violations"):
        assert getattr(result, name) == getattr(recorded_run.result, name)


@pytest.mark.sumo
def test_a_replay_can_be_recorded_and_replayed_in_turn(recorded_run, tmp_path):
    """Its recording has all that the first one has."""
    first = again(recorded_run.path, record=tmp_path / "again.mcap", out=tmp_path / "run")
    second = again(tmp_path / "again.mcap")

    assert_judged_correct(tmp_path / "again.mcap")
    assert first.replay is not None
    assert second.replay is not None
    assert second.replay.compared == second.replay.identical == first.replay.identical
    assert second.score == recorded_run.result.score
    assert read_result(tmp_path / "run") == first
    names = {path.name for path in (tmp_path / "run").iterdir()}
    assert names == {
        "result.json", "origin.json", "network.json", "specification", "explanations",
    }  # fmt: skip
    origins = [
        (folder / "origin.json").read_text() for folder in (recorded_run.folder, tmp_path / "run")
    ]
    assert origins[0] == origins[1]


@pytest.mark.sumo
def test_what_is_taken_from_the_recording_is_not_computed(recorded_run):
    """From the cars on: no vehicles, no percepts; all that follows is the same."""
    result = again(recorded_run.path, taken="cars")

    assert result.replay is not None
    assert result.replay.taken == ["cars"]
    assert result.replay.compared == result.replay.identical > 15
    assert result.recognitions == recorded_run.result.recognitions
    assert result.score == recorded_run.result.score
    assert {"vehicles", "percepts[truth]", "world_objects"}.isdisjoint(result.timing.stages)


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("taken", "message"),
    [("carz", "--from: .*'cars' or another one of vehicles, "), ("truth/vehicles", "--from: ")],
)
def test_only_recorded_streams_can_be_taken(recorded_run, taken, message):
    """What was recorded is named; the truth is not a stream of the network."""
    with pytest.raises(RequestError, match=message):
        again(recorded_run.path, taken=taken)


@pytest.mark.sumo
def test_a_changed_specification_is_said_in_a_line(recorded_run, tmp_path):
    """Streams may differ then; the first difference of each is named, the earliest first."""
    changed = edited("stability = 500 ", "stability = 300 ", tmp_path / "changed.kpl")
    result = again(recorded_run.path, specification=changed)

    assert result.replay is not None
    assert result.replay.changes == ["the specification, in 'stability'"]
    assert not result.replay.is_fault
    differing = [difference.stream for difference in result.replay.differences]
    assert {"car_attributes", "turns"} <= set(differing)
    assert {"cars", "world_objects"}.isdisjoint(differing)
    times = [difference.at for difference in result.replay.differences]
    assert times == sorted(times)


@pytest.mark.sumo
def test_other_comments_are_no_change(recorded_run, tmp_path):
    """Specifications that mean the same are the same."""
    same = edited("# What a run may choose", "# Choose!", tmp_path / "same.kpl")
    result = again(recorded_run.path, specification=same)

    assert result.replay is not None
    assert result.replay.changes == []
    assert result.replay.differences == []


@pytest.mark.sumo
def test_a_specification_may_begin_further_down(recorded_run, tmp_path):
    """A source is fed with the recorded stream of the generator that is made of it."""
    path = tmp_path / "from.kpl"
    path.write_text(FROM_PERCEPTS)
    result = again(recorded_run.path, specification=path)

    assert set(result.timing.stages) == {"percepts[truth]", "world_objects"}
    assert result.score == {}
    assert result.replay is not None
    assert result.replay.compared == 2


@pytest.mark.sumo
def test_a_source_that_is_not_recorded_is_refused(recorded_run, tmp_path):
    """The message has the place, and what there is."""
    path = tmp_path / "from.kpl"
    path.write_text(FROM_PERCEPTS.replace("percepts[truth]", "percepts[sonar]"))

    with pytest.raises(SpecificationErrors) as caught:
        again(recorded_run.path, specification=path)

    (fault,) = caught.value.exceptions
    assert "the source 'seen' was not recorded; the recording has vehicles," in str(fault)
    assert fault.report().startswith(f"{path}:4:27: ")


@pytest.mark.sumo
def test_a_process_that_computes_otherwise_is_found(recorded_run, monkeypatch):
    """With nothing changed that is a fault of the program; stream, time and columns are named."""

    class Forgetful(Moving):
        """Does not know of the third car that it moves, after a while."""

        def push(self, now, inputs):
            for sample in super().push(now, inputs):
                if now > 2_000_000_000 and len(sample.value) > 2:
                    sample.value["moving"][2] = ~sample.value["moving"][2]
                yield sample

    monkeypatch.setattr("traffic.system.Moving", Forgetful)
    result = again(recorded_run.path)

    assert result.replay is not None
    assert result.replay.is_fault
    difference = next(d for d in result.replay.differences if d.stream == "moving_cars")
    assert difference.at == 2100
    assert difference.what == "it has another value, in moving"
    assert "cars" not in {each.stream for each in result.replay.differences}


@pytest.mark.sumo
def test_a_recording_that_was_cut_off_is_replayed_as_far_as_it_goes(recorded_run, tmp_path):
    """It is said where it ends; what there is comes out the same."""
    cut = tmp_path / "cut.mcap"
    data = recorded_run.path.read_bytes()
    cut.write_bytes(data[: len(data) * 2 // 3])
    result = again(cut)

    assert result.replay is not None
    (change,) = result.replay.changes
    assert change.startswith("a part of the run is missing: ")
    assert result.replay.differences == []
    assert 3 < result.timing.simulated_s < 7


def test_what_is_no_recording_is_refused(tmp_path):
    """Another file, or one of another program."""
    (tmp_path / "x.mcap").write_text("hello")

    with pytest.raises(RecordingError, match="expected a recording in MCAP"):
        again(tmp_path / "x.mcap")


@pytest.mark.sumo
def test_a_changed_network_is_refused(recorded_run, tmp_path, monkeypatch):
    """The map is a part of what was; a bundled network may lie elsewhere now."""
    network = tmp_path / "networks" / "crossing" / "crossing.net.xml"
    network.parent.mkdir(parents=True)
    shutil.copyfile(ROOT / "data" / "networks" / "crossing" / "crossing.net.xml", network)
    monkeypatch.setattr("traffic.recording.rebuilding.data_folder", lambda: tmp_path)
    is_old_place = lambda path: path == network  # noqa: E731
    monkeypatch.setattr(Path, "is_file", is_old_place)
    assert again(recorded_run.path).replay is not None
    network.write_text(network.read_text() + "<!-- edited -->")

    with pytest.raises(ReplayError, match=r"run.mcap: the network .* has changed since"):
        again(recorded_run.path)

    monkeypatch.setattr(Path, "is_file", lambda _: False)
    with pytest.raises(ReplayError, match=r"its network .* is not there any more"):
        again(recorded_run.path)


@pytest.mark.sumo
def test_changed_chronicles_and_versions_are_said(recorded_run, monkeypatch):
    """A line each: files that units read, libraries, the machine."""
    monkeypatch.setattr("traffic.recording.changes.digest_of", lambda _: "other")
    monkeypatch.setattr("traffic.recording.changes.versions", lambda: {"numpy": "0.1"})
    result = again(recorded_run.path)

    assert result.replay is not None
    changes = "\n".join(result.replay.changes)
    assert "the file 'turns.chronicle'" in changes
    assert "numpy: " in changes
    assert "is now 0.1" in changes


@pytest.mark.sumo
def test_the_truth_does_not_reach_the_network(recorded_run, monkeypatch):
    """Without it every stream is the same; there is only no score."""
    monkeypatch.setattr("traffic.replaying.simulation_of", lambda _: None)
    result = again(recorded_run.path)

    assert result.replay is not None
    assert result.replay.compared == result.replay.identical > 25
    assert result.score == {}
    assert {each.agrees for each in result.recognitions} <= {None}


def test_who_knows_of_the_recorded_truth():
    """It is written beside the streams, and read for the score and to be kept again."""
    knowing = {
        path.relative_to(ROOT).as_posix()
        for package in ("traffic", "perception", "anchoring", "chronicles", "dyknow", "networks")
        for path in (ROOT / package).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module == "traffic.sumo.replayed"
    }

    assert knowing <= {
        "traffic/judging.py",  # leaves it out
        "traffic/replaying.py",
        "traffic/recording/rebuilding.py",
        "traffic/recording/writing.py",
        "traffic/regression/cutting.py",
        "traffic/regression/regressing.py",
    }


@pytest.mark.sumo
def test_a_folder_that_exists_is_not_touched(recorded_run, tmp_path):
    """As for a run."""
    with pytest.raises(ResultError, match="exists already"):
        again(recorded_run.path, out=tmp_path)


@pytest.mark.sumo
@pytest.mark.slow
def test_a_vision_run_is_replayed_from_the_vehicles(tmp_path):
    """Images are drawn again, the same; those that were recorded are for looking at."""
    request = RunRequest.from_texts(
        scenario="crossing",
        duration="1 s",
        out=tmp_path / "run",
        record=tmp_path / "run.mcap",
        record_images=True,
    )
    run_scenario(request, lambda *_: None)
    result = again(tmp_path / "run.mcap")
    below = again(tmp_path / "run.mcap", taken="percepts[vision]")

    assert_judged_correct(tmp_path / "run.mcap")
    assert result.replay is not None
    assert below.replay is not None
    assert result.replay.compared == result.replay.identical > 25
    assert below.replay.compared == below.replay.identical > 20
    assert "colour_images" in result.timing.stages
    assert "colour_images" not in below.timing.stages

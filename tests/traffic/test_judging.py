"""Recorded runs are judged, and what is wrong with a recording is found."""

import json
import re
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

from dyknow.judging.judgement import Basis
from dyknow.recordings.errors import DamagedRecordingError
from dyknow.recordings.recording import open_recording
from dyknow.recordings.recovery import recover
from dyknow.runtime.generators import Label
from dyknow.runtime.subscriptions import StreamViolation
from dyknow.streams.policy import Constraint, Violation
from dyknow.streams.process import Element
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table
from dyknow.time import MILLISECOND, TimePoint
from tests.support.judging import assert_judged_correct
from tests.support.mutations import MUTATIONS, Mutation, delay, disorder, drop
from tests.support.rewriting import Alter, rewrite
from traffic.__main__ import app
from traffic.errors import RequestError
from traffic.judging import document_from, judge_recording
from traffic.recording.codecs import CODECS
from traffic.replaying import ReplayRequest, replay
from traffic.request import RunRequest
from traffic.running import run_scenario
from traffic.system import bundled_specification

pytestmark = pytest.mark.sumo

_STREAMS = (
    "world_objects",
    "car_pairs",
    "car_changes",
    "cars/1",
    "car_relation_changes/1",
    "overtakes/1",
    "output/cars",
    "output/percepts",
)
"""Outputs of units, inputs of units, and outputs of the application, none made of another."""

_MUTATIONS = [each for each in MUTATIONS if each is not disorder]
"""In a file, samples are in order of their available times however they were written."""

_OF_STREAMS = {"4.3.5", "4.5.4", "4.5.8", "4.5.9", "4.5.10", "4.5.11"}


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the recording of a short run."""
    folder = tmp_path_factory.mktemp("judged")
    request = RunRequest.from_texts(
        scenario="crossing",
        view="truth",
        duration="3 s",
        position_noise=1.0,
        out=folder / "run",
        record=folder / "run.mcap",
    )
    run_scenario(request, lambda *_: None)
    return folder / "run.mcap"


def test_a_run_satisfies_its_specification(recording: Path) -> None:
    """What was recorded is what the specification in the recording says."""
    assert_judged_correct(recording)


def test_every_unit_is_computed_again(recording: Path) -> None:
    """All but what came from outside is compared with what follows from its recorded inputs."""
    findings = judge_recording(recording).judgement.findings

    assert [each.stream for each in findings if each.unjudged] == ["vehicles"]
    assert {each.basis for each in findings if not each.unjudged} == {Basis.RECORDED}


def at_place(mutation: Mutation, place: int) -> Alter:
    """Return what alters a stream at a place."""

    def alter(elements: list[Element]) -> list[Sample[Any]]:
        return mutation([each for each in elements if isinstance(each, Sample)], place)

    return alter


@pytest.mark.parametrize("shift", [0, 3, 6])
def test_what_is_wrong_with_streams_is_found(shift: int, recording: Path, tmp_path: Path) -> None:
    """Whatever happens to a sample of a stream, the stream is named, and the time."""
    given = {
        topic: (_MUTATIONS[(at + shift) % len(_MUTATIONS)], 12 + at)
        for at, topic in enumerate(_STREAMS)
    }
    alter = {topic: at_place(*where) for topic, where in given.items()}
    altered = rewrite(recording, tmp_path / "x.mcap", alter, codecs=CODECS)
    with open_recording(recording, CODECS) as known:
        times = {
            topic: next(islice(known.samples(topic), place, None)).available_time
            for topic, (_, place) in given.items()
        }

    judgement = judge_recording(altered).judgement

    for topic, (mutation, _) in given.items():
        found = [breach for breach in judgement.breaches if breach.stream == topic]
        assert found, (topic, mutation)
        assert {breach.definition for breach in found} <= _OF_STREAMS
        for breach in found:
            assert abs((breach.available_time or 0) - times[topic]) <= 100 * MILLISECOND


def faster(elements: list[Element]) -> list[Element]:
    """Return tables of cars in which one of them is faster at one time."""
    altered = list(elements)
    sample = altered[20]
    assert isinstance(sample, Sample)
    table: Table = sample.value
    speed = table["speed"].copy()
    speed[0] += 1e-9
    altered[20] = replace(sample, value=table.with_columns(speed=speed))
    return altered


def test_one_wrong_number_is_named(recording: Path, tmp_path: Path) -> None:
    """Of one number of one car it is said what it should be; no other process is blamed."""
    altered = rewrite(recording, tmp_path / "x.mcap", {"cars": faster}, codecs=CODECS)

    judged = judge_recording(altered)

    judgement = judged.judgement
    breach = next(each for each in judgement.breaches if each.stream == "cars")
    assert breach.definition == "4.5.8"
    assert breach.expected.startswith("speed[car")
    assert breach.valid_time == TimePoint(2_000_000_000)
    blamed = {each.stream for each in judgement.breaches}
    assert blamed == {"cars", "moving_cars/1", "travelling_cars/1", "car_pairs/1", "output/cars"}
    document = document_from(judged)
    (plain,) = next(each for each in document["findings"] if each["stream"] == "cars")["breaches"]
    assert plain["valid_time"] == 2000.0
    assert plain["expected"] == breach.expected


def test_a_stream_in_the_place_of_another_is_found(recording: Path, tmp_path: Path) -> None:
    """Streams that have changed places are both named."""
    kept: dict[str, list[Element]] = {}

    def take_first(elements: list[Element]) -> list[Element]:
        kept["first"] = elements
        return elements

    rewrite(recording, tmp_path / "a.mcap", {"car_changes": take_first}, codecs=CODECS)
    altered = rewrite(
        recording,
        tmp_path / "b.mcap",
        {"car_relation_changes": lambda _: kept["first"]},
        codecs=CODECS,
    )

    judgement = judge_recording(altered).judgement

    assert "car_relation_changes" in {breach.stream for breach in judgement.breaches}


def test_a_changed_specification_is_noticed(recording: Path, tmp_path: Path) -> None:
    """By another specification, streams under another policy and units set otherwise are wrong."""
    text = bundled_specification().read_text(encoding="utf-8")
    text = text.replace("sample every sample_period", "sample every 200")
    changed = tmp_path / "changed.kpl"
    changed.write_text(
        text.replace("NearPairs(cars, distance = 60", "NearPairs(cars, distance = 2")
    )

    judgement = judge_recording(recording, changed).judgement

    assert {breach.stream for breach in judgement.breaches} == {"world_objects/1", "car_pairs"}


def test_what_comes_from_outside_is_noticed_by_what_follows(
    recording: Path, tmp_path: Path
) -> None:
    """Nobody knows what vehicles there were, but what was made of them shows that one is gone."""
    altered = rewrite(
        recording, tmp_path / "x.mcap", {"vehicles": at_place(drop, 10)}, codecs=CODECS
    )

    judgement = judge_recording(altered).judgement

    assert judgement.breaches[0].stream == "percepts[truth]/1"
    assert judgement.breaches[0].definition == "4.5.9"
    assert judgement.breaches[0].valid_time == TimePoint(1_000_000_000)


def test_values_of_another_sort_are_found(recording: Path, tmp_path: Path) -> None:
    """A column that is not there, or of another type, breaks the declared sort."""

    def without_speed(elements: list[Element]) -> list[Element]:
        altered = list(elements)
        sample = altered[-1]
        assert isinstance(sample, Sample)
        columns = {name: c for name, c in sample.value.columns.items() if name != "speed"}
        table = Table("vehicle", sample.value.ids, columns)
        altered[-1] = replace(sample, value=table.with_columns(heading=np.zeros(len(table), int)))
        return altered

    altered = rewrite(recording, tmp_path / "x.mcap", {"vehicles": without_speed}, codecs=CODECS)

    first = judge_recording(altered).judgement.breaches[0]

    assert (first.stream, first.definition) == ("vehicles", "4.5.4")
    assert "expected whole" in first.found or "column 'heading'" in first.found


def test_violations_without_a_cause_are_found(recording: Path, tmp_path: Path) -> None:
    """What stands on the violation stream must follow from the streams."""
    invented = Violation(Constraint.DELAY, TimePoint(0), TimePoint(10), "too late")
    altered = rewrite(
        recording,
        tmp_path / "x.mcap",
        {},
        lambda known: [
            *known,
            StreamViolation(Label("percepts[truth]"), Label("world_objects"), invented, 1),
        ],
        codecs=CODECS,
    )

    (breach,) = judge_recording(altered).judgement.breaches

    assert breach.stream == "violations of 'percepts[truth]' to 'world_objects'"


def test_what_was_not_recorded_is_told_in_a_line_for_each_reason(tmp_path: Path) -> None:
    """Of images it is said that they never are recorded; the document names every stream."""
    request = RunRequest.from_texts(
        scenario="crossing", duration="0.2 s", record=tmp_path / "x.mcap", out=tmp_path / "run"
    )
    run_scenario(request, lambda *_: None)
    runner = CliRunner()

    shown = runner.invoke(app, ["judge", str(tmp_path / "x.mcap")])
    document = json.loads(runner.invoke(app, ["judge", str(tmp_path / "x.mcap"), "--json"]).stdout)

    (about_images,) = [line for line in shown.stdout.splitlines() if "image" in line]
    assert about_images == (
        "not judged: colour_images, thermal_images, sync(colour_images, thermal_images) and 3 "
        "more: images are not recorded, but computed again by a replay"
    )
    reasons = {each["stream"]: each["unjudged"] for each in document["findings"]}
    assert sum("images" in " ".join(each) for each in reasons.values()) == 6
    assert reasons["percepts[vision]"] == reasons["output/cars"] == []
    assert not any(stream.startswith("output/") and reasons[stream] for stream in reasons)


def test_the_command_says_whether_it_is_satisfied(recording: Path, tmp_path: Path) -> None:
    """The exit status is 0 if the run satisfies the specification, and 1 if it does not."""
    altered = rewrite(recording, tmp_path / "x.mcap", {"cars": at_place(delay, 9)}, codecs=CODECS)
    runner = CliRunner()

    good = runner.invoke(app, ["judge", str(bundled_specification()), str(recording), "--json"])
    bad = runner.invoke(app, ["judge", str(altered)])

    assert good.exit_code == 0
    assert json.loads(good.stdout)["satisfied"] is True
    assert bad.exit_code == 1
    assert "does not satisfy its specification" in bad.stdout
    assert "expected available time 900, found available time 900000001 ns" in bad.stdout


def test_a_run_that_was_cut_off_is_judged_as_far_as_it_goes(
    recording: Path, tmp_path: Path
) -> None:
    """Of a file that ends in the middle, what is there is correct; it is told where it ends."""
    whole = recording.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole[: len(whole) * 3 // 5])

    judgement = judge_recording(cut).judgement

    assert judgement.is_satisfied
    (rest,) = judgement.unjudged
    assert re.fullmatch(r"what came from \d+ ms on: the recording ends there", rest)


def test_what_was_recovered_is_judged_before_the_gap(recording: Path, tmp_path: Path) -> None:
    """A damaged recording is refused; what is recovered of it is correct as far as it goes."""
    data = bytearray(recording.read_bytes())
    with recording.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunks = summary.chunk_indexes
    chunk = chunks[len(chunks) // 2]
    data[chunk.chunk_start_offset + chunk.chunk_length // 2] ^= 0xFF
    damaged, hole, end = (tmp_path / f"{name}.mcap" for name in ("damaged", "hole", "end"))
    damaged.write_bytes(data)
    recover(damaged, hole)
    damaged.write_bytes(data[: chunk.chunk_start_offset + 99])
    recover(damaged, end)

    damaged.write_bytes(data)
    with pytest.raises(DamagedRecordingError, match="can be recovered"):
        judge_recording(damaged)
    for recovered in (hole, end):
        judgement = judge_recording(recovered).judgement
        assert judgement.is_satisfied, "\n".join(map(str, judgement.breaches))
        assert judgement.unjudged[-1].endswith("the recording ends there")
        replayed = replay(ReplayRequest(path=recovered), lambda *_: None).replay
        assert replayed is not None
        assert replayed.differences == []
        assert "a part of the run is missing" in replayed.changes[-1]


def test_files_that_cannot_be_used_are_refused(recording: Path, tmp_path: Path) -> None:
    """Too many files, or a specification of something else, are refused with a message."""
    other = tmp_path / "other.kpl"
    other.write_text("source any a\nstrmgen a = a\nstream b = a\n")

    with pytest.raises(RequestError, match="expected a specification with one of the outputs"):
        judge_recording(recording, other)
    with pytest.raises(RequestError, match="SPECIFICATION: expected a file that can be read"):
        judge_recording(recording, tmp_path / "none.kpl")
    with pytest.raises(RequestError, match="SPECIFICATION: expected a text in UTF-8"):
        judge_recording(recording, recording)
    result = CliRunner().invoke(app, ["judge", "a", "b", "c"])
    assert isinstance(result.exception, RequestError)

"""Whole runs: as good as they should be, the same again, and blind to the truth."""

import ast
import json
from pathlib import Path

import numpy as np
import pytest

from dyknow.errors import SpecificationErrors
from dyknow.kpl.names import streams_of
from dyknow.kpl.syntax import GeneratorDeclaration, Label, Name
from dyknow.time import MILLISECOND, TimePoint
from networks.reading import read_road_map
from perception.camera import Calibration, Camera
from tests.support.standing_cars import StandingCars
from traffic.bundled import data_folder
from traffic.errors import RequestError, ResultError
from traffic.request import RunRequest
from traffic.results import read_result
from traffic.running import RequestChecks, check_request, run_scenario
from traffic.system import (
    MonitoringSystem,
    bundled_specification,
    read_specification,
)
from traffic.world import World

VEHICLES = Label(Name("vehicles"))
ROOT = Path(__file__).parents[2]
CROSSING = data_folder() / "networks" / "crossing" / "crossing.net.xml"
PERCEPT = {
    "position", "velocity", "covariance", "length", "width", "colour", "temperature",
    "observed_at",
}  # fmt: skip


def run(out, **options):
    """Run a bundled scenario from the simulator's positions, and return the result."""
    settings = {"scenario": "crossing", "view": "truth", **options}
    return run_scenario(RunRequest.from_texts(**settings, out=out), lambda *_: None)[0]


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize(
    ("scenario", "kind", "duration", "noise"),
    [("crossing", "turn", "40 s", 0.0), ("rural", "overtake", "90 s", 1.0)],
)
def test_manoeuvres_are_recognised(scenario, kind, duration, noise, tmp_path):
    """From good positions, at least nine of ten are found, and nine of ten found are true."""
    result = run(tmp_path / "x", scenario=scenario, duration=duration, position_noise=noise)

    score = result.score[kind]
    assert score.truth >= 3
    assert score.precision >= 0.9
    assert score.recall >= 0.9


@pytest.mark.sumo
def test_the_same_seed_gives_the_same_bytes(tmp_path):
    """Only the timing may differ; another seed gives another run."""
    options = {"duration": "8 s", "position_noise": 2.0}
    texts = []
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        run(tmp_path / name, seed=seed, **options)
        result = json.loads((tmp_path / name / "result.json").read_text())
        del result["timing"], result["settings"]
        texts.append(json.dumps(result))

    assert texts[0] == texts[1] != texts[2]
    first, second, _ = (tmp_path / name / "sumo" / "traffic.rou.xml" for name in "abc")
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.sumo
def test_a_run_keeps_what_is_needed_to_understand_it(tmp_path):
    """Result, origin, the declared network and chronicles, and SUMO's own files."""
    result = run(tmp_path / "x", duration="2 s", seed=7)

    origin = json.loads((tmp_path / "x" / "origin.json").read_text())
    specification = data_folder() / "specifications" / "monitoring.kpl"
    assert read_result(tmp_path / "x") == result
    assert origin["request"]["seed"] == 7
    assert origin["scenario"]["duration"] == 2 * 10**9
    assert {"dyknow-traffic", "python", "numpy", "libsumo"} <= set(origin["versions"])
    copies = tmp_path / "x" / "specification"
    assert (copies / "monitoring.kpl").read_bytes() == specification.read_bytes()
    assert {path.suffix for path in copies.iterdir()} == {".kpl", ".chronicle"}
    with pytest.raises(ResultError, match="exists already"):
        run(tmp_path / "x", duration="2 s")


@pytest.mark.sumo
def test_a_changed_specification_is_run(tmp_path):
    """Its copy is kept; parameters that it does not have cannot be set."""
    text = bundled_specification().read_text("utf-8")
    (tmp_path / "less.kpl").write_text(
        text.replace("sample every sample_period", "sample every 200")
        .replace("parameter sample_period = 100", "# no sample period")
        .replace("stream recognised_parking = parking", "")
    )
    result = run(tmp_path / "x", duration="3 s", specification=tmp_path / "less.kpl")

    assert "parking" not in result.timing.stages
    assert "turns" in result.timing.stages
    copy = tmp_path / "x" / "specification" / "less.kpl"
    assert copy.read_text() == (tmp_path / "less.kpl").read_text()
    with pytest.raises(RequestError, match="--sample-period: expected a specification with"):
        run(tmp_path / "y", specification=tmp_path / "less.kpl", sample_period="200")


def test_faults_of_a_changed_specification_have_places(tmp_path):
    """All at once, before anything is simulated; nothing is left behind."""
    text = bundled_specification().read_text("utf-8")
    path = tmp_path / "bad.kpl"
    path.write_text(
        text.replace("= Moving(cars", "= Mooving(cars").replace(
            "Headways(cars,", "Headways(carts,"
        )
    )

    with pytest.raises(SpecificationErrors) as caught:
        run(tmp_path / "x", specification=path)
    with pytest.raises(RequestError, match="--specification: expected a file that can be read"):
        run(tmp_path / "x", specification=tmp_path / "none.kpl")

    assert len(caught.value.exceptions) >= 2
    assert [each.name for each in tmp_path.iterdir()] == ["bad.kpl"]


@pytest.mark.sumo
def test_a_source_that_the_world_lacks_is_refused(tmp_path):
    """Without cameras there is no pose of one."""
    text = bundled_specification().read_text("utf-8") + "\nstream pose = camera_pose\n"
    (tmp_path / "x.kpl").write_text(text)

    with pytest.raises(SpecificationErrors) as caught:
        run(tmp_path / "x", specification=tmp_path / "x.kpl", duration="1 s")

    assert "there is no camera; expected the view 'vision'" in str(caught.value.exceptions[0])
    assert [each.name for each in tmp_path.iterdir()] == ["x.kpl"]


@pytest.mark.parametrize("view", ["vision", "truth"])
def test_percepts_tell_nothing_that_a_camera_cannot_see(view):
    """A percept has the columns of vision in both views: no lane, no name, no road."""
    calibration = Calibration.from_field_of_view(width=320, height=180, horizontal=1.0)
    camera = Camera.looking_at(0.0, 0.0, 60.0, heading=0.0, calibration=calibration)
    generator = np.random.Generator(np.random.PCG64(1))
    world = World(read_road_map(CROSSING), StandingCars(), camera, generator)
    parameters = {"view": view, "sample_period": 100.0, "position_noise": 0.0}
    system = MonitoringSystem(world, parameters, ("percepts",))
    tables = []
    system.network.subscribe("percepts", lambda sample: tables.append(sample.value))

    system.network.kernel.run(TimePoint(960 * MILLISECOND))

    assert len(tables) == 25
    assert all(set(table.columns) == PERCEPT for table in tables)
    assert all(table.sort == "percept" for table in tables)
    if view == "vision":
        assert all(not np.isin(table.ids, np.arange(3) + 1000).any() for table in tables)


def test_only_cameras_and_the_noisy_view_receive_the_vehicles():
    """In the specification nothing else takes the stream of the simulator's vehicles."""
    specification = read_specification(bundled_specification())
    takers = {
        declaration.label.text
        for declaration in specification.declarations
        if isinstance(declaration, GeneratorDeclaration)
        and any(term.provider == VEHICLES for term in streams_of(declaration.process))
    }

    assert takers == {"colour_images", "thermal_images", "percepts[truth]"}


def test_hidden_columns_are_read_for_the_truth_alone():
    """Only the simulator makes them and only the truth reads them."""
    readers = {
        path.relative_to(ROOT).parts[:2]
        for package in ("traffic", "perception", "anchoring", "chronicles", "dyknow", "networks")
        for path in (ROOT / package).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Attribute) and node.attr == "hidden"
    }

    assert readers == {("traffic", "sumo"), ("traffic", "truth")}


def test_only_what_is_to_be_recognised_is_scored():
    """Each kind that a chronicle of these outputs claims and the truth knows; turns are one."""
    asked = {"scenario": "crossing", "view": "truth"}

    both = check_request(RunRequest.from_texts(**asked))
    one = check_request(RunRequest.from_texts(**asked, recognise="signals"))

    assert both.kinds[:2] == ("turn", "overtake")
    assert one.kinds == ("red_light",)
    assert [path.name for path in one.files if path.suffix == ".chronicle"] == [
        "signals.chronicle"
    ]


def test_runs_that_are_alike_to_a_check_are_checked_once():
    """What the simulator alone is told is not checked; all else makes another check."""
    checks = RequestChecks()
    asked = {"scenario": "crossing", "view": "truth"}

    def check(**others):
        return checks.check(RunRequest.from_texts(**asked | others))

    one = check()

    assert check(seed=7, duration="9 s", out=Path("x")) is one
    assert check(changes={"scenario.warm_up": "3 s"}) is one
    for others in (
        {"recognise": "signals"},
        {"position_noise": 1.0},
        {"sample_period": "200"},
        {"changes": {"stability": 500}},
        {"changes": {"scenario.recognise": ["signals"]}},
        {"scenario": "rural"},
        {"view": "vision"},
    ):
        assert check(**others) is not one, others
    for _ in range(2):
        with pytest.raises(RequestError, match="overtaks"):
            check(recognise="overtaks")


def test_what_cannot_be_recognised_is_refused():
    """The message says what can, and where the name was written."""
    request = RunRequest.from_texts(scenario="crossing", view="truth", recognise="turns,overtaks")

    with pytest.raises(RequestError, match=r"--recognise: .*did you mean 'overtakes'"):
        check_request(request)

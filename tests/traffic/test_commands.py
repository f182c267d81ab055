"""The command line as its users meet it: what is printed where, and the exit status."""

import errno
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from traffic.__main__ import app, main
from traffic.bundled import data_folder

NETWORK = data_folder() / "networks" / "crossing" / "crossing.net.xml"
SPECIFICATION = data_folder() / "specifications" / "monitoring.kpl"
TRUTH = ("run", "crossing", "--view", "truth")
SCENARIO = f"""network = "{NETWORK}"
duration = "3 s"
[camera]
look_at = "centre"
[[trips]]
rate_per_hour = 3600
types = {{ car = 1 }}
[[vehicle_types]]
name = "car"
"""


@pytest.fixture(autouse=True)
def _own_folder(tmp_path, monkeypatch):
    """Work in an empty folder, and give the signals back afterwards."""
    monkeypatch.chdir(tmp_path)
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in handlers.items():
        signal.signal(number, handler)


@pytest.fixture
def traffic(monkeypatch, capfd):
    """Return a function that runs the program and returns exit status, output and messages."""

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["traffic", *arguments])
        with pytest.raises(SystemExit) as stop:
            main()
        printed = capfd.readouterr()
        return int(stop.value.code or 0), printed.out, printed.err

    return run


def commands(group, path=()):
    """Yield the words of each command."""
    yield path
    for name, command in getattr(group, "commands", {}).items():
        yield from commands(command, (*path, name))


@pytest.mark.parametrize("width", [80, 120])
def test_the_help_of_every_command_fits_the_terminal(width):
    """No line is longer than the terminal is wide, and nothing is cut off."""
    for words in commands(typer.main.get_command(app)):
        shown = CliRunner().invoke(app, [*words, "--help"], env={"COLUMNS": str(width)})

        assert shown.exit_code == 0
        assert max(map(len, shown.output.splitlines())) <= width
        assert "…" not in shown.output.replace("(.nod, .edg, …)", "")


def test_scenarios_are_listed(traffic):
    """Each bundled scenario has a row."""
    status, out, _ = traffic("scenarios")

    assert status == 0
    assert "crossing" in out
    assert "rural" in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nonsense",), "No such command 'nonsense'"),
        (("run", "crossing", "--nonsense"), "No such option: --nonsense"),
        (("run",), "traffic run: expected either a scenario or --sumocfg"),
        (("run", "crosing"), "no scenario called 'crosing'; did you mean 'crossing'?"),
        (("run", "none.toml"), "cannot read 'none.toml': No such file"),
        (("run", "crossing", "--look-at", "zentre"), "'zentre'; did you mean 'centre'?"),
        (("run", "crossing", "--look-at", "1,nan"), "--look-at: expected metres"),
        (("run", "crossing", "--overlay", "no/x.mp4"), "a file in a folder that exists"),
        ((*TRUTH, "--out", "."), "'.' exists already"),
        ((*TRUTH, "--out", "file/x"), "cannot write to 'file/x': Not a directory"),
        ((*TRUTH, "--out", "/proc/x"), "cannot write to '/proc/x'"),
        ((*TRUTH, "--out", "y" * 300), "File name too long"),
        (("run", "--view", "truth", "--sumocfg", "none"), "no SUMO configuration at 'none'"),
        (("run", "--view", "truth", "--sumocfg", "file"), "file:1:1: not well-formed XML"),
        (("report", "none"), "'none' holds no finished run: No such file"),
        (("report", "file"), "'file' holds no finished run: Not a directory"),
        ((*TRUTH, "--record", "x.bag"), "--record: expected a name that ends in .mcap"),
        ((*TRUTH, "--record", "no/x.mcap"), "--record: expected a file in a folder that exists"),
        ((*TRUTH, "--streams", "cars"), "--streams: expected nothing, because it only has a"),
        ((*TRUTH, "--specification", "none"), "--specification: expected a file that can be"),
        (("replay", "none.mcap"), "none.mcap: No such file or directory"),
        (("replay", "."), ".: Is a directory"),
        (("replay", "file"), "file: expected a recording in MCAP, found something else"),
        (("replay", "file", "--record", "file"), "--record: expected a name that ends in .mcap"),
        (("recover", "file", "x.mcap"), "file: expected a recording in MCAP, found"),
        (("recover", "none", "x.mcap"), "none: No such file or directory"),
        (("check", "file"), "expected a name that ends in one of .kpl"),
        (("network", "show", "none.net.xml"), "none.net.xml: no such file"),
        (("network", "show", "file"), "file:1:1: broken XML: syntax error"),
        (("network", "build", "none", "x.net.xml"), "no folder 'none'"),
        (("network", "build", ".", "file"), "a file that does not exist yet (or --force)"),
    ],
)
def test_what_is_at_fault_is_said_in_a_message(arguments, message, traffic):
    """Status 2, a message on standard error, nothing on standard output, nothing written."""
    Path("file").write_text("text")

    status, out, err = traffic(*arguments)

    assert (status, out) == (2, "")
    assert message in re.sub(r"\s*│?\n│?\s*", " ", err)
    assert "Traceback" not in err
    assert [path.name for path in Path().iterdir()] == ["file"]


@pytest.mark.parametrize(
    ("network", "message"),
    [
        ("", ":1:1: broken XML: no element found"),
        ("hello", ":1:1: broken XML: syntax error"),
        ("<routes/>", ":1:1: expected a SUMO network <net>, found <routes>"),
        ("<net version='1.20'></net>", ": expected roads for vehicles, found none"),
        (None, ": broken XML: unclosed token"),
    ],
)
def test_a_broken_network_has_a_place(network, message, traffic):
    """Empty, not XML, of something else, without roads, or cut off."""
    path = Path("n.net.xml")
    path.write_text(NETWORK.read_text("utf-8")[:5000] if network is None else network)
    scenario = re.sub(r"look_at = .*", "look_at = [0, 0]", SCENARIO)
    Path("s.toml").write_text(scenario.replace(str(NETWORK), "n.net.xml"))

    status, out, err = traffic("run", "s.toml", "--view", "truth")

    assert (status, out) == (2, "")
    assert err.startswith("traffic: n.net.xml:")
    assert message in re.sub(r":\d+:\d+: b", ": b", err) + err
    assert not Path("runs").exists()


@pytest.mark.sumo
@pytest.mark.parametrize(
    ("addition", "message"),
    [
        ("[sumo]\nnonsense = 3", "No option with the name 'nonsense' exists"),
        ('sumo = { accel = "fast" }', "Cannot be parsed to float"),
    ],
)
def test_what_the_simulator_refuses_is_passed_on(addition, message, traffic):
    """SUMO's own words are part of the message, and no folder remains."""
    Path("s.toml").write_text(SCENARIO + addition)

    status, out, err = traffic("run", "s.toml", "--view", "truth", "--out", "x", "--json")

    assert (status, out) == (2, "")
    assert err.startswith("traffic: SUMO cannot start")
    assert message in err
    assert [path.name for path in Path().iterdir()] == ["s.toml"]


@pytest.mark.sumo
def test_a_failure_of_the_simulator_on_the_way_is_the_users(traffic):
    """What a process of the network failed with is told like any other fault of the input."""
    Path("r.rou.xml").write_text(
        '<routes><trip id="a" depart="1" from="nowhere" to="nowhere"/></routes>'
    )
    Path("c.sumocfg").write_text(
        f'<configuration><net-file value="{NETWORK}"/><route-files value="r.rou.xml"/>'
        "</configuration>"
    )

    status, out, err = traffic(
        "run", "--sumocfg", "c.sumocfg", "--view", "truth", "--out", "x", "--json"
    )

    assert (status, out) == (2, "")
    assert "nowhere" in err
    assert sorted(path.name for path in Path().iterdir()) == ["c.sumocfg", "r.rou.xml"]


def test_a_folder_of_another_run_is_left_alone(traffic):
    """Neither a finished run nor one that is being written is touched."""
    Path("x.partial").mkdir()

    status, _, err = traffic(*TRUTH, "--out", "x")

    assert status == 2
    assert "'x.partial' exists: a run is writing there" in err
    assert Path("x.partial").is_dir()


def test_a_bug_is_no_message(traffic, monkeypatch):
    """What is not the user's fault keeps its traceback, which Python prints with status 1."""

    def fail(*_: object) -> None:
        raise KeyError("a bug")

    monkeypatch.setattr("traffic.reporting.reports.read_result", fail)
    monkeypatch.setattr(sys, "argv", ["traffic", "report", "x"])

    with pytest.raises(KeyError):
        main()


@pytest.mark.sumo
def test_a_bug_in_a_process_is_no_message(monkeypatch):
    """The same holds inside the network: the cause decides."""

    def fail(*_: object) -> None:
        raise KeyError("a bug")

    monkeypatch.setattr("traffic.features.moving.Moving.push", fail)
    monkeypatch.setattr(sys, "argv", ["traffic", *TRUTH, "--out", "x"])

    with pytest.raises(Exception, match="failed at") as caught:
        main()
    assert isinstance(caught.value.__cause__, KeyError)
    assert not list(Path().iterdir())


def test_all_faults_of_all_files_are_told_at_once(traffic):
    """`check` goes on after a file that has faults, or that cannot be read."""
    text = SPECIFICATION.read_text("utf-8").replace("NearPairs(cars,", "NearPears(cras,")
    Path("a.kpl").write_text(text)
    Path("b.mtl").write_text("always [3, 1] p and eventually [2, 0] q")
    Path("s.toml").write_text(SCENARIO.replace("rate_per_hour", "rate_per_our"))

    status, out, err = traffic("check", "a.kpl", "none.kpl", "b.mtl", "s.toml")

    assert (status, err) == (2, "")
    assert "no computational unit called 'NearPears'; did you mean 'NearPairs'?" in out
    assert "no stream generator called 'cras'; did you mean 'cars'?" in out
    assert "cannot read 'none.kpl': No such file or directory" in out
    assert "b.mtl:1:8: " in out
    assert "b.mtl:1:32: " in out
    assert "s.toml:6:1: no key called 'rate_per_our' here; did you mean 'rate_per_hour'?" in out
    assert "always [3, 1] p and eventually [2, 0] q\n       ^^^^^^" in out


def test_a_network_can_be_shown_as_json(traffic):
    """One document with the crossings, and nothing else."""
    status, out, err = traffic("network", "show", str(NETWORK), "--json")

    assert (status, err) == (0, "")
    assert "centre" in [crossing["name"] for crossing in json.loads(out)["crossings"]]


@pytest.mark.sumo
def test_a_run_prints_one_document_and_writes_one_folder(traffic):
    """With --json, standard output is one JSON document, also for what native code prints."""
    status, out, err = traffic(*TRUTH, "--duration", "5s", "--out", "x", "--json")
    again, reported, _ = traffic("report", "x", "--json")

    assert (status, again) == (0, 0)
    assert err == "run written to x\n"
    assert out == reported == Path("x/result.json").read_text()
    assert json.loads(out)["timing"]["simulated_s"] == 5
    assert [path.name for path in Path().iterdir()] == ["x"]


@pytest.mark.sumo
def test_a_replay_prints_what_a_run_does(recorded_run, traffic):
    """One JSON document, or tables and how many streams are the same; a folder if asked for."""
    status, out, err = traffic("replay", str(recorded_run.path), "--json", "--out", "x")
    document = json.loads(out)

    assert (status, err) == (0, "replay written to x\n")
    assert document["replay"]["differences"] == []
    assert document["score"] == json.loads(recorded_run.result.model_dump_json())["score"]
    assert out == Path("x/result.json").read_text()
    status, out, err = traffic("report", "x")
    assert status == 0
    assert f"{document['replay']['compared']} streams identical" in out


@pytest.mark.sumo
def test_other_streams_from_the_same_are_a_bug(recorded_run, traffic, monkeypatch):
    """The first difference of each stream is told, and the status is 1."""
    monkeypatch.setattr("traffic.features.moving.Moving.push", lambda *_: ())

    status, out, err = traffic("replay", str(recorded_run.path))

    assert status == 1
    assert "differs moving_cars at 0 ms" in out
    assert err == "traffic: the same specification on the same input gave other streams\n"


@pytest.mark.sumo
def test_what_is_whole_is_recovered(recorded_run, traffic):
    """It is said what was saved; the new file replays, and says that a part is missing."""
    Path("cut.mcap").write_bytes(recorded_run.path.read_bytes()[:400_000])

    status, out, err = traffic("recover", "cut.mcap", "x.mcap")
    replayed, shown, _ = traffic("replay", "x.mcap")

    assert (status, replayed, err) == (0, 0, "")
    assert re.search(r"x.mcap: \d+ messages of \d+ whole chunks, up to \d+ ms", out)
    assert "x.mcap: recovered from a damaged recording" in " ".join(shown.split())
    status, _, err = traffic("recover", "cut.mcap", "x.mcap")
    assert status == 2
    assert "x.mcap: there is a file of this name already" in err


@pytest.mark.sumo
def test_a_full_disk_is_told(traffic, monkeypatch):
    """What has been written stays partial; the folder of the run is removed."""

    def fail(*_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    options = ("--duration", "3s", "--out", "x", "--record", "x.mcap")
    monkeypatch.setattr("dyknow.recordings.writing.os.write", fail)
    status, out, err = traffic(*TRUTH, *options)

    assert (status, out) == (2, "")
    assert err == "traffic: x.mcap.partial: No space left on device\n"
    assert {path.name for path in Path().iterdir()} <= {"x.mcap.partial"}


@pytest.mark.sumo
def test_names_that_look_like_markup_are_printed_as_they_are(traffic):
    """Simulators allow nearly every character in a name."""
    Path("[b]s.toml").write_text(SCENARIO)
    traffic("run", "[b]s.toml", "--view", "truth", "--out", "x")
    result = json.loads(Path("x/result.json").read_text())
    result["missed"] = [
        {"kind": "left", "vehicles": ["[/v]"], "place": ["[/p]"], "begin": 0, "end": 1}
    ]
    Path("x/result.json").write_text(json.dumps(result))

    status, out, _ = traffic("report", "x")

    assert status == 0
    assert all(name in out for name in ("[b]s:", "[/v]", "[/p]"))


@pytest.mark.sumo
@pytest.mark.slow
def test_a_run_through_the_cameras_has_every_stage():
    """The whole chain from images to recognitions, and the film, in a process of its own."""
    done = subprocess.run(
        [
            *(sys.executable, "-m", "traffic", "run", "crossing", "--duration", "4s"),
            *("--json", "--out", "x", "--overlay", "film.mp4"),
        ],
        capture_output=True,
        text=True,
        check=False,
        env={"PYTHONPATH": str(Path(__file__).parents[2])},
    )

    assert (done.returncode, done.stderr) == (0, "run written to x\n")
    stages = json.loads(done.stdout)["timing"]["stages"]
    assert {"colour_images", "thermal_images", "percepts[vision]", "cars"} <= set(stages)
    assert sorted(path.name for path in Path().iterdir()) == ["film.mp4", "x"]
    assert Path("film.mp4").stat().st_size > 10_000


@pytest.mark.sumo
@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "status", "message"),
    [
        (signal.SIGINT, 130, "traffic: interrupted\n"),
        (signal.SIGTERM, 143, "traffic: terminated\n"),
    ],
)
def test_a_run_that_is_stopped_leaves_nothing(number, status, message):
    """No folder, no film, no traceback; of a recording what there is, under a partial name."""
    running = subprocess.Popen(
        [
            *(sys.executable, "-m", "traffic", "run", "crossing", "--duration", "1h"),
            *("--overlay", "film.mp4", "--record", "x.mcap"),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={"PYTHONPATH": str(Path(__file__).parents[2])},
    )
    _wait_for(Path("film.partial.mp4"))
    running.send_signal(number)
    out, err = running.communicate(timeout=60)

    assert (running.returncode, out, err) == (status, "", message)
    left = {path.name for path in Path().rglob("*")}
    assert left <= {"runs", "x.mcap.partial"}


def _wait_for(path: Path) -> None:
    deadline = time.monotonic() + 60
    while not path.exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)

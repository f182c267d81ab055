"""The network of a run is read from its folder, and everything else is refused with a reason."""

import json

import pytest
from typer.testing import CliRunner

from tests.support.snapshots import small_network
from traffic.__main__ import app
from traffic.errors import RequestError, ResultError
from traffic.inspecting import check_picture, read_network


@pytest.fixture
def run(tmp_path):
    """Return the folder of a run with a small network."""
    folder = tmp_path / "crossing-0001"
    folder.mkdir()
    (folder / "network.json").write_text(small_network().to_json(), encoding="utf-8")
    return folder


def test_the_network_of_a_run_is_read(run):
    """What was written into the folder of a run is read from it, or from the file itself."""
    assert read_network(run) == (small_network(), None)
    assert read_network(run / "network.json") == (small_network(), None)


def test_a_run_of_an_older_version_is_told(tmp_path):
    """A run without a snapshot is told apart from a folder that is no run."""
    with pytest.raises(ResultError, match="holds no finished run"):
        read_network(tmp_path)

    (tmp_path / "result.json").write_text("{}")

    with pytest.raises(ResultError, match="an older version"):
        read_network(tmp_path)


def test_a_missing_run_is_told(tmp_path):
    """A folder that does not exist is called by its name."""
    with pytest.raises(ResultError, match="nowhere' does not exist"):
        read_network(tmp_path / "nowhere")


@pytest.mark.parametrize("text", ["", "{}", '{"format": "dyknow-network", "version": 9}', "\xff"])
def test_a_damaged_file_is_told(run, text):
    """A file that is no snapshot is refused with its path."""
    (run / "network.json").write_bytes(text.encode("latin-1"))

    with pytest.raises(ResultError, match=r"network\.json'"):
        read_network(run)


def test_pictures_go_to_new_files(tmp_path):
    """A picture needs the right ending, a folder that is there, and a name that is free."""
    (tmp_path / "old.svg").touch()

    check_picture(None, "--svg", ".svg")
    check_picture(tmp_path / "new.svg", "--svg", ".svg")
    for path in (tmp_path / "a.png", tmp_path / "old.svg", tmp_path / "nowhere" / "a.svg"):
        with pytest.raises(RequestError, match="--svg"):
            check_picture(path, "--svg", ".svg")


def test_the_command_shows_tables(run):
    """Processes, streams, caches and violations are printed as tables."""
    shown = CliRunner(env={"COLUMNS": "200"}).invoke(app, ["inspect", str(run)])

    assert shown.exit_code == 0, shown.output
    for text in ("percepts[vision]", "8 of 16", "sample every 100", "40\u202fms", "Violations"):
        assert text in shown.output


@pytest.mark.parametrize("columns", ["80", "200", None])
def test_labels_are_never_cut(run, columns):
    """On a narrow screen they go on in the next line; a pipe gets lines of any length."""
    network, _ = read_network(run)
    shown = CliRunner(env={"COLUMNS": columns}).invoke(app, ["inspect", str(run)])

    assert shown.exit_code == 0, shown.output
    assert "…" not in shown.output
    words = set(shown.output.split())
    for stream in network.streams:
        assert words.issuperset(stream.provider.split() if columns else [stream.provider])
        assert any(stream.name.startswith(word) for word in words)


def test_the_command_prints_json(run):
    """With --json the snapshot is printed as it is in the file."""
    shown = CliRunner().invoke(app, ["inspect", str(run), "--json"])

    assert json.loads(shown.output) == json.loads((run / "network.json").read_text())


def test_the_command_draws(run, tmp_path):
    """Both pictures are written, under the name of the run."""
    svg, dot = tmp_path / "a.svg", tmp_path / "a.dot"

    shown = CliRunner().invoke(app, ["inspect", str(run), "--svg", str(svg), "--dot", str(dot)])

    assert shown.exit_code == 0, shown.output
    assert "crossing-0001" in svg.read_text(encoding="utf-8")
    assert dot.read_text(encoding="utf-8").startswith('digraph "crossing-0001"')

"""Networks compiled from plain XML."""

from pathlib import Path

import pytest

from traffic.bundled import data_folder
from traffic.errors import NetworkBuildError
from traffic.sumo.building import build_network, find_netconvert

NETWORKS = data_folder() / "networks"


def has_netconvert() -> bool:
    """Whether this machine can build networks."""
    try:
        find_netconvert()
    except NetworkBuildError:
        return False
    return True


needs_netconvert = pytest.mark.skipif(not has_netconvert(), reason="netconvert is not installed")


@pytest.mark.sumo
@needs_netconvert
@pytest.mark.parametrize("name", ["avenue", "crossing", "quarter", "rural"])
def test_the_bundled_networks_are_what_their_sources_give(name: str, tmp_path: Path) -> None:
    """Building a bundled network again gives the committed file, byte for byte."""
    built = tmp_path / "built.net.xml"

    build_network(NETWORKS / name, built)

    assert built.read_bytes() == (NETWORKS / name / f"{name}.net.xml").read_bytes()


@pytest.mark.sumo
@needs_netconvert
def test_a_network_can_be_built_for_driving_on_the_left(tmp_path: Path) -> None:
    """The file says so, and U-turns have a way through the junction."""
    built = tmp_path / "left.net.xml"

    build_network(NETWORKS / "crossing", built, left_hand=True)

    text = built.read_text()
    assert 'lefthand="true"' in text
    assert 'length="0.10"' not in text


@pytest.mark.sumo
@needs_netconvert
def test_what_netconvert_says_is_passed_on(tmp_path: Path) -> None:
    """A fault in the plain XML is told in netconvert's own words, and nothing is written."""
    (tmp_path / "x.nod.xml").write_text('<nodes><node id="a" x="0" y="0"/></nodes>')
    (tmp_path / "x.edg.xml").write_text('<edges><edge id="e" from="a" to="b"/></edges>')

    with pytest.raises(NetworkBuildError, match=r"(?s)cannot build.*'b'"):
        build_network(tmp_path, tmp_path / "x.net.xml")

    assert not (tmp_path / "x.net.xml").exists()


def test_missing_sources_are_told(tmp_path: Path) -> None:
    """A folder that is missing, or without edges, gives a message before anything runs."""
    (tmp_path / "x.nod.xml").write_text("<nodes/>")

    with pytest.raises(NetworkBuildError, match="no folder"):
        build_network(tmp_path / "nothing", tmp_path / "x.net.xml")
    with pytest.raises(NetworkBuildError, match=r"no file ending in '\.edg\.xml'"):
        build_network(tmp_path, tmp_path / "x.net.xml")


def test_without_netconvert_the_message_says_how_to_get_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The extra that brings netconvert is named."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("SUMO_HOME", raising=False)
    monkeypatch.setattr("traffic.sumo.building.find_spec", lambda name: None)

    with pytest.raises(NetworkBuildError, match=r"pip install 'dyknow-traffic\[build\]'"):
        find_netconvert()

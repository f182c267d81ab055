"""SUMO's files, rewritten so that nothing is written beside them."""

import gzip
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from traffic.errors import SimulatorError
from traffic.sumo.configuration import read_options, relocate, write_configuration

CONFIGURATION = """<sumoConfiguration>
    <input>
        <n value="town.net.xml"/>
        <route-files value="a.rou.xml, sub/b.rou.xml"/>
        <additional-files value="detectors.add.xml.gz"/>
    </input>
    <output>
        <tripinfo-output value="trips.xml"/>
        <fcd-output value="../fcd.xml"/>
        <summary value="NUL"/>
        <output-prefix value="results/TIME_"/>
    </output>
    <report><log value="log.txt"/><no-step-log value="true"/></report>
    <processing><random value="true"/><time-to-teleport value="60"/></processing>
    <save-state.prefix v="state"/>
</sumoConfiguration>"""

DETECTORS = """<additional>
    <e1Detector id="1" lane="a_0" pos="1" freq="60" file="e1.xml"/>
    <e1Detector id="2" lane="a_0" pos="1" freq="60" file="e1.xml"/>
    <edgeData id="3" file="elsewhere/e1.xml"/>
    <calibrator id="4" lane="a_0" pos="0" output="c.xml"/>
    <rerouter id="5" edges="a" file="sub/closed.xml"/>
    <timedEvent type="SaveTLSStates" source="0" dest="tls.xml"/>
    <tlLogic id="6" type="actuated" programID="0"><param key="file" value="loops.xml"/></tlLogic>
    <vType id="7"><param key="device.ssm.file" value="ssm.xml"/><param key="x" value="y"/></vType>
    <poly id="8" shape="0,0 1,1" imgFile="tree.png"/>
    <include href="more.add.xml"/>
</additional>"""


@pytest.fixture
def town(tmp_path: Path) -> Path:
    """Return the folder of a scenario whose files write in every way that SUMO knows."""
    folder = tmp_path / "town"
    (folder / "sub").mkdir(parents=True)
    (folder / "town.sumocfg").write_text(CONFIGURATION)
    with gzip.open(folder / "detectors.add.xml.gz", "wt") as file:
        file.write(DETECTORS)
    (folder / "more.add.xml").write_text(
        '<additional><routeProbe id="9" file="p.xml"/></additional>'
    )
    (folder / "sub" / "closed.xml").write_text("<rerouter/>")
    for name in ("town.net.xml", "a.rou.xml", "sub/b.rou.xml"):
        (folder / name).write_text("<x/>")
    return folder


def moved(town: Path) -> dict[str, str]:
    """Return the options of the scenario after relocation into a folder beside it."""
    run = town.parent / "run"
    run.mkdir()
    return relocate(read_options(town / "town.sumocfg"), town, run)


def test_options_have_their_full_names(town: Path) -> None:
    """Synonyms and the attribute 'v' are understood, whatever the section."""
    options = read_options(town / "town.sumocfg")

    assert options["net-file"] == "town.net.xml"
    assert options["summary-output"] == "NUL"
    assert options["save-state.prefix"] == "state"


def test_options_read_there_and_write_here(town: Path) -> None:
    """Inputs become absolute paths, outputs go into the run's folder, the rest stays."""
    options = moved(town)

    copy = options.pop("additional-files")
    assert copy.startswith("input/")
    assert options == {
        "net-file": f"{town}/town.net.xml",
        "route-files": f"{town}/a.rou.xml,{town}/sub/b.rou.xml",
        "tripinfo-output": "output/trips.xml",
        "fcd-output": "output/fcd.xml",
        "summary-output": "NUL",
        "output-prefix": "results_TIME_",
        "log": "output/log.txt",
        "no-step-log": "true",
        "time-to-teleport": "60",
        "save-state.prefix": "output/state",
    }


def test_files_that_say_where_to_write_are_copied(town: Path) -> None:
    """One output stays one, two of the same name stay two, and inputs are found from the copy."""
    copy = town.parent / "run" / moved(town)["additional-files"]

    root = ET.parse(copy).getroot()

    written = [
        element.get("file", element.get("output", element.get("dest")))
        for element in root
        if element.tag not in {"rerouter", "include"}
    ]
    values = [param.get("value") for param in root.iter("param")]
    assert written[:4] == [
        "../output/e1.xml",
        "../output/e1.xml",
        "../output/2_e1.xml",
        "../output/c.xml",
    ]
    assert "../output/tls.xml" in written
    assert values == ["../output/loops.xml", "../output/ssm.xml", "y"]
    assert root.find("rerouter").get("file") == f"{town}/sub/closed.xml"
    assert root.find("poly").get("imgFile") == f"{town}/tree.png"
    included = ET.parse(root.find("include").get("href")).getroot()
    assert included.find("routeProbe").get("file") == "../output/p.xml"


def test_what_is_written_can_be_read(tmp_path: Path) -> None:
    """Reading options after writing them gives the same."""
    options = {"net-file": "a & b.net.xml", "seed": "1"}

    write_configuration(options, tmp_path / "c.sumocfg")

    assert read_options(tmp_path / "c.sumocfg") == options


def test_environment_variables_are_filled_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """SUMO allows `${NAME}` in values; unknown ones stay."""
    monkeypatch.setenv("TOWN", "/towns/a")
    write_configuration({"net-file": "${TOWN}/x.net.xml", "l": "${NO_SUCH}"}, tmp_path / "c")

    assert read_options(tmp_path / "c") == {"net-file": "/towns/a/x.net.xml", "log": "${NO_SUCH}"}


def test_broken_files_have_a_place(tmp_path: Path) -> None:
    """A configuration that is missing or no XML is told, with line and column."""
    (tmp_path / "broken.sumocfg").write_text("<a>\n<b>\n</a>")

    with pytest.raises(SimulatorError, match=r"broken\.sumocfg:3:3: not well-formed XML"):
        read_options(tmp_path / "broken.sumocfg")
    with pytest.raises(SimulatorError, match=r"cannot read .*missing"):
        read_options(tmp_path / "missing.sumocfg")

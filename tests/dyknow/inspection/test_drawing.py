"""The picture of a network is SVG that any program can read, with all that matters in it."""

import xml.etree.ElementTree as ET
from dataclasses import replace

from hypothesis import given, settings

from dyknow.inspection.drawing import svg_from
from dyknow.inspection.snapshot import Snapshot
from tests.support.snapshots import small_network, snapshots

SVG = "{http://www.w3.org/2000/svg}"


def texts(svg: str) -> list[str]:
    """Return the texts of a picture in order."""
    return ["".join(text.itertext()) for text in ET.fromstring(svg).iter(f"{SVG}text")]


@settings(derandomize=True, deadline=None, max_examples=25)
@given(snapshots())
def test_any_network_makes_a_well_formed_picture(snapshot):
    """Whatever is in the labels, the picture is XML, with a box for each process and output."""
    root = ET.fromstring(svg_from(snapshot, 'a "title" & <more>'))

    kinds = [(box.get("class") or "").split() for box in root.iter(f"{SVG}rect")]
    outputs = [stream for stream in snapshot.streams if stream.is_output]
    assert sum("box" in kind for kind in kinds) == len(snapshot.processes)
    assert sum("output" in kind for kind in kinds) == len(outputs)
    arrows = [path for path in root.iter(f"{SVG}path") if "arrow" in (path.get("class") or "")]
    assert len(arrows) == len(snapshot.streams)


def test_the_figures_stand_on_the_arrows():
    """Rates and mean delays are texts of the picture; a violation shows instead of its policy."""
    shown = texts(svg_from(small_network(), "crossing"))

    assert "25\u202fHz · 0" in shown
    assert "10\u202fHz · 40\u202fms" in shown
    assert "2 violated" in shown
    assert "50 samples · 75% CPU" in shown
    assert shown[0] == "crossing"


def test_a_process_that_failed_shows():
    """The box of a process with failures is marked."""
    network = small_network()
    failed = replace(network.processes[0], failures=1)
    root = ET.fromstring(svg_from(replace(network, processes=(failed, *network.processes[1:]))))

    marked = [box for box in root.iter(f"{SVG}rect") if box.get("class") == "box bad"]
    assert len(marked) == 1


def test_everything_is_inside_the_picture():
    """No box sticks out of the picture."""
    root = ET.fromstring(svg_from(small_network()))
    width, height = float(root.get("width", 0)), float(root.get("height", 0))

    for box in root.iter(f"{SVG}rect"):
        assert float(box.get("x") or 0) + float(box.get("width") or 0) <= width
        assert float(box.get("y") or 0) + float(box.get("height") or 0) <= height


def test_a_stream_of_an_unknown_generator_is_left_out():
    """A picture of some of the processes has only the arrows between those."""
    network = small_network()
    part = Snapshot(processes=network.processes[:1], streams=network.streams)

    root = ET.fromstring(svg_from(part))

    assert not list(root.iter(f"{SVG}path"))


def test_an_empty_network_can_be_drawn():
    """A picture of nothing has a title."""
    assert texts(svg_from(Snapshot(), "nothing"))[0] == "nothing"


def test_a_column_follows_from_what_feeds_a_process():
    """A process stands to the right of what feeds it, even if its depth does not say so."""
    network = small_network()
    flat = replace(network, processes=tuple(replace(p, depth=0) for p in network.processes))

    assert svg_from(flat) == svg_from(network)

"""Reading SUMO networks."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import shapely
import sumolib

from networks.errors import NetworkFileError
from networks.reading import read_network_parts, read_road_map
from networks.turns import Turn

DATA = Path(__file__).parents[2] / "data" / "networks"
BOLOGNA = Path("/work/shared/networks/bologna-acosta/acosta_buslanes.net.xml")
in_bologna = pytest.mark.skipif(not BOLOGNA.exists(), reason="the network is not here")

NETWORK = """<net version="1.20"{attributes}>
    <edge id=":m_0" function="internal">
        <lane id=":m_0_0" index="0" speed="9" length="4" shape="98,-1.6 102,-1.6"/>
    </edge>
    <edge id="a[0]" from="w" to="m" priority="1">
        <lane id="a[0]_0" index="0" allow="pedestrian" speed="2" length="98" shape="0,-4 98,-4"/>
        <lane id="a[0]_1" index="1" speed="14" length="98" shape="0,-1.6 98,-1.6"/>
    </edge>
    <edge id="a[1]" from="m" to="e" priority="1">
        <lane id="a[1]_0" index="0" speed="14" length="98" shape="102,-1.6 200,-1.6"/>
    </edge>
    <edge id="tram" from="m" to="n" priority="1">
        <lane id="tram_0" index="0" allow="tram" speed="14" length="98" shape="100,2 100,100"/>
    </edge>
    <edge id="path" from="m" to="s" priority="1">
        <lane id="path_0" index="0" allow="pedestrian bicycle" speed="2" length="98" shape="100,-9 100,-99"/>
    </edge>
    <junction id="w" type="dead_end" x="0" y="0" incLanes="" intLanes="" shape="0,0 0,-6"/>
    <junction id="m" type="priority" x="100" y="0" incLanes="a[0]_1" intLanes=":m_0_0"
              shape="98,0 102,0 102,-6 98,-6"/>
    <junction id="e" type="dead_end" x="200" y="0" incLanes="a[1]_0" intLanes="" shape=""/>
    <junction id="n" type="dead_end" x="100" y="100" incLanes="tram_0" intLanes="" shape=""/>
    <junction id="s" type="dead_end" x="100" y="-99" incLanes="path_0" intLanes="" shape=""/>
    <connection from="a[0]" to="a[1]" fromLane="1" toLane="0" via=":m_0_0" dir="s" state="M"/>
    <connection from="a[0]" to="tram" fromLane="1" toLane="0" dir="l" state="M"/>
    <connection from=":m_0" to="a[1]" fromLane="0" toLane="0" dir="s" state="M"/>
</net>
"""  # noqa: E501


@pytest.fixture
def write(tmp_path):
    """Return a function that writes a network file, with some of its text replaced."""

    def written(old="", new="", attributes=""):
        text = NETWORK.format(attributes=attributes)
        assert old in text
        path = tmp_path / "town.net.xml"
        path.write_text(text.replace(old, new, 1) if old else text)
        return path

    return written


@pytest.fixture(scope="module")
def bologna():
    """Return the map of a part of Bologna."""
    return read_road_map(BOLOGNA)


def test_only_roads_for_vehicles_are_read(write):
    """Rails, footpaths and sidewalks are no roads, and make no crossing where they meet one."""
    road_map = read_road_map(write())

    assert road_map.roads == ("a[0]", "a[1]", ":m_0")
    assert road_map.lanes == ("a[0]_1", "a[1]_0", ":m_0_0")
    assert road_map.crossings == ()
    assert road_map.links == ("w-e",)
    assert road_map.link_of_edge == {"a[0]": 0, "a[1]": 0, ":m_0": 0}


def test_roads_lead_through_edge_splits(write):
    """The way through a junction is a road of its own, and part of the link."""
    road_map = read_road_map(write())
    points = np.array([[50.0, -1.6], [100.0, -1.6], [100.0, -5.5], [150.0, -1.6], [50.0, 9.0]])

    places = road_map.locate(points)
    s, d = road_map.project(points, np.array([0, 2, 2, 1, 0]))

    assert places.link.tolist() == [0, 0, 0, 0, -1]
    assert places.lane.tolist() == [0, 2, -1, 1, -1]
    assert s == pytest.approx([50.0, 2.0, 2.0, 48.0, 50.0])
    assert d == pytest.approx([0.0, 0.0, -3.9, 0.0, 10.6])
    assert road_map.offset_in_link == pytest.approx([0.0, 102.0, 98.0])


def test_the_side_of_driving_is_read(write):
    """The attribute `lefthand` tells on which side one drives; without it on the right."""
    assert not read_road_map(write()).left_hand
    assert read_road_map(write(attributes=' lefthand="true"')).left_hand


def test_a_packed_network_is_read(write):
    """A network packed with gzip reads like the plain one."""
    plain = write()
    packed = plain.with_suffix(".xml.gz")
    packed.write_bytes(gzip.compress(plain.read_bytes()))

    assert read_road_map(packed).roads == read_road_map(plain).roads


def test_a_network_without_ways_through_junctions_is_read(write):
    """Where the file has no lanes inside junctions, a straight way is taken."""
    road_map = read_road_map(write(' via=":m_0_0"'))

    assert road_map.roads == ("a[0]", "a[1]", "a[0]>a[1]")
    assert road_map.road_length == pytest.approx([98.0, 98.0, 4.0])


@pytest.mark.parametrize(
    ("old", "new", "line", "fault"),
    [
        ('to="m"', "", 5, "expected an attribute 'to' of edge 'a[0]'"),
        ('to="m"', 'to="q"', 5, "edge 'a[0]' refers to junction 'q', which is not declared"),
        ('"0,-1.6 98,-1.6"', '"0,-1.6"', 7, "expected two points or more in the shape of lane"),
        ('"0,-1.6 98', '"0,x 98', 7, "point x,y in the shape of lane 'a[0]_1', found '0,x'"),
        ('"0,-1.6 98', '"0,nan 98', 7, "point x,y in the shape of lane 'a[0]_1', found '0,nan'"),
        ('x="100"', 'x="1o0"', 19, "a number as 'x' of junction 'm', found '1o0'"),
        ('id="a[1]"', 'id="a[0]"', 9, "edge 'a[0]' is declared twice"),
        ('fromLane="1"', 'fromLane="2"', 24, "refers to lane 2 of edge 'a[0]', which has 2"),
        ('to="a[1]"', 'to="b"', 24, "the connection refers to edge 'b', which is not declared"),
        ('via=":m_0_0"', 'via=":m_9"', 24, "leads over lane ':m_9', which is not declared"),
        ('dir="s"', "", 24, "expected an attribute 'dir' of <connection>"),
        (' version="1.20"', "", 1, "expected an attribute 'version' of <net>"),
        ("<net", "<routes", 1, "expected a SUMO network <net>, found <routes>"),
        ("</net>", "", 28, "broken XML: no element found"),
        ("<edge", "<<edge", 2, "broken XML: not well-formed (invalid token)"),
    ],
)
def test_a_fault_is_reported_with_its_place(write, old, new, line, fault):
    """What is wrong in a network file is told with the line on which it stands."""
    path = write(old, new)

    with pytest.raises(NetworkFileError) as raised:
        read_road_map(path)

    assert fault in raised.value.fault
    assert raised.value.line == line
    assert str(raised.value).startswith(f"{path}:{line}:{raised.value.column}: ")


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (None, "no such file"),
        (b"", "broken XML: no element found"),
        (b'<net version="1.20"/>', "expected roads for vehicles, found none"),
        (b"\x1f\x8b\x08\x00", "cannot be read: "),
        (bytes(range(256)), "broken XML: "),
    ],
)
def test_a_file_that_is_no_network_is_refused(tmp_path, content, fault):
    """A missing, empty, binary or cut-off file gives one clear message."""
    path = tmp_path / "town.net.xml"
    if content is not None:
        path.write_bytes(content)

    with pytest.raises(NetworkFileError) as raised:
        read_road_map(path)

    assert fault in str(raised.value)
    assert raised.value.report() == str(raised.value)


def test_a_folder_is_refused(tmp_path):
    """A folder is no network file."""
    with pytest.raises(NetworkFileError, match="cannot be read: Is a directory"):
        read_road_map(tmp_path)


def test_the_crossing_network():
    """The bundled town has a four-way crossing with U-turns and four three-way ones."""
    road_map = read_road_map(DATA / "crossing" / "crossing.net.xml")
    centre = road_map.crossing_index("centre")

    turns = [turn for (_, crossing, _), turn in road_map.turns.items() if crossing == centre]

    assert set(road_map.crossings) == {"centre", "north", "east", "south", "west"}
    assert len(road_map.links) == 8
    assert {turn: turns.count(turn) for turn in Turn} == dict.fromkeys(Turn, 4)


def test_the_rural_network():
    """The bundled country road is longer than 1.5 km, and one may overtake on it."""
    road_map = read_road_map(DATA / "rural" / "rural.net.xml")
    longest = int(np.argmax(road_map.road_length))

    lanes = np.flatnonzero(road_map.lane_columns.road == longest)

    assert road_map.road_length[longest] > 1500.0
    assert (road_map.lane_columns.opposite[lanes] >= 0).all()


@in_bologna
def test_a_real_town_has_its_crossings(bologna):
    """Signalled crossings of several junctions are one crossing; edge splits are none."""
    assert len(bologna.crossings) == 41
    assert bologna.crossing_index("44") == bologna.crossing_index("204c")
    assert "47" not in bologna.crossing_of_junction
    assert len(set(bologna.links)) == len(bologna.links)


@in_bologna
def test_every_edge_of_a_real_town_has_its_place(bologna):
    """Each edge for vehicles is part of one link or one crossing."""
    parts = read_network_parts(BOLOGNA)
    edges = {*parts.edges, *(edge for c in parts.connections for edge in c.edge_ids)}

    assert {*bologna.link_of_edge, *bologna.crossing_of_edge} == edges
    assert bologna.link_of_edge.keys().isdisjoint(bologna.crossing_of_edge)


@in_bologna
def test_lanes_of_a_real_town_lie_in_their_links(bologna):
    """The middle of a lane is found in the lane's link, or else in the crossing that covers it."""
    lanes = bologna.lane_columns
    every = np.arange(len(bologna.lanes))
    middle = lanes.lines.at(every, lanes.lines.lengths / 2)

    places = bologna.locate(middle)

    inside = bologna.crossing_of_road[lanes.road]
    assert (places.crossing[inside >= 0] == inside[inside >= 0]).mean() > 0.98
    link = bologna.link_of_road[lanes.road]
    assert (places.link[link >= 0] == link[link >= 0]).mean() > 0.98
    assert (bologna.distance_to_road(middle) == 0).all()


@in_bologna
def test_crossings_of_a_real_town_do_not_reach_far(bologna):
    """A crossing is an area of its own, not a quarter of the town."""
    shapes = bologna.areas.shapes[: len(bologna.crossings)]

    assert all(shape.is_valid and not shape.is_empty for shape in shapes)
    assert shapely.area(shapes).max() < 5000.0


@in_bologna
def test_turns_of_a_real_town_agree_with_its_connections(bologna):
    """Nearly all turns by map geometry are those that the network gives for its connections."""
    codes = {"s": "straight", "l": "left", "r": "right", "L": "left", "R": "right", "t": "uturn"}
    net = sumolib.net.readNet(str(BOLOGNA))
    agreements = []
    for edge in net.getEdges():
        crossing = bologna.crossing_of_junction.get(edge.getToNode().getID())
        for onward, connections in edge.getOutgoing().items():
            start, end = (bologna.link_of_edge.get(e.getID()) for e in (edge, onward))
            if None not in (start, crossing, end):
                turn = bologna.turns[start, crossing, end]
                agreements.append(turn == codes[connections[0].getDirection()])

    assert len(agreements) > 150
    assert np.mean(agreements) > 0.97

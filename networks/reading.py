"""Read a SUMO road network file.

sumolib reads the network. What it does not tell, this module finds out itself with a first pass
over the XML: where in the file a fault is, and whether one drives on the left (the attribute
`lefthand` of `<net>`).
"""

import gzip
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import IO, Any
from xml.parsers import expat

import numpy as np
import sumolib

from networks.assembling import road_map_from_parts
from networks.errors import NetworkFileError
from networks.geometry import Points
from networks.parts import Connection, Edge, Junction, Lane, NetworkParts
from networks.roads import RoadMap

__all__ = ["read_network_parts", "read_road_map"]

_VEHICLE_CLASSES = frozenset(
    (
        "passenger",
        "private",
        "taxi",
        "bus",
        "coach",
        "delivery",
        "truck",
        "trailer",
        "evehicle",
        "hov",
    )
)
"""Who must be allowed on a lane for it to be one: no rails, footpaths or cycleways."""

_REQUIRED = {
    "edge": ("id",),
    "lane": ("id", "index", "speed", "length", "shape"),
    "junction": ("id", "type", "x", "y", "incLanes", "intLanes"),
    "connection": ("from", "to", "fromLane", "toLane", "dir", "state"),
}
_FEWEST_POINTS = 2
_GZIP_MAGIC = b"\x1f\x8b"


def read_road_map(path: Path | str) -> RoadMap:
    """Return the map of a SUMO network, `.net.xml` or `.net.xml.gz`.

    Raises:
        NetworkFileError: The file is missing, cannot be read, is no SUMO network, refers to
            edges that it does not have, or holds no road for vehicles.
    """
    return road_map_from_parts(read_network_parts(path))


def read_network_parts(path: Path | str) -> NetworkParts:
    """Return the junctions, edges and connections of a SUMO network that vehicles may use.

    Raises:
        NetworkFileError: As for `read_road_map`.
    """
    file = Path(path)
    left_hand = _first_pass(file)
    try:
        net: Any = sumolib.net.readNet(str(file), withInternal=True, withFoes=False, lxml=False)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as fault:
        raise NetworkFileError(file, f"not a complete SUMO network: {fault!r}") from fault
    parts = _parts(net, left_hand=left_hand)
    if not parts.edges:
        raise NetworkFileError(file, "expected roads for vehicles, found none")
    return parts


def _parts(net: Any, *, left_hand: bool) -> NetworkParts:
    normal = [edge for edge in net.getEdges() if edge.getFunction() in ("", "normal")]
    edges = {edge.id: edge for edge in map(_edge, normal) if edge.lanes}
    ends = dict.fromkeys(end for edge in edges.values() for end in (edge.start, edge.end))
    return NetworkParts(
        junctions={name: _junction(net.getNode(name)) for name in ends},
        edges=edges,
        connections=tuple(_connections(net, normal, edges)),
        left_hand=left_hand,
    )


def _junction(node: Any) -> Junction:
    shape = np.array(node.getShape(), dtype=np.float64).reshape(-1, 2)
    return Junction(node.getID(), np.array(node.getCoord(), dtype=np.float64), shape)


def _edge(edge: Any) -> Edge:
    lanes = tuple(_lane(lane) for lane in edge.getLanes() if _is_for_vehicles(lane))
    return Edge(edge.getID(), edge.getFromNode().getID(), edge.getToNode().getID(), lanes)


def _lane(lane: Any) -> Lane:
    return Lane(lane.getID(), _shape(lane), float(lane.getWidth()), lane.getNeigh() or None)


def _shape(lane: Any) -> Points:
    return np.array(lane.getShape(), dtype=np.float64)


def _is_for_vehicles(lane: Any) -> bool:
    return not _VEHICLE_CLASSES.isdisjoint(lane.getPermissions())


def _connections(net: Any, edges: list[Any], usable: Mapping[str, Edge]) -> Iterable[Connection]:
    for edge in edges:
        for to_edge, connections in edge.getOutgoing().items():
            if edge.getID() not in usable or to_edge.getID() not in usable:
                continue
            for connection in connections:
                ends = (connection.getFromLane(), connection.getToLane())
                if all(map(_is_for_vehicles, ends)):
                    inside = _lanes_inside(net, connection)
                    yield Connection(
                        edge.getID(),
                        to_edge.getID(),
                        tuple(_lane(lane) for lane in inside),
                        tuple(lane.getEdge().getID() for lane in inside),
                    )


def _lanes_inside(net: Any, connection: Any) -> list[Any]:
    """Follow a connection from lane to lane inside its junction."""
    lanes: list[Any] = []
    via = connection.getViaLaneID()
    while via:
        lane = net.getLane(via)
        lanes.append(lane)
        onward = lane.getOutgoing()
        via = onward[0].getViaLaneID() if onward else ""
    return lanes


class _FirstPass:
    """Checks what sumolib takes for granted, while the place in the file is known."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._root = ""
        self._lanes_of_edge: dict[str, int] = {}
        self._edge = ""
        self.left_hand = False

    def run(self, source: IO[bytes] | gzip.GzipFile) -> None:
        try:
            self._parser.ParseFile(source)
        except expat.ExpatError as fault:
            message = f"broken XML: {expat.ErrorString(fault.code)}"
            raise NetworkFileError(
                self._path, message, line=fault.lineno, column=fault.offset + 1
            ) from fault

    def _fail(self, fault: str) -> NetworkFileError:
        line, column = self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber
        return NetworkFileError(self._path, fault, line=line, column=column + 1)

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if not self._root:
            self._check_root(name, attributes)
            return
        if name == "junction" and attributes.get("type") == "internal":
            return
        for wanted in _REQUIRED.get(name, ()):
            if wanted not in attributes:
                raise self._fail(f"expected an attribute '{wanted}' of <{name}>")
        match name:
            case "edge":
                self._enter_edge(attributes)
            case "lane":
                self._check_lane(attributes)
            case "connection":
                self._check_connection(attributes)
            case _:
                pass

    def _check_root(self, name: str, attributes: dict[str, str]) -> None:
        if name != "net":
            raise self._fail(f"expected a SUMO network <net>, found <{name}>")
        if "version" not in attributes:
            raise self._fail("expected an attribute 'version' of <net>")
        self._root = name
        self.left_hand = attributes.get("lefthand", "false") in ("1", "true", "yes", "on", "x")

    def _enter_edge(self, attributes: dict[str, str]) -> None:
        self._edge = attributes["id"]
        if self._edge in self._lanes_of_edge:
            raise self._fail(f"edge '{self._edge}' is declared twice")
        self._lanes_of_edge[self._edge] = 0
        if not attributes.get("function"):
            for wanted in ("from", "to"):
                if wanted not in attributes:
                    raise self._fail(f"expected an attribute '{wanted}' of edge '{self._edge}'")

    def _check_lane(self, attributes: dict[str, str]) -> None:
        self._lanes_of_edge[self._edge] = self._lanes_of_edge.get(self._edge, 0) + 1
        corners = attributes["shape"].split()
        try:
            numbers = [[float(part) for part in corner.split(",")] for corner in corners]
        except ValueError as fault:
            raise self._fail(
                f"expected numbers x,y in the shape of lane '{attributes['id']}'"
            ) from fault
        if len(numbers) < _FEWEST_POINTS or not all(len(n) in (2, 3) for n in numbers):
            raise self._fail(f"expected two or more points x,y as shape of '{attributes['id']}'")

    def _check_connection(self, attributes: dict[str, str]) -> None:
        for end, lane in (("from", "fromLane"), ("to", "toLane")):
            edge = attributes[end]
            if edge not in self._lanes_of_edge:
                raise self._fail(f"the connection refers to edge '{edge}', which is not declared")
            index = attributes[lane]
            if not index.isdigit() or int(index) >= self._lanes_of_edge[edge]:
                raise self._fail(
                    f"the connection refers to lane {index} of edge '{edge}', "
                    f"which has {self._lanes_of_edge[edge]}"
                )


def _first_pass(path: Path) -> bool:
    """Check the file and tell whether it is a network where one drives on the left."""
    checks = _FirstPass(path)
    try:
        with path.open("rb") as raw:
            packed = raw.read(len(_GZIP_MAGIC)) == _GZIP_MAGIC
        with gzip.open(path) if packed else path.open("rb") as source:
            checks.run(source)
    except FileNotFoundError as fault:
        raise NetworkFileError(path, "no such file") from fault
    except (OSError, EOFError) as fault:
        raise NetworkFileError(path, f"cannot be read: {fault}") from fault
    return checks.left_hand

"""Read a SUMO road network file.

sumolib reads the network, after `networks.checking` has looked for what would confuse it.
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import sumolib

from networks.assembling import road_map_from_parts
from networks.checking import check_network_file
from networks.errors import NetworkFileError
from networks.geometry import Points, has_length
from networks.parts import Connection, Edge, Junction, Lane, NetworkParts
from networks.roads import RoadMap
from networks.surroundings import read_surroundings

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


def read_road_map(path: Path | str) -> RoadMap:
    """Return the map of a SUMO network, `.net.xml` or `.net.xml.gz`.

    What lies beside the roads is read from `.poly.xml` beside it, if there is such a file.

    Raises:
        NetworkFileError: The file is missing, cannot be read, is no SUMO network, refers to
            edges that it does not have, or holds no road for vehicles; or the polygons have a
            fault.
    """
    road_map = road_map_from_parts(read_network_parts(path))
    return replace(road_map, surroundings=read_surroundings(Path(path)))


def read_network_parts(path: Path | str) -> NetworkParts:
    """Return the junctions, edges and connections of a SUMO network that vehicles may use.

    Raises:
        NetworkFileError: As for `read_road_map`.
    """
    file = Path(path)
    left_hand = check_network_file(file).left_hand
    try:
        net: Any = sumolib.net.readNet(str(file), withInternal=True, withFoes=False, lxml=False)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as fault:
        raise NetworkFileError(file, f"not a complete SUMO network: {fault!r}") from fault
    parts = _parts(net, left_hand=left_hand)
    if not parts.edges:
        raise NetworkFileError(file, "expected roads for vehicles, found none")
    return parts


def _parts(net: Any, *, left_hand: bool) -> NetworkParts:
    normal = [edge for edge in net.getEdges() if edge.getFunction() == ""]
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
    return not _VEHICLE_CLASSES.isdisjoint(lane.getPermissions()) and _has_length(lane)


def _has_length(lane: Any) -> bool:
    return has_length(_shape(lane))


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
                        tuple(_lane(lane) for lane in inside if _has_length(lane)),
                        tuple(lane.getEdge().getID() for lane in inside),
                        connection.getFromLane().getID(),
                        bool(connection.getTLSID()),
                    )


def _lanes_inside(net: Any, connection: Any) -> list[Any]:
    """Follow a connection from lane to lane inside its junction."""
    lanes: list[Any] = []
    via = connection.getViaLaneID()
    while via:
        lane = net.getLane(via)
        if lane in lanes:
            break
        lanes.append(lane)
        onward = lane.getOutgoing()
        via = onward[0].getViaLaneID() if onward else ""
    return lanes

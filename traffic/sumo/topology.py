"""How the roads of a network hang together, as far as making traffic needs it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.sax import SAXException

import numpy as np
import numpy.typing as npt
import sumolib

from traffic.errors import SimulatorError

__all__ = ["Topology", "read_topology"]

_CLASS = "passenger"
_WAYS = {
    "s": "straight",
    "l": "left",
    "L": "left",
    "r": "right",
    "R": "right",
    "t": "uturn",
    "T": "uturn",
}


@dataclass(frozen=True, slots=True)
class Topology:
    """Roads for cars, and what follows each.

    Attributes:
        roads: Names.
        length: shape (n,), metres.
        n_lanes: shape (n,).
        speed: shape (n,), limits, m/s.
        middle: shape (n, 2), metres, in the world frame.
        ways: For each road, the roads that follow it and how one turns: `left`, `right`,
            `straight` or `uturn`.
    """

    roads: tuple[str, ...]
    length: npt.NDArray[np.float64]
    n_lanes: npt.NDArray[np.int64]
    speed: npt.NDArray[np.float64]
    middle: npt.NDArray[np.float64]
    ways: tuple[Mapping[int, str], ...]

    def reaches(self, first: int, last: int) -> bool:
        """Whether a car on road *first* can get to road *last*."""
        seen, fresh = {first}, [first]
        while fresh:
            fresh = [after for road in fresh for after in self.ways[road] if after not in seen]
            seen.update(fresh)
            if last in seen:
                return True
        return False


def read_topology(network: Path) -> Topology:
    """Read the roads of a compiled network that cars may use.

    Raises:
        SimulatorError: The file cannot be read, or has no such road.
    """
    try:
        net = sumolib.net.readNet(str(network))
    except (OSError, SAXException) as error:
        raise SimulatorError(f"cannot read the network '{network}'", [str(error)]) from error
    edges = [edge for edge in net.getEdges(withInternal=False) if edge.allows(_CLASS)]
    if not edges:
        raise SimulatorError(f"the network '{network}' has no road for cars")
    number = {edge.getID(): i for i, edge in enumerate(edges)}
    return Topology(
        roads=tuple(number),
        length=np.array([edge.getLength() for edge in edges]),
        n_lanes=np.array([edge.getLaneNumber() for edge in edges]),
        speed=np.array([edge.getSpeed() for edge in edges]),
        middle=np.array(
            [
                sumolib.geomhelper.positionAtShapeOffset(edge.getShape(), edge.getLength() / 2)
                for edge in edges
            ]
        ),
        ways=tuple(
            {
                number[after.getID()]: _WAYS[connections[0].getDirection()]
                for after, connections in edge.getOutgoing().items()
                if after.getID() in number
            }
            for edge in edges
        ),
    )

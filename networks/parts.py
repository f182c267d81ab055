"""A road network in plain parts: what a file says, before anything is made of it.

`networks.reading` gets the parts from a SUMO network, `networks.building` makes them up,
`networks.assembling` turns them into a `RoadMap`. Only what motor vehicles may use is a part.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import shapely

from networks.geometry import Points, middle_line

__all__ = ["Connection", "Edge", "Junction", "Lane", "NetworkParts"]

_FEWEST_CORNERS = 3


@dataclass(frozen=True, slots=True, eq=False)
class Lane:
    """A strip of an edge, or of a way through a junction, for one row of vehicles.

    Attributes:
        id: Its name in the file.
        shape: shape (k, 2), the centre line in the direction of travel, metres.
        width: Metres.
        opposite: The lane of the other direction on which one may overtake, if there is one.
    """

    id: str
    shape: Points
    width: float = 3.2
    opposite: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Edge:
    """The carriageway of one direction between two junctions.

    Attributes:
        id: Its name in the file.
        start: The junction at which it begins.
        end: The junction at which it ends.
        lanes: At least one, the outermost first: the rightmost where one drives on the right.
    """

    id: str
    start: str
    end: str
    lanes: tuple[Lane, ...]

    def centre_line(self) -> Points:
        """Return the line midway between the outermost and the innermost lane."""
        if len(self.lanes) == 1:
            return self.lanes[0].shape
        return middle_line(self.lanes[0].shape, self.lanes[-1].shape)

    def width(self) -> float:
        """Return the width of all lanes together, metres."""
        return float(sum(lane.width for lane in self.lanes))


@dataclass(frozen=True, slots=True, eq=False)
class Connection:
    """A way through a junction from one lane to another.

    Attributes:
        from_edge: The edge that is left.
        to_edge: The edge that is entered.
        lanes: The lanes inside the junction, in the order of travel; none if the file has none.
        edge_ids: The names that the file gives to the edges of these lanes.
        from_lane: The lane that is left.
        is_controlled: Whether a traffic light says when one may go.
    """

    from_edge: str
    to_edge: str
    lanes: tuple[Lane, ...] = ()
    edge_ids: tuple[str, ...] = ()
    from_lane: str = ""
    is_controlled: bool = False

    def line(self) -> Points | None:
        """Return the centre line of the lanes, one behind the other, or None without lanes."""
        if not self.lanes:
            return None
        return np.vstack([lane.shape for lane in self.lanes])


@dataclass(frozen=True, slots=True, eq=False)
class Junction:
    """A place at which edges begin and end.

    Attributes:
        id: Its name in the file.
        position: shape (2,), metres.
        polygon: shape (k, 2), the outline of its area; fewer than three points are no area.
    """

    id: str
    position: Points
    polygon: Points

    def area(self) -> shapely.Geometry:
        """Return its area, which may be empty or of several pieces."""
        if len(self.polygon) < _FEWEST_CORNERS:
            return shapely.Polygon()
        return shapely.make_valid(shapely.Polygon(self.polygon))


@dataclass(frozen=True, slots=True, eq=False)
class NetworkParts:
    """All junctions, edges and connections of a network.

    Attributes:
        junctions: By id; every junction at which an edge begins or ends.
        edges: By id.
        connections: In the order of the file.
        left_hand: Whether one drives on the left.
    """

    junctions: Mapping[str, Junction]
    edges: Mapping[str, Edge]
    connections: tuple[Connection, ...]
    left_hand: bool = False

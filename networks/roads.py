"""The road map: where points lie, along which road, and where the roads lead.

`RoadMap` is the geographic information system of Heintz (2009), section 8.7.4. All its questions
are asked for a whole frame of points at once. A *road* is directed: every edge is one, and so is
every way through a junction from one edge to another, so that roads follow one another without a
gap. *s* is metres along the centre line of a road, *d* metres to the left of it. The centre line
is midway between the outermost and the innermost lane, so a vehicle that overtakes on the lanes
of the other direction stays on its road, with a larger *d*.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from networks.errors import UnknownPlaceError
from networks.geometry import Floats, Indices, Points, Polylines, first_least
from networks.graph import RoadGraph
from networks.links import LinkPositions
from networks.markings import Marking
from networks.regions import NONE, Areas, Places, outlines
from networks.signals import Signals
from networks.surroundings import Surroundings
from networks.turns import Turn, Turns

__all__ = ["Lanes", "Moved", "RoadMap"]

_TURNING_COST = 10.0
"""Driving across a road counts as much as being so many metres away from it."""

_CLEAR_SPEED = 2.0
"""From this speed on, in m/s, the direction of a velocity counts in full."""


class Moved(NamedTuple):
    """Positions carried on past the ends of roads.

    Attributes:
        road: shape (n,).
        s: shape (n,), metres.
        branches: shape (n,), at how many forks the straightest of several roads was taken.
    """

    road: Indices
    s: Floats
    branches: Indices


@dataclass(frozen=True, slots=True, eq=False)
class Lanes:
    """The lanes of all roads, each a column.

    Attributes:
        names: As in the network file.
        lines: The centre lines.
        width: shape (l,), metres.
        road: shape (l,), the road of each lane; lanes of one road stand together, outermost first.
        opposite: shape (l,), the lane of the other direction on which one may overtake, or -1.
    """

    names: tuple[str, ...]
    lines: Polylines
    width: Floats
    road: Indices
    opposite: Indices


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class RoadMap:
    """A road network with all that is asked about it; never changed after it is made.

    Attributes:
        links: Names, such as `X1-X2` for the link between two crossings.
        crossings: Names: the id of the largest junction of each.
        graph: The roads and how they follow one another.
        lane_columns: The lanes.
        areas: The areas of crossings and links.
        positions: How positions along roads become positions along links.
        link_of_edge: From the id of an edge in the network file, also of one inside a junction, to
            the link of which it is part; without those that are part of crossings.
        crossing_of_edge: Likewise, to the crossing of which it is part.
        crossing_of_junction: From the id of a junction to the crossing of which it is part.
        turns: From (link, crossing, link) to the way one turns.
        markings: What is painted on the roads.
        signals: Where traffic lights are.
        surroundings: What lies beside the roads.
        left_hand: Whether one drives on the left.
    """

    links: tuple[str, ...]
    crossings: tuple[str, ...]
    graph: RoadGraph
    lane_columns: Lanes
    areas: Areas
    positions: LinkPositions
    link_of_edge: Mapping[str, int]
    crossing_of_edge: Mapping[str, int]
    crossing_of_junction: Mapping[str, int]
    turns: Turns
    markings: tuple[Marking, ...]
    signals: Signals
    surroundings: Surroundings = field(default_factory=Surroundings)
    left_hand: bool

    def __repr__(self) -> str:
        counts = f"{len(self.roads)} roads, {len(self.links)} links"
        return f"RoadMap({counts}, {len(self.crossings)} crossings)"

    @property
    def roads(self) -> tuple[str, ...]:
        """Names of the roads: ids of edges, and of the edges inside junctions."""
        return self.graph.names

    @property
    def lanes(self) -> tuple[str, ...]:
        """Names of the lanes, those inside junctions too."""
        return self.lane_columns.names

    @property
    def road_length(self) -> Floats:
        """Lengths of the centre lines, shape (r,), metres."""
        return self.graph.lines.lengths

    @property
    def road_width(self) -> Floats:
        """Widths of all lanes together, shape (r,), metres."""
        return self.graph.width

    @property
    def link_of_road(self) -> Indices:
        """The link of each road, shape (r,), or -1 inside crossings."""
        return self.graph.link

    @property
    def crossing_of_road(self) -> Indices:
        """The crossing of each road, shape (r,), or -1 on links."""
        return self.graph.crossing

    @property
    def offset_in_link(self) -> Floats:
        """With `direction_in_link`, position along the link: offset + direction * s; metres."""
        return self.positions.offset

    @property
    def direction_in_link(self) -> Floats:
        """1 for roads that lead along their link, -1 for those that lead against it."""
        return self.positions.direction

    @cached_property
    def turn_names(self) -> dict[tuple[str, str, str], Turn]:
        """The turns by names of link, crossing and link."""
        return {
            (self.links[a], self.crossings[x], self.links[b]): turn
            for (a, x, b), turn in self.turns.items()
        }

    def locate(self, points: Points) -> Places:
        """Return lane, link and crossing in which each point lies, or -1.

        Args:
            points: shape (n, 2), metres.
        """
        return self.areas.locate(points)

    def distance_to_road(self, points: Points) -> Floats:
        """Return the metres from each point to the nearest area of road or parking, 0 inside."""
        return np.minimum(
            self.areas.distance(points), self.surroundings.distance_to_parking(points)
        )

    def project(self, points: Points, road: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return *s* and *d* of each point on its own road; NaN where the road is -1.

        Before its start and behind its end a road goes on straight.

        Args:
            points: shape (n, 2), metres.
            road: shape (n,), indices of roads.
        """
        asked, index, known = _known(road)
        s, d = np.full((2, len(asked)), np.nan)
        s[known], d[known] = self.graph.lines.project(points[known], index)
        return s, d

    def point_at(self, road: npt.ArrayLike, s: Floats, d: npt.ArrayLike = 0.0) -> Points:
        """Return the points at *s* along and *d* to the left of roads; NaN where a road is -1."""
        asked, index, known = _known(road)
        points = np.full((len(asked), 2), np.nan)
        offset = np.broadcast_to(np.asarray(d, dtype=np.float64), len(asked))
        points[known] = self.graph.lines.at(index, np.asarray(s)[known], offset[known])
        return points

    def heading_at(self, road: npt.ArrayLike, s: Floats) -> Floats:
        """Return the headings of roads at *s*, radians; NaN where the road is -1."""
        asked, index, known = _known(road)
        headings = np.full(len(asked), np.nan)
        headings[known] = self.graph.lines.heading_at(index, np.asarray(s)[known])
        return headings

    def match(self, points: Points, velocity: Points, max_distance: float) -> Indices:
        """Return the road on which each point most probably travels, or -1.

        The road is that of the piece of a lane with the least cost: distance from its centre line,
        and for moving points up to 20 m more the more the direction of travel differs from it.
        So one who overtakes on the lane of the other direction keeps to the own road.

        Args:
            points: shape (n, 2), metres.
            velocity: shape (n, 2), m/s.
            max_distance: Lanes whose border is farther away than this do not count, metres.
        """
        point, segment, distance = self._lane_segments_near(points, max_distance)
        along = self.lane_columns.lines.direction
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        weight = _TURNING_COST / np.maximum(speed, _CLEAR_SPEED)
        progress = velocity[point, 0] * along[segment, 0] + velocity[point, 1] * along[segment, 1]
        cost = distance + weight[point] * (speed[point] - progress)
        chosen = first_least(cost, point)
        lane = self._lane_segments[1][segment[chosen]]
        road = np.full(len(points), NONE, dtype=np.int32)
        road[point[chosen]] = self.lane_columns.road[lane]
        return road

    def move(self, road: npt.ArrayLike, s: Floats) -> Moved:
        """Carry positions past the ends of roads on to the straightest successors.

        Where no road follows, *s* remains greater than the length. Roads that are -1 remain.

        Args:
            road: shape (n,), indices of roads.
            s: shape (n,), finite, metres.
        """
        at = np.array(road, dtype=np.int32)
        position = np.array(s, dtype=np.float64)
        branches = np.zeros(len(at), dtype=np.int32)
        first, count = self._straightest
        (beyond,) = np.nonzero(at >= 0)
        while True:
            here = at[beyond]
            goes_on = (position[beyond] > self.road_length[here]) & (count[here] > 0)
            beyond, here = beyond[goes_on], here[goes_on]
            if not len(beyond):
                return Moved(at, position, branches)
            position[beyond] -= self.road_length[here]
            branches[beyond] += count[here] > 1
            at[beyond] = first[here]

    def successors(self, road: int) -> tuple[int, ...]:
        """Return the roads on which *road* goes on, the straightest first."""
        return self.graph.successors[road]

    def position_along_link(self, road: npt.ArrayLike, s: Floats) -> Floats:
        """Return positions along the undirected links, metres; NaN inside crossings."""
        index = np.asarray(road)
        position = self.offset_in_link[index] + self.direction_in_link[index] * s
        on_link = (index >= 0) & (self.link_of_road[index] >= 0)
        return np.where(on_link, position, np.nan)

    def crossing_index(self, name: str) -> int:
        """Return the index of the crossing of which the junction *name* is part.

        Raises:
            UnknownPlaceError: There is none.
        """
        try:
            return self.crossing_of_junction[name]
        except KeyError:
            raise UnknownPlaceError("crossing", name, self.crossing_of_junction) from None

    def crossing_centre(self, crossing: int) -> Points:
        """Return the centre of the area of a crossing, shape (2,), metres."""
        centre = self.areas.shapes[crossing].centroid
        return np.array([centre.x, centre.y])

    def road_polygons(self) -> list[Points]:
        """Return outlines that together cover all road and parking, each shape (k, 2), metres."""
        shapes = (*self.areas.shapes, *self.surroundings.parking)
        return [ring for shape in shapes for ring in outlines(shape)]

    def crossing_polygons(self) -> list[Points]:
        """Return the outlines of the crossings, each shape (k, 2), metres."""
        shapes = self.areas.shapes[: len(self.crossings)]
        return [ring for shape in shapes for ring in outlines(shape)]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The smallest x, smallest y, greatest x and greatest y of all road, metres."""
        left, bottom, right, top = shapely.total_bounds(self.areas.shapes)
        return float(left), float(bottom), float(right), float(top)

    @cached_property
    def _straightest(self) -> tuple[Indices, Indices]:
        following = self.graph.successors
        first = np.array([roads[0] if roads else NONE for roads in following], dtype=np.int32)
        return first, np.array([len(roads) for roads in following], dtype=np.int32)

    @cached_property
    def _widest_lane(self) -> float:
        return float(np.max(self.lane_columns.width))

    @cached_property
    def _lane_segments(self) -> tuple[Points, npt.NDArray[np.intp]]:
        return self.lane_columns.lines.segments()

    @cached_property
    def _segment_tree(self) -> shapely.STRtree:
        return shapely.STRtree(np.asarray(shapely.linestrings(self._lane_segments[0])))

    def _lane_segments_near(
        self, points: Points, reach: float
    ) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], Floats]:
        """Return pairs of point and segment of a lane within *reach*, and their distances."""
        wide = reach + self._widest_lane / 2
        boxes = shapely.box(*(points - wide).T, *(points + wide).T)
        point, segment = self._segment_tree.query(boxes)
        distance = np.sqrt(self.lane_columns.lines.squared_distance(points[point], segment))
        lane = self._lane_segments[1][segment]
        near = distance - self.lane_columns.width[lane] / 2 <= reach
        return point[near], segment[near], distance[near]


def _known(
    road: npt.ArrayLike,
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], npt.NDArray[np.bool_]]:
    """Return all indices, those that are not -1, and which these are."""
    asked = np.asarray(road, dtype=np.intp)
    known = asked >= 0
    return asked, asked[known], known

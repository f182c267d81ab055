"""Named areas of a map, and which of them each point of a whole frame lies in.

As in Heintz (2009), section 8.7.4, every area is part of a crossing or of a link; the areas of a
link are its lanes and the joints between its edges.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import shapely

from networks.geometry import Floats, Indices, Points, Polylines, first_least

__all__ = ["NONE", "Areas", "Places", "outlines", "strip", "united"]

NONE = -1
"""The index that stands for no lane, no link, no crossing, no road."""

_GAP = 1.0
"""Gaps between the areas of one crossing narrower than twice this, in metres, are closed."""

Shapes = npt.NDArray[np.object_]


class Places(NamedTuple):
    """Where points lie; in a crossing there is neither link nor lane.

    Attributes:
        lane: shape (n,), or -1.
        link: shape (n,), or -1.
        crossing: shape (n,), or -1.
    """

    lane: Indices
    link: Indices
    crossing: Indices


class Areas:
    """The areas of a map with an index for look-up.

    Attributes:
        shapes: shape (a,), shapely polygons; crossings first, then lanes, then joints.
        lane: shape (a,), the lane that an area is, or -1.
        link: shape (a,), the link of which an area is part, or -1.
        crossing: shape (a,), the crossing that an area is, or -1.
    """

    __slots__ = ("_lane_lines", "_rank", "_tree", "crossing", "lane", "link", "shapes")

    def __init__(
        self,
        *,
        crossings: Shapes,
        lanes: tuple[Shapes, Indices, Indices],
        joints: tuple[Shapes, Indices],
        lane_lines: Polylines,
    ) -> None:
        lane_shapes, lane, link_of_lane = lanes
        joint_shapes, link_of_joint = joints
        none = [np.full(len(s), NONE, np.int32) for s in (crossings, lane_shapes, joint_shapes)]
        self.shapes = np.concatenate([crossings, lane_shapes, joint_shapes])
        self.lane = np.concatenate([none[0], lane, none[2]])
        self.link = np.concatenate([none[0], link_of_lane, link_of_joint])
        self.crossing = np.concatenate([np.arange(len(crossings), dtype=np.int32), *none[1:]])
        self._rank = np.repeat([0.0, 1e6, 2e6], [len(part) for part in none])
        self._lane_lines = lane_lines
        shapely.prepare(self.shapes)
        self._tree = shapely.STRtree(self.shapes)

    def locate(self, points: Points) -> Places:
        """Return the places of *points*, shape (n, 2); a crossing wins over what it overlaps.

        Where lanes overlap, the one with the nearest centre line counts.
        """
        point, area = self._covering(points)
        cost = self._rank[area]
        crowded = np.bincount(point, minlength=len(points))[point] > 1
        (doubtful,) = np.nonzero(crowded & (self.lane[area] >= 0))
        cost[doubtful] += self._lane_lines.distance(
            points[point[doubtful]], self.lane[area[doubtful]]
        )
        chosen = first_least(cost, point)
        found = np.full(len(points), NONE, dtype=np.intp)
        found[point[chosen]] = area[chosen]
        missing = found < 0
        return Places(
            *(
                np.where(missing, NONE, column[found]).astype(np.int32)
                for column in (self.lane, self.link, self.crossing)
            )
        )

    def distance(self, points: Points) -> Floats:
        """Return the distance of each point from the nearest area, 0 inside; metres."""
        distances = np.zeros(len(points))
        outside = np.ones(len(points), dtype=np.bool_)
        outside[self._covering(points)[0]] = False
        (wanted,) = np.nonzero(outside)
        if len(wanted):
            (asked, _), found = self._tree.query_nearest(
                shapely.points(points[wanted]), return_distance=True, all_matches=False
            )
            distances[wanted[asked]] = found
        return distances

    def _covering(self, points: Points) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Return pairs of point and area that covers it, in the order of points and areas."""
        pairs = self._tree.query(shapely.points(points))
        point, area = pairs
        covered = shapely.intersects_xy(self.shapes[area], points[point, 0], points[point, 1])
        point, area = point[covered], area[covered]
        order = np.lexsort((area, point))
        return point[order], area[order]


def strip(lines: Sequence[Points], widths: npt.ArrayLike) -> Shapes:
    """Return the areas that lie half of *widths* to both sides of *lines*."""
    shapes = np.array([shapely.LineString(line) for line in lines], dtype=np.object_)
    half = np.asarray(widths, dtype=np.float64) / 2
    return np.asarray(shapely.buffer(shapes, half, cap_style="flat", join_style="mitre"))


def united(areas: Sequence[shapely.Geometry]) -> shapely.Geometry:
    """Return one area from several, with the narrow gaps between them closed."""
    whole = shapely.union_all(list(areas))
    return whole.buffer(_GAP, join_style="mitre").buffer(-_GAP, join_style="mitre")


def outlines(shape: shapely.Geometry) -> list[Points]:
    """Return the outer rings of a polygon or of several, each shape (k, 2), not closed."""
    return [
        shapely.get_coordinates(part.exterior)[:-1]
        for part in shapely.get_parts(shape)
        if isinstance(part, shapely.Polygon) and not part.is_empty
    ]

"""What can be seen: the ground with its roads, what stands beside them, and vehicles as boxes."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
import shapely
from scipy.spatial import cKDTree

from perception.camera import Points
from perception.columns import Rows, select

__all__ = ["Ground", "Surroundings", "Vehicles", "build_surroundings", "polygons_of"]

_AREA_PER_BUILDING = 1100.0
_AREA_PER_TREE = 420.0
_MAX_PER_KIND = 20_000
_MARGIN = 120.0
"""Metres of country around the roads."""

_FEWEST_CORNERS = 3
_BUILDING_CLEARANCE = 9.0
_TREE_CLEARANCE = 5.5
_BUILDING_HEIGHT = (3.5, 7.0)


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """The flat ground as plain arrays; each polygon or line has shape (k, 2), metres.

    Attributes:
        roads: Outlines of the carriageways.
        junctions: Outlines of the areas where carriageways meet.
        solid_lines: Painted edge lines.
        dashed_lines: Painted lines between lanes.
        stop_lines: Broad painted lines at which vehicles wait.
        buildings: Outlines of the houses beside the roads, if they are known.
    """

    roads: tuple[Points, ...]
    junctions: tuple[Points, ...] = ()
    solid_lines: tuple[Points, ...] = ()
    dashed_lines: tuple[Points, ...] = ()
    stop_lines: tuple[Points, ...] = ()
    buildings: tuple[Points, ...] = ()

    @property
    def paved(self) -> tuple[Points, ...]:
        """All outlines within which vehicles drive."""
        return self.roads + self.junctions


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """Houses and trees beside the roads; rows of equal shape.

    Attributes:
        buildings: shape (n, 6): x, y, angle, length, width, height.
        building_colours: shape (n, 3), RGB.
        trees: shape (m, 4): x, y, radius of the crown, shade between 0 and 1.
    """

    buildings: Points = field(default_factory=lambda: np.zeros((0, 6)))
    building_colours: npt.NDArray[np.uint8] = field(
        default_factory=lambda: np.zeros((0, 3), dtype=np.uint8)
    )
    trees: Points = field(default_factory=lambda: np.zeros((0, 4)))


@dataclass(frozen=True, slots=True, eq=False)
class Vehicles:
    """The vehicles of one instant, as columns.

    Attributes:
        ids: shape (n,); a vehicle keeps its id, and with it its warmth.
        position: shape (n, 2), centre on the ground, in the world.
        heading: shape (n,).
        length: shape (n,).
        width: shape (n,).
        height: shape (n,).
        colour: shape (n, 3), RGB.
    """

    ids: npt.NDArray[np.int64]
    position: Points
    heading: npt.NDArray[np.float64]
    length: npt.NDArray[np.float64]
    width: npt.NDArray[np.float64]
    height: npt.NDArray[np.float64]
    colour: npt.NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.ids)

    def select(self, rows: Rows) -> "Vehicles":
        """Return the rows for which a mask is true, or those with the given positions."""
        return select(self, rows)


def polygons_of(outlines: Sequence[Points]) -> npt.NDArray[np.object_]:
    """Return outlines as shapely polygons, without those of too few corners."""
    whole = [outline for outline in outlines if len(outline) >= _FEWEST_CORNERS]
    return np.array([shapely.Polygon(outline) for outline in whole], dtype=object)


def build_surroundings(ground: Ground, generator: np.random.Generator) -> Surroundings:
    """Place houses along the roads of *ground* and trees about the country, at random.

    Where the houses are known, each is a box around its outline, and no other is made up.
    """
    outlines = polygons_of(ground.paved)
    if not len(outlines):
        return Surroundings()
    paved = shapely.STRtree(outlines)
    corners = np.concatenate([np.asarray(outline) for outline in ground.paved])
    low, high = corners.min(axis=0) - _MARGIN, corners.max(axis=0) + _MARGIN
    buildings = _known_buildings(ground, generator)
    if not len(buildings):
        buildings = _place_buildings(_scatter(low, high, _AREA_PER_BUILDING, generator), generator)
        buildings[:, 2] = _angle_of_nearest_edge(buildings[:, :2], ground)
        buildings = buildings[_is_clear(buildings, paved)]
    trees = _place_trees(_scatter(low, high, _AREA_PER_TREE, generator), generator)
    trees = trees[_far_from(paved, trees[:, :2], _TREE_CLEARANCE)]
    trees = trees[_apart_from(trees, buildings)]
    palette = np.array(
        [[150, 84, 66], [166, 102, 78], [122, 116, 112], [140, 92, 80], [104, 100, 104]]
    )
    colours = palette[generator.integers(len(palette), size=len(buildings))]
    return Surroundings(buildings, colours.astype(np.uint8), trees)


def _scatter(
    low: Points, high: Points, area_per_point: float, generator: np.random.Generator
) -> Points:
    """Return random points, one for each *area_per_point* square metres of a rectangle."""
    count = min(_MAX_PER_KIND, int(np.prod(high - low) / area_per_point))
    return generator.uniform(low, high, size=(count, 2))


def _known_buildings(ground: Ground, generator: np.random.Generator) -> Points:
    """Return the boxes around the outlines of the houses that are known."""
    outlines = polygons_of(ground.buildings)
    boxes = np.zeros((len(outlines), 6))
    for row, outline in enumerate(outlines):
        corners = shapely.get_coordinates(shapely.oriented_envelope(outline))[:-1]
        along, across = corners[1] - corners[0], corners[2] - corners[1]
        boxes[row, :2] = corners.mean(axis=0)
        boxes[row, 2] = np.arctan2(along[1], along[0])
        boxes[row, 3:5] = np.hypot(*along), np.hypot(*across)
    boxes[:, 5] = generator.uniform(*_BUILDING_HEIGHT, len(boxes))
    return boxes


def _place_buildings(points: Points, generator: np.random.Generator) -> Points:
    count = len(points)
    length = generator.uniform(9.0, 19.0, count)
    width = length * generator.uniform(0.55, 0.95, count)
    height = generator.uniform(*_BUILDING_HEIGHT, count)
    return np.column_stack([points, np.zeros(count), length, width, height])


def _place_trees(points: Points, generator: np.random.Generator) -> Points:
    count = len(points)
    return np.column_stack(
        [points, generator.uniform(1.2, 3.2, count), generator.uniform(0.0, 1.0, count)]
    )


def _angle_of_nearest_edge(points: Points, ground: Ground) -> npt.NDArray[np.float64]:
    """Return the direction of the road outline's edge next to each point."""
    middles = np.concatenate([(p + np.roll(p, -1, axis=0)) / 2 for p in ground.paved])
    edges = np.concatenate([np.roll(p, -1, axis=0) - p for p in ground.paved])
    is_long = np.hypot(edges[:, 0], edges[:, 1]) > 1.0
    if not is_long.any() or not len(points):
        return np.zeros(len(points))
    _, nearest = cKDTree(middles[is_long]).query(points)
    chosen = edges[is_long][nearest]
    return np.asarray(np.arctan2(chosen[:, 1], chosen[:, 0]))


def _is_clear(buildings: Points, paved: shapely.STRtree) -> npt.NDArray[np.bool_]:
    """Return which buildings stand off the roads and off each other."""
    reach = 0.5 * np.hypot(buildings[:, 3], buildings[:, 4])
    clear = _far_from(paved, buildings[:, :2], _BUILDING_CLEARANCE, reach)
    kept = np.zeros(len(buildings), dtype=bool)
    if not clear.any():
        return kept
    neighbours = cKDTree(buildings[:, :2]).query_ball_point(buildings[:, :2], 2 * reach.max())
    for row in np.flatnonzero(clear):
        others = np.array([other for other in neighbours[row] if kept[other]], dtype=int)
        gaps = np.hypot(*(buildings[others, :2] - buildings[row, :2]).T)
        kept[row] = bool((gaps > reach[others] + reach[row]).all())
    return kept


def _far_from(
    paved: shapely.STRtree,
    points: Points,
    clearance: float,
    reach: npt.NDArray[np.float64] | float = 0.0,
) -> npt.NDArray[np.bool_]:
    """Return which points keep *clearance* plus their own *reach* from all outlines."""
    distance = np.full(len(points), np.inf)
    (rows, _), gaps = paved.query_nearest(
        shapely.points(points), all_matches=False, return_distance=True
    )
    distance[rows] = gaps
    return np.asarray(distance > clearance + reach)


def _apart_from(trees: Points, buildings: Points) -> npt.NDArray[np.bool_]:
    """Return which trees do not stand in a building."""
    if not len(buildings) or not len(trees):
        return np.ones(len(trees), dtype=bool)
    distance, nearest = cKDTree(buildings[:, :2]).query(trees[:, :2])
    reach = 0.5 * np.hypot(buildings[nearest, 3], buildings[nearest, 4])
    return np.asarray(distance > reach + trees[:, 2])

"""Paint the ground as a hovering camera sees it: once for each pose, in colour and in warmth.

The ground is painted directly in the image: outlines become a map of surfaces at twice the
resolution, each surface has a colour and a temperature, and a texture that is fixed to the world
lies over them, so that another pose sees the same ground.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

import cv2
import numpy as np
import numpy.typing as npt
import shapely
from shapely.ops import substring

from perception.camera import Camera, Points
from perception.scene import Ground, Surroundings, polygons_of
from perception.shapes import SUN, Material, faces_of_buildings, visible_quads

__all__ = [
    "ASPHALT_TEMPERATURE",
    "FloatImage",
    "GroundPainter",
    "Image",
    "fill_areas",
    "fill_quads",
    "level_from_temperature",
    "make_texture",
    "temperature_from_level",
]

Image = npt.NDArray[np.uint8]
"""Shape (h, w) or, with blue, green and red, (h, w, 3)."""

FloatImage = npt.NDArray[np.float32]

ASPHALT_TEMPERATURE = 37.0
"""Degrees Celsius, on the summer noon on which everything is filmed."""

_LEVELS_PER_DEGREE = 5.0
_BLACK_TEMPERATURE = 8.0

_SUPERSAMPLING = 2
_TEXTURE_PIXEL = 0.25
_TEXTURE_SIZE = 1024
_VERGE = 1.7
_LINE_WIDTH = 0.14
_STOP_LINE_WIDTH = 0.4
_DASH = 3.0
_DASH_PERIOD = 7.5


class Surface(IntEnum):
    """What the ground is covered with."""

    GRASS = 0
    VERGE = 1
    ROAD = 2
    JUNCTION = 3
    PAINT = 4


_COLOURS = np.array(
    [[66, 112, 88], [128, 140, 144], [92, 90, 88], [96, 94, 92], [206, 212, 212]]
)  # blue, green, red
_ROUGHNESS = np.array(
    [[13.0, 17.0, 20.0], [6.0, 6.0, 6.0], [3.5, 3.5, 3.5], [3.5, 3.5, 3.5], [6.0, 6.0, 6.0]]
)
_TEMPERATURES = np.array([27.0, 33.0, ASPHALT_TEMPERATURE, ASPHALT_TEMPERATURE + 0.4, 35.0])
_THERMAL_ROUGHNESS = np.array([1.4, 0.8, 0.35, 0.35, 0.3])
_TEMPERATURE_BY_MATERIAL = {Material.PAINT: 41.0, Material.CANVAS: 33.0}
_TREE_TEMPERATURE = 24.5
_SHADOW_ON_GROUND = 0.62


def level_from_temperature(
    temperature: npt.NDArray[np.float64] | float,
) -> npt.NDArray[np.float64]:
    """Return the grey level of the thermal image for degrees Celsius."""
    levels = (np.asarray(temperature) - _BLACK_TEMPERATURE) * _LEVELS_PER_DEGREE
    return np.asarray(np.clip(levels, 0.0, 255.0))


def temperature_from_level(level: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return degrees Celsius for grey levels of the thermal image."""
    return np.asarray(level / _LEVELS_PER_DEGREE + _BLACK_TEMPERATURE)


def make_texture(generator: np.random.Generator) -> FloatImage:
    """Return a tile (1024, 1024, 2) that repeats: fine grain and broad patches, of deviation 1."""
    frequency = np.fft.fftfreq(_TEXTURE_SIZE)
    radius = np.hypot(*np.meshgrid(frequency, frequency))
    radius[0, 0] = np.inf
    layers = []
    for power in (0.6, 1.7):
        white = generator.standard_normal((_TEXTURE_SIZE, _TEXTURE_SIZE))
        layer = np.fft.ifft2(np.fft.fft2(white) / radius**power).real
        layers.append(layer / layer.std())
    return np.stack(layers, axis=-1).astype(np.float32)


def fill_quads(image: Image, quads: Points, colours: npt.NDArray[np.float64]) -> None:
    """Fill convex quadrilaterals (n, 4, 2) one after another, with anti-aliased edges."""
    corners = np.rint(quads * 16.0).astype(np.int32)
    for quad, colour in zip(corners, colours.tolist(), strict=True):
        cv2.fillConvexPoly(image, quad, colour, cv2.LINE_AA, 4)


def fill_areas(image: Image, areas: npt.NDArray[np.object_], camera: Camera, value: int) -> None:
    """Fill polygons of the ground in an image as large as the camera's or a multiple of it."""
    scale = image.shape[1] / camera.size[0]
    view = shapely.Polygon(camera.footprint()).buffer(0.5)
    seen = areas[shapely.intersects(areas, view)]
    pieces = shapely.get_parts(shapely.intersection(shapely.make_valid(seen), view))
    for piece in pieces[shapely.get_type_id(pieces) == shapely.GeometryType.POLYGON]:
        rings = [piece.exterior, *piece.interiors]
        outlines = [camera.image_from_ground(shapely.get_coordinates(r)[:-1]) for r in rings]
        fixed = [np.rint((o * scale + (scale - 1) / 2) * 16.0).astype(np.int32) for o in outlines]
        cv2.fillPoly(image, fixed, float(value), cv2.LINE_8, 4)


@dataclass(frozen=True, slots=True, eq=False)
class GroundPainter:
    """Paints one piece of country for any camera.

    Attributes:
        ground: Roads and markings.
        surroundings: What stands beside them.
        texture: As made by `make_texture`.
    """

    ground: Ground
    surroundings: Surroundings
    texture: FloatImage

    def paint_colour(self, camera: Camera) -> Image:
        """Return the colour image (h, w, 3) of the ground without vehicles."""
        surfaces = self._surfaces(camera)
        image = _shrink(_look_up(surfaces, _COLOURS), camera)
        rough = _shrink(_look_up(surfaces, _ROUGHNESS), camera)
        texture = self._texture_in(camera)
        grain, patches = texture[..., :1], texture[..., 1:]
        is_grass = _shrink(_look_up(surfaces, np.array([[1.0], [0], [0], [0], [0]])), camera)
        image += rough * (0.55 * grain + 0.8 * patches * (0.25 + 0.75 * is_grass[..., None]))
        painted = np.clip(image, 0.0, 255.0).astype(np.uint8)
        self._paint_shadows(painted, camera)
        self._paint_trees(painted, camera)
        self._paint_buildings(painted, camera)
        return painted

    def paint_thermal(self, camera: Camera) -> Image:
        """Return the thermal image (h, w) of the ground without vehicles."""
        surfaces = self._surfaces(camera)
        warmth = _shrink(_look_up(surfaces, _TEMPERATURES[:, None]), camera)
        rough = _shrink(_look_up(surfaces, _THERMAL_ROUGHNESS[:, None]), camera)
        texture = self._texture_in(camera)
        warmth += rough * (0.4 * texture[..., 0] + 0.8 * texture[..., 1])
        painted = level_from_temperature(warmth.astype(np.float64)).astype(np.uint8)
        level = float(level_from_temperature(_TREE_TEMPERATURE))
        for centre, radius, _ in self._trees_in(camera):
            cv2.circle(painted, centre, radius, level, -1, cv2.LINE_AA, 4)
        faces = faces_of_buildings(self.surroundings, camera)
        quads, rows = visible_quads(faces, camera, inset_px=0.4)
        by_code = np.array([_TEMPERATURE_BY_MATERIAL.get(m, 34.0) for m in Material])
        levels = level_from_temperature(by_code[faces.material[rows]] + 4 * faces.shade[rows] - 4)
        fill_quads(painted, quads, levels[:, None])
        return painted

    def _surfaces(self, camera: Camera) -> Image:
        """Return the map of surfaces at twice the resolution of the image."""
        width, height = camera.size
        surfaces = np.zeros((height * _SUPERSAMPLING, width * _SUPERSAMPLING), dtype=np.uint8)
        view = shapely.Polygon(camera.footprint()).buffer(0.5)
        roads = polygons_of(self.ground.roads)
        junctions = polygons_of(self.ground.junctions)
        verges = shapely.buffer(np.concatenate([roads, junctions]), _VERGE)
        lines = [*self.ground.solid_lines, *_dashes(self.ground.dashed_lines, view)]
        layers = (
            (Surface.VERGE, verges),
            (Surface.ROAD, roads),
            (Surface.PAINT, _strips(lines, _LINE_WIDTH)),
            (Surface.JUNCTION, junctions),
            (Surface.PAINT, _strips(self.ground.stop_lines, _STOP_LINE_WIDTH)),
        )
        for surface, areas in layers:
            fill_areas(surfaces, areas, camera, int(surface))
        return surfaces

    def _texture_in(self, camera: Camera) -> FloatImage:
        """Return the texture (h, w, 2) as it lies on the ground in view."""
        width, height = camera.size
        u, v = np.meshgrid(np.arange(width), np.arange(height))
        ground = camera.ground_from_image(np.column_stack([u.ravel(), v.ravel()]))
        at = np.mod(ground / _TEXTURE_PIXEL, _TEXTURE_SIZE).astype(np.float32)
        maps = at.reshape(height, width, 2)
        return np.asarray(
            cv2.remap(
                self.texture,
                np.ascontiguousarray(maps[..., 0]),
                np.ascontiguousarray(maps[..., 1]),
                cv2.INTER_LINEAR,
                borderMode=cv2.BORDER_WRAP,
            ),
            dtype=np.float32,
        )

    def _paint_buildings(self, image: Image, camera: Camera) -> None:
        faces = faces_of_buildings(self.surroundings, camera)
        quads, rows = visible_quads(faces, camera, inset_px=0.3)
        roofs = self.surroundings.building_colours[faces.owner[rows], ::-1].astype(np.float64)
        walls = np.array([176.0, 190.0, 200.0])
        is_roof = (faces.material[rows] == Material.PAINT)[:, None]
        colours = np.where(is_roof, roofs, walls) * faces.shade[rows, None]
        fill_quads(image, quads, np.clip(colours, 0.0, 255.0))

    def _paint_trees(self, image: Image, camera: Camera) -> None:
        for (u, v), radius, shade in self._trees_in(camera):
            to_sun = (int(0.25 * radius * SUN[0]), int(-0.25 * radius * SUN[1]))
            for grow, light in ((1.0, 0.0), (0.72, 14.0), (0.4, 30.0)):
                colour = (30 + light, 64 + light * 1.3 + 18 * shade, 42 + light + 14 * shade)
                step = 1.6 * (1.0 - grow)
                centre = (int(u + step * to_sun[0]), int(v + step * to_sun[1]))
                cv2.circle(image, centre, int(grow * radius), colour, -1, cv2.LINE_AA, 4)

    def _trees_in(self, camera: Camera) -> list[tuple[tuple[int, int], int, float]]:
        """Return centre and radius in sixteenths of a pixel, and shade, of trees in view."""
        trees = self.surroundings.trees
        trees = trees[camera.sees(trees[:, :2], -40.0)]
        pixels = camera.image_from_ground(trees[:, :2])
        scale = np.sqrt(np.abs(np.linalg.det(camera.ground_per_pixel(pixels))))
        radius = np.rint(16.0 * trees[:, 2] / scale).astype(int).tolist()
        centres = np.rint(16.0 * pixels).astype(int).tolist()
        shades = trees[:, 3].tolist()
        return [((u, v), r, s) for (u, v), r, s in zip(centres, radius, shades, strict=True)]

    def _paint_shadows(self, image: Image, camera: Camera) -> None:
        """Darken the ground behind houses and trees, softly."""
        mask = np.zeros(image.shape[:2], dtype=np.uint8)
        buildings = self.surroundings.buildings
        fill_areas(mask, _building_shadows(buildings), camera, 255)
        for (u, v), radius, _ in self._trees_in(camera):
            centre = (int(u - 0.5 * radius * SUN[0]), int(v + 0.5 * radius * SUN[1]))
            cv2.circle(mask, centre, radius, 255.0, -1, cv2.LINE_AA, 4)
        soft = np.asarray(cv2.GaussianBlur(mask, (0, 0), 1.2), dtype=np.float32) / 255.0
        shaded = image * (1.0 - (1.0 - _SHADOW_ON_GROUND) * soft[..., None])
        np.copyto(image, shaded.astype(np.uint8))


def _strips(lines: Iterable[Points], width: float) -> npt.NDArray[np.object_]:
    """Return lines as narrow polygons."""
    geometry = np.array(
        [shapely.LineString(line) for line in lines if len(line) > 1], dtype=object
    )
    return np.asarray(shapely.buffer(geometry, width / 2, cap_style="flat", join_style="mitre"))


def _dashes(lines: Iterable[Points], view: shapely.Polygon) -> list[Points]:
    """Cut those lines that are in view into dashes."""
    dashes = []
    for line in lines:
        whole = shapely.LineString(line)
        if not whole.intersects(view):
            continue
        for start in np.arange(0.5 * (_DASH_PERIOD - _DASH), whole.length, _DASH_PERIOD):
            dash = substring(whole, start, min(start + _DASH, whole.length))
            dashes.append(shapely.get_coordinates(dash))
    return dashes


def _building_shadows(buildings: Points) -> npt.NDArray[np.object_]:
    """Return the ground that each building keeps the sun from."""
    along = np.column_stack([np.cos(buildings[:, 2]), np.sin(buildings[:, 2])])
    left = np.column_stack([-along[:, 1], along[:, 0]])
    signs = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) / 2
    corners = (
        buildings[:, None, :2]
        + signs[:, :1] * buildings[:, None, 3:4] * along[:, None]
        + signs[:, 1:] * buildings[:, None, 4:5] * left[:, None]
    )
    shift = -0.8 * buildings[:, None, 5:6] * SUN[:2] / SUN[2]
    return np.asarray(
        shapely.convex_hull(
            shapely.multipoints(np.concatenate([corners, corners + shift], axis=1))
        )
    )


def _look_up(surfaces: Image, by_surface: npt.NDArray[np.float64]) -> FloatImage:
    """Return a figure for each pixel from a table (surfaces, channels)."""
    return np.asarray(by_surface.astype(np.float32)[surfaces], dtype=np.float32)


def _shrink(values: FloatImage, camera: Camera) -> FloatImage:
    """Return values at the resolution of the image, each the mean of what it covers."""
    return np.asarray(
        cv2.resize(values, camera.size, interpolation=cv2.INTER_AREA), dtype=np.float32
    )

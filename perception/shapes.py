"""Vehicles and houses as flat convex faces in space, each with a material.

A shape is a table of faces in a unit box (x forward and y left from -0.5 to 0.5, z up from 0 to
1) that is stretched to the length, width and height of each vehicle. Faces are listed in the
order in which they are painted. All vehicles of a frame become one array of faces at once.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from perception.camera import Camera, Points
from perception.scene import Surroundings, Vehicles

__all__ = ["Faces", "Material", "faces_of_buildings", "faces_of_vehicles", "visible_quads"]

_Quad = tuple[
    tuple[float, float, float],
    tuple[float, float, float],
    tuple[float, float, float],
    tuple[float, float, float],
]
_Face = tuple[_Quad, int]

SUN = np.array([-0.42, -0.36, 0.83]) / np.linalg.norm([-0.42, -0.36, 0.83])
"""Direction to the sun in the world: a summer noon, so shadows are short."""

_AMBIENT = 0.66


class Material(IntEnum):
    """What a face is made of; it decides colour and warmth."""

    PAINT = 0
    BONNET = 1
    GLASS = 2
    TYRE = 3
    TRIM = 4
    CANVAS = 5
    NONE = 6


@dataclass(frozen=True, slots=True, eq=False)
class Faces:
    """Faces in space, far things first.

    Attributes:
        corners: shape (n, 4, 3), metres, in the world; counter-clockwise from outside.
        material: shape (n,), codes of `Material`.
        owner: shape (n,), row of the vehicle or building.
        shade: shape (n,), brightness under the sun, at most 1.
    """

    corners: npt.NDArray[np.float64]
    material: npt.NDArray[np.int64]
    owner: npt.NDArray[np.intp]
    shade: npt.NDArray[np.float64]


def faces_of_vehicles(vehicles: Vehicles, camera: Camera) -> Faces:
    """Return the faces of all vehicles, those of the farthest vehicle first."""
    away = vehicles.position - np.array(camera.position[:2])
    order = np.argsort(-np.hypot(away[:, 0], away[:, 1]), kind="stable")
    chosen = vehicles.select(order)
    shape = _shape_of(chosen.length, chosen.width)
    size = np.column_stack([chosen.length, chosen.width, chosen.height])
    return _faces(shape, chosen.position, chosen.heading, size, order)


def faces_of_buildings(surroundings: Surroundings, camera: Camera) -> Faces:
    """Return the faces of all buildings, those of the farthest first."""
    buildings = surroundings.buildings
    away = buildings[:, :2] - np.array(camera.position[:2])
    order = np.argsort(-np.hypot(away[:, 0], away[:, 1]), kind="stable")
    chosen = buildings[order]
    shape = np.full(len(chosen), len(_SHAPES) - 1)
    return _faces(shape, chosen[:, :2], chosen[:, 2], chosen[:, 3:6], order)


def visible_quads(
    faces: Faces, camera: Camera, *, inset_px: float
) -> tuple[Points, npt.NDArray[np.intp]]:
    """Return the quadrilaterals (m, 4, 2) in the image that face the camera, and their rows.

    Each is drawn in by *inset_px* on every side, because anti-aliased filling adds as much.
    """
    pixels = camera.image_from_world(faces.corners.reshape(-1, 3)).reshape(-1, 4, 2)
    diagonal, other = pixels[:, 2] - pixels[:, 0], pixels[:, 3] - pixels[:, 1]
    area = 0.5 * (diagonal[:, 1] * other[:, 0] - diagonal[:, 0] * other[:, 1])
    width, height = camera.size
    inside = (pixels.max(axis=1) > -1.0) & (pixels.min(axis=1) < np.array([width, height]))
    (rows,) = np.nonzero((area > _MIN_FACE_PX) & inside.all(axis=1))
    return _inset(pixels[rows], inset_px), rows


_MIN_FACE_PX = 0.4


def _inset(quads: Points, distance: float) -> Points:
    """Move the corners of convex quadrilaterals inwards, thin ones at most a third."""
    edge = np.roll(quads, -1, axis=1) - quads
    length = np.maximum(np.hypot(edge[..., 0], edge[..., 1]), 1e-6)[..., None]
    forward = edge / length
    backward = np.roll(forward, 1, axis=1)
    reach = np.minimum(distance, length / 3)
    return np.asarray(quads + reach * forward - np.roll(reach, 1, axis=1) * backward)


def _faces(
    shape: npt.NDArray[np.intp],
    position: Points,
    heading: npt.NDArray[np.float64],
    size: Points,
    owner: npt.NDArray[np.intp],
) -> Faces:
    """Stretch, turn and move the shapes, one for each row."""
    local = _CORNERS[shape] * size[:, None, None, :]
    cos, sin = np.cos(heading)[:, None, None], np.sin(heading)[:, None, None]
    corners = np.empty_like(local)
    corners[..., 0] = cos * local[..., 0] - sin * local[..., 1] + position[:, 0, None, None]
    corners[..., 1] = sin * local[..., 0] + cos * local[..., 1] + position[:, 1, None, None]
    corners[..., 2] = local[..., 2]
    material = _MATERIALS[shape]
    used = material != Material.NONE
    normal = np.cross(
        corners[..., 2, :] - corners[..., 0, :], corners[..., 3, :] - corners[..., 1, :]
    )
    length = np.maximum(np.linalg.norm(normal, axis=-1), 1e-9)
    light = np.maximum(0.0, (normal @ SUN) / length)
    shade = _AMBIENT + (1.0 - _AMBIENT) * light / SUN[2]
    owners = np.broadcast_to(owner[:, None], material.shape)
    return Faces(corners[used], material[used], owners[used], np.minimum(shade[used], 1.1))


def _shape_of(
    length: npt.NDArray[np.float64], width: npt.NDArray[np.float64]
) -> npt.NDArray[np.intp]:
    """Choose the shape by size: car, lorry or van, bus, motorcycle."""
    shape = np.zeros(len(length), dtype=np.intp)
    shape[length > _LONGEST_CAR] = 1
    shape[length > _LONGEST_LORRY] = 2
    shape[(length < _SHORTEST_CAR) | (width < _NARROWEST_CAR)] = 3
    return shape


_LONGEST_CAR = 5.6
_LONGEST_LORRY = 10.0
_SHORTEST_CAR = 3.0
_NARROWEST_CAR = 1.2


def _block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> list[_Quad]:
    """Return front, rear, left, right and top of a block."""
    return _frustum(x, y, z, x, y)


def _frustum(
    x: tuple[float, float],
    y: tuple[float, float],
    z: tuple[float, float],
    top_x: tuple[float, float],
    top_y: tuple[float, float],
) -> list[_Quad]:
    """Return front, rear, left, right and top of a block that narrows upwards."""
    (x0, x1), (y0, y1), (z0, z1) = x, y, z
    (a0, a1), (b0, b1) = top_x, top_y
    return [
        ((x1, y0, z0), (x1, y1, z0), (a1, b1, z1), (a1, b0, z1)),
        ((x0, y1, z0), (x0, y0, z0), (a0, b0, z1), (a0, b1, z1)),
        ((x1, y1, z0), (x0, y1, z0), (a0, b1, z1), (a1, b1, z1)),
        ((x0, y0, z0), (x1, y0, z0), (a1, b0, z1), (a0, b0, z1)),
        ((a0, b0, z1), (a1, b0, z1), (a1, b1, z1), (a0, b1, z1)),
    ]


def _wheels(places: tuple[float, ...], half_length: float, top: float) -> list[_Face]:
    """Return a tyre on the left and one on the right side at each place along x."""
    faces: list[_Face] = []
    for at in places:
        near, far = at - half_length, at + half_length
        left: _Quad = ((far, 0.5, 0.0), (near, 0.5, 0.0), (near, 0.5, top), (far, 0.5, top))
        right: _Quad = ((near, -0.5, 0.0), (far, -0.5, 0.0), (far, -0.5, top), (near, -0.5, top))
        faces += [(left, Material.TYRE), (right, Material.TYRE)]
    return faces


def _painted(quads: list[_Quad], *materials: Material) -> list[_Face]:
    return list(zip(quads, map(int, materials), strict=True))


def _top(x: tuple[float, float], y: tuple[float, float], z: float) -> _Quad:
    return ((x[0], y[0], z), (x[1], y[0], z), (x[1], y[1], z), (x[0], y[1], z))


def _car() -> list[_Face]:
    paint, glass = Material.PAINT, Material.GLASS
    body = _block((-0.5, 0.5), (-0.5, 0.5), (0.08, 0.58))
    bonnet = (_top((0.2, 0.49), (-0.47, 0.47), 0.58), int(Material.BONNET))
    cabin = _frustum((-0.42, 0.24), (-0.46, 0.46), (0.58, 1.0), (-0.31, 0.06), (-0.39, 0.39))
    return [
        *_painted(body, paint, paint, paint, paint, paint),
        *_wheels((-0.31, 0.31), 0.065, 0.42),
        bonnet,
        *_painted(cabin, glass, glass, glass, glass, paint),
    ]


def _lorry() -> list[_Face]:
    paint, glass, canvas = Material.PAINT, Material.GLASS, Material.CANVAS
    load = _block((-0.5, 0.24), (-0.5, 0.5), (0.2, 1.0))
    cab = _block((0.26, 0.5), (-0.46, 0.46), (0.12, 0.82))
    screen = _top((0.44, 0.495), (-0.4, 0.4), 0.825)
    chassis = _block((-0.48, 0.5), (-0.46, 0.46), (0.1, 0.24))
    trim = Material.TRIM
    return [
        *_painted(chassis, trim, trim, trim, trim, trim),
        *_painted(load, canvas, canvas, canvas, canvas, canvas),
        *_wheels((-0.34, 0.36), 0.05, 0.3),
        *_painted(cab, glass, paint, paint, paint, Material.BONNET),
        (screen, int(glass)),
    ]


def _bus() -> list[_Face]:
    paint, glass, trim = Material.PAINT, Material.GLASS, Material.TRIM
    lower = _block((-0.5, 0.5), (-0.5, 0.5), (0.08, 0.45))
    windows = _block((-0.5, 0.5), (-0.5, 0.5), (0.45, 0.82))
    upper = _block((-0.5, 0.5), (-0.5, 0.5), (0.82, 1.0))
    hatches = [_top((-0.3, -0.16), (-0.28, 0.28), 1.0), _top((0.1, 0.18), (-0.2, 0.2), 1.0)]
    return [
        *_painted(lower, paint, paint, paint, paint, paint),
        *_wheels((-0.28, 0.3), 0.04, 0.28),
        *_painted(windows, glass, glass, glass, glass, glass),
        *_painted(upper, paint, paint, paint, paint, paint),
        *_painted(hatches, Material.BONNET, trim),
    ]


def _motorcycle() -> list[_Face]:
    paint, trim = Material.PAINT, Material.TRIM
    machine = _block((-0.5, 0.5), (-0.3, 0.3), (0.0, 0.5))
    rider = _frustum((-0.3, 0.22), (-0.5, 0.5), (0.4, 0.85), (-0.25, 0.12), (-0.42, 0.42))
    helmet = _block((-0.12, 0.06), (-0.2, 0.2), (0.85, 1.0))
    return [
        *_painted(machine, Material.TYRE, Material.TYRE, trim, trim, Material.BONNET),
        *_painted(rider, paint, paint, paint, paint, paint),
        *_painted(helmet, trim, trim, trim, trim, Material.CANVAS),
    ]


def _house() -> list[_Face]:
    wall, roof = Material.CANVAS, Material.PAINT
    walls = _block((-0.5, 0.5), (-0.5, 0.5), (0.0, 0.62))
    hip = _frustum((-0.5, 0.5), (-0.5, 0.5), (0.62, 1.0), (-0.22, 0.22), (-0.02, 0.02))
    return [
        *_painted(walls, wall, wall, wall, wall, wall),
        *_painted(hip, roof, roof, roof, roof, roof),
    ]


def _tabulate(
    shapes: list[list[_Face]],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Return corners (k, f, 4, 3) and materials (k, f), padded with faces of no material."""
    most = max(len(shape) for shape in shapes)
    corners = np.zeros((len(shapes), most, 4, 3))
    materials = np.full((len(shapes), most), int(Material.NONE))
    for row, shape in enumerate(shapes):
        for column, (quad, material) in enumerate(shape):
            corners[row, column] = quad
            materials[row, column] = material
    return corners, materials


_SHAPES = [_car(), _lorry(), _bus(), _motorcycle(), _house()]
_CORNERS, _MATERIALS = _tabulate(_SHAPES)

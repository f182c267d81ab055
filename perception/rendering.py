"""Draw a scene as the colour camera and as the thermal camera would see it.

The ground is painted once for each pose of the camera. For each frame it is copied, the vehicles
are drawn over it as shaded boxes, the farthest first, and the noise of the sensor is laid over
everything from a tile made beforehand, at a random offset: as random as fresh noise to whoever
looks at a pixel, and a hundred times as fast.
"""

import cv2
import numpy as np
import numpy.typing as npt

from perception.camera import Camera, Points
from perception.lamps import Lamps
from perception.painting import (
    ASPHALT_TEMPERATURE,
    GroundPainter,
    Image,
    fill_quads,
    level_from_temperature,
)
from perception.scene import Vehicles
from perception.shapes import SUN, Material, faces_of_vehicles, visible_quads

__all__ = ["ColourRenderer", "SensorNoise", "ThermalRenderer", "temperature_of_vehicles"]

_EDGE_INSET_PX = 0.45
_TILE_SLACK = 192
_SIGHT_MARGIN_PX = 90.0

_COLOUR_NOISE = 2.5
_THERMAL_NOISE = 1.6

_SHADOW = 0.7
_PENUMBRA = 0.84
_COLD_SHARE = 0.55

_MATERIAL_COLOURS = np.array(
    [[0, 0, 0], [0, 0, 0], [52, 40, 34], [26, 26, 26], [52, 52, 50], [196, 200, 202], [0, 0, 0]],
    dtype=np.float64,
)  # blue, green, red


class SensorNoise:
    """Noise of one deviation for every pixel of every frame, from one tile.

    What it is added to must have been lowered by `headroom`, the mean of the tile.
    """

    def __init__(
        self, shape: tuple[int, ...], deviation: float, generator: np.random.Generator
    ) -> None:
        self.headroom = int(np.ceil(4.0 * deviation))
        self._generator = generator
        size = (shape[0] + _TILE_SLACK, shape[1] + _TILE_SLACK, *shape[2:])
        noise = np.rint(generator.normal(self.headroom, deviation, size))
        self._tile = np.clip(noise, 0, 2 * self.headroom).astype(np.uint8)

    def add_to(self, image: Image) -> None:
        """Add noise to *image* in place."""
        row, column = self._offset()
        height, width = image.shape[:2]
        cv2.add(image, self._tile[row : row + height, column : column + width], dst=image)

    def skip(self) -> None:
        """Let the next image have the noise that it would have after one more."""
        self._offset()

    def _offset(self) -> tuple[int, int]:
        row, column = self._generator.integers(_TILE_SLACK, size=2)
        return int(row), int(column)


class ColourRenderer:
    """The colour camera: images of shape (h, w, 3), blue, green, red."""

    def __init__(
        self,
        painter: GroundPainter,
        generator: np.random.Generator,
        *,
        noise: float = _COLOUR_NOISE,
        lamps: Lamps | None = None,
    ) -> None:
        self._lamps = lamps
        self._painter = painter
        self._generator = generator
        self._deviation = noise
        self._camera: Camera | None = None

    def render(
        self,
        vehicles: Vehicles,
        camera: Camera,
        lights: npt.NDArray[np.integer] | None = None,
    ) -> Image:
        """Return the image of *vehicles* on the ground, lamps lit as *lights* say."""
        if camera != self._camera:
            self._turn_to(camera)
        image = self._ground.copy()
        seen = _in_view(vehicles, camera)
        if len(seen):
            self._draw_shadows(image, seen, camera)
        if self._lamps is not None and lights is not None:
            self._lamps.draw(image, lights, camera, self._noise.headroom)
        if len(seen):
            faces = faces_of_vehicles(seen, camera)
            quads, rows = visible_quads(faces, camera, inset_px=_EDGE_INSET_PX)
            paint = seen.colour[faces.owner[rows], ::-1].astype(np.float64)
            material = faces.material[rows]
            is_painted = (material == Material.PAINT) | (material == Material.BONNET)
            colours = np.where(is_painted[:, None], paint, _MATERIAL_COLOURS[material])
            colours = colours * faces.shade[rows, None] - self._noise.headroom
            fill_quads(image, quads, np.clip(colours, 0.0, 255.0))
        self._noise.add_to(image)
        return image

    def skip(self, camera: Camera) -> None:
        """Pass over an image: the next one is what it would be if this one had been rendered."""
        if camera != self._camera:
            self._turn_to(camera)
        self._noise.skip()

    def _turn_to(self, camera: Camera) -> None:
        """Paint the ground for another pose, in the sun, in half shadow, and in shadow."""
        ground = self._painter.paint_colour(camera)
        if self._camera is None or self._camera.size != camera.size:
            self._noise = SensorNoise(ground.shape, self._deviation, self._generator)
        self._camera = camera
        lowered = [
            cv2.addWeighted(ground, light, ground, 0.0, -float(self._noise.headroom))
            for light in (1.0, _PENUMBRA, _SHADOW)
        ]
        self._ground, *self._shaded = (np.asarray(image, dtype=np.uint8) for image in lowered)

    def _draw_shadows(self, image: Image, vehicles: Vehicles, camera: Camera) -> None:
        outlines = _shadow_outlines(vehicles)
        pixels = camera.image_from_ground(outlines.reshape(-1, 2)).reshape(-1, 8, 2)
        width, height = camera.size
        for outline in pixels:
            low = np.maximum(np.floor(outline.min(axis=0)).astype(int) - 2, 0)
            high = np.minimum(np.ceil(outline.max(axis=0)).astype(int) + 3, (width, height))
            if (high <= low).any():
                continue
            window = np.s_[low[1] : high[1], low[0] : high[0]]
            hull = cv2.convexHull((outline - low).astype(np.float32))[:, 0]
            middle = hull.mean(axis=0)
            for share, shaded in zip((1.06, 0.9), self._shaded, strict=True):
                mask = np.zeros((high[1] - low[1], high[0] - low[0]), dtype=np.uint8)
                corners = np.rint((middle + share * (hull - middle)) * 16.0).astype(np.int32)
                cv2.fillConvexPoly(mask, corners, 255.0, cv2.LINE_8, 4)
                cv2.copyTo(shaded[window], mask, image[window])


class ThermalRenderer:
    """The thermal camera: images of shape (h, w), brighter where warmer."""

    def __init__(
        self,
        painter: GroundPainter,
        generator: np.random.Generator,
        *,
        noise: float = _THERMAL_NOISE,
        cold_share: float = _COLD_SHARE,
    ) -> None:
        self._painter = painter
        self._generator = generator
        self._deviation = noise
        self._cold_share = cold_share
        self._camera: Camera | None = None

    def render(self, vehicles: Vehicles, camera: Camera) -> Image:
        """Return the image of *vehicles* on the ground."""
        if camera != self._camera:
            self._turn_to(camera)
        image = self._ground.copy()
        seen = _in_view(vehicles, camera)
        if len(seen):
            warmth = temperature_of_vehicles(seen.ids, cold_share=self._cold_share)
            faces = faces_of_vehicles(seen, camera)
            quads, rows = visible_quads(faces, camera, inset_px=_EDGE_INSET_PX)
            degrees = warmth[faces.owner[rows], faces.material[rows]]
            levels = level_from_temperature(degrees + 3.0 * (faces.shade[rows] - 1.0))
            fill_quads(image, quads, np.maximum(levels - self._noise.headroom, 0.0)[:, None])
        self._noise.add_to(image)
        return image

    def skip(self, camera: Camera) -> None:
        """Pass over an image: the next one is what it would be if this one had been rendered."""
        if camera != self._camera:
            self._turn_to(camera)
        self._noise.skip()

    def _turn_to(self, camera: Camera) -> None:
        """Paint the ground for another pose."""
        ground = self._painter.paint_thermal(camera)
        if self._camera is None or self._camera.size != camera.size:
            self._noise = SensorNoise(ground.shape, self._deviation, self._generator)
        self._camera = camera
        headroom = np.full_like(ground, self._noise.headroom)
        self._ground = np.asarray(cv2.subtract(ground, headroom), dtype=np.uint8)


def temperature_of_vehicles(
    ids: npt.NDArray[np.int64], *, cold_share: float = _COLD_SHARE
) -> npt.NDArray[np.float64]:
    """Return degrees Celsius of each material of each vehicle, shape (n, materials).

    Some vehicles, *cold_share* of them, have lately come out of the shade and are colder than
    the asphalt; the others are warmer. Which ones depends on the id only. The engine warms the
    bonnet, and the tyres are warm.
    """
    lot = _lots(ids)
    cold = lot[:, 0] < cold_share
    body = ASPHALT_TEMPERATURE + np.where(cold, -6.0 - 9.0 * lot[:, 1], 5.0 + 8.0 * lot[:, 1])
    engine = np.where(cold, 1.5 + 2.0 * lot[:, 2], 7.0 + 6.0 * lot[:, 2])
    degrees = np.repeat(body[:, None], len(Material), axis=1)
    degrees[:, Material.BONNET] += engine
    degrees[:, Material.GLASS] -= 2.0
    degrees[:, Material.TYRE] = ASPHALT_TEMPERATURE + 5.0
    degrees[:, Material.CANVAS] -= 1.0
    return degrees


def _lots(ids: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """Return three numbers in [0, 1) for each id, shape (n, 3), as if drawn by lot.

    This is the finaliser of SplitMix64 (Steele, Lea and Flood 2014, 'Fast splittable
    pseudorandom number generators').
    """
    turn = np.arange(1, 4, dtype=np.uint64)
    state = np.asarray(ids.astype(np.uint64)[:, None] * np.uint64(3) + turn, dtype=np.uint64)
    state = state * np.uint64(0x9E3779B97F4A7C15)
    state = (state ^ (state >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ (state >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    state = state ^ (state >> np.uint64(31))
    return np.asarray((state >> np.uint64(11)).astype(np.float64) / 2.0**53)


def _in_view(vehicles: Vehicles, camera: Camera) -> Vehicles:
    """Return the vehicles of which some part may be in the image."""
    return vehicles.select(camera.sees(vehicles.position, -_SIGHT_MARGIN_PX))


def _shadow_outlines(vehicles: Vehicles) -> Points:
    """Return the corners (n, 8, 2) whose hull is the shadow of each vehicle on the ground."""
    along = np.column_stack([np.cos(vehicles.heading), np.sin(vehicles.heading)])
    left = np.column_stack([-along[:, 1], along[:, 0]])
    forward = 0.5 * vehicles.length[:, None] * along
    sideward = 0.5 * vehicles.width[:, None] * left
    corners = np.stack(
        [forward + sideward, sideward - forward, -forward - sideward, forward - sideward], axis=1
    )
    shift = -vehicles.height[:, None, None] * SUN[:2] / SUN[2]
    roof = vehicles.position[:, None] + 0.75 * corners + shift
    return np.concatenate([vehicles.position[:, None] + corners, roof], axis=1)

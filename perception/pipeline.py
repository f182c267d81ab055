"""From the two images of one instant to percepts, in the order in which it happens.

The pipeline knows pixels, the pose of the camera, and where the map has roads; nothing else.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt
import shapely

from perception.background import (
    Background,
    BackgroundSettings,
    find_standing,
    guess_empty_road,
)
from perception.blobs import Blobs, find_blobs, mean_within
from perception.camera import Camera, Points
from perception.columns import concatenate, select
from perception.fusion import fuse
from perception.joining import Outline, Outlines, join
from perception.lamps import Lamps, mask_of, without_lamps
from perception.locating import Sightings, locate, no_sightings
from perception.painting import FloatImage, Image, fill_areas, temperature_from_level
from perception.scene import polygons_of
from perception.splitting import split
from perception.stains import Stains
from perception.tracking import Tracker, TrackingSettings, Tracks

__all__ = ["Eye", "EyeSettings", "Percepts", "Pipeline", "PipelineSettings", "road_mask"]


@dataclass(frozen=True, slots=True)
class EyeSettings:
    """How one camera's images are read.

    Attributes:
        background: How the background is learned.
        noise_px: Deviation of the centroids of outlines, in pixels.
        bridged: Metres; parts of a vehicle that are less apart than this become one blob.
    """

    background: BackgroundSettings
    noise_px: float
    bridged: float = 0.0


@dataclass(frozen=True, slots=True)
class PipelineSettings:
    """What the pipeline takes for a vehicle, and how it learns and follows.

    Attributes:
        roadside: Metres beside the roads in which vehicles are still looked for.
        least_area: Square metres of the smallest vehicle's outline.
        least_width: Metres; anything narrower is a marking.
        thinnest: Metres; parts thinner than this do not join what they touch.
        least_fill: Share of a vehicle's rectangle that its outline fills at least; crossed
            markings fill less.
        guard: Metres around blobs where the background is not learned.
        crowded: Share of the road that looks unlike the background when all of it is wrong.
        colour: How colour images are read. Windows look like shadows and part what they are
            between; windows, grey paint and shadows make outlines less certain.
        thermal: How thermal images are read.
        tracking: How blobs are followed.
    """

    roadside: float = 1.5
    least_area: float = 0.9
    least_width: float = 0.5
    thinnest: float = 0.6
    least_fill: float = 0.45
    guard: float = 2.5
    crowded: float = 0.6
    colour: EyeSettings = field(
        default_factory=lambda: EyeSettings(BackgroundSettings(darkest_shadow=0.66), 1.2, 1.0)
    )
    thermal: EyeSettings = field(
        default_factory=lambda: EyeSettings(BackgroundSettings(contrast=16.0), 0.4)
    )
    tracking: TrackingSettings = field(default_factory=TrackingSettings)


@dataclass(frozen=True, slots=True, eq=False)
class Percepts:
    """What is seen at one instant, as columns.

    Attributes:
        ids: shape (n,), of the tracks.
        position: shape (n, 2), as measured in this frame.
        velocity: shape (n, 2), as filtered.
        covariance: shape (n, 2, 2), of the measured position.
        length: shape (n,).
        width: shape (n,).
        colour: shape (n, 3), mean red, green and blue; NaN without a colour image.
        temperature: shape (n,), mean, degrees Celsius; NaN without a thermal image.
    """

    ids: npt.NDArray[np.int64]
    position: Points
    velocity: Points
    covariance: npt.NDArray[np.float64]
    length: npt.NDArray[np.float64]
    width: npt.NDArray[np.float64]
    colour: npt.NDArray[np.float32]
    temperature: npt.NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.ids)


class Pipeline:
    """Sees vehicles on roads through a colour and a thermal camera that share one pose."""

    def __init__(
        self,
        roads: Sequence[Points],
        settings: PipelineSettings | None = None,
        lamps: Lamps | None = None,
    ) -> None:
        """Look for vehicles on *roads*, outlines of shape (k, 2) on the ground, past *lamps*."""
        self._roads = roads
        self._lamps = lamps
        self._settings = settings or PipelineSettings()
        self._tracker = Tracker(self._settings.tracking)
        self._stains = Stains()
        self._view: View | None = None

    def perceive(
        self, time: int, colour: Image | None, thermal: Image | None, camera: Camera
    ) -> Percepts:
        """Return what is seen in the images of *time* (nanoseconds); either may be missing.

        Another pose of the camera begins the learning of the background anew.
        """
        view = self._view_of(camera)
        if colour is not None and self._lamps is not None and len(self._lamps):
            colour = self._without_lamps(colour, self._lamps, view)
        self._begin(view, colour, thermal)
        by_colour = self._colour.look(colour, view)
        by_warmth = self._thermal.look(thermal, view)
        in_colour = self._colour.lay_ghosts(colour, by_colour, by_warmth, view)
        in_thermal = self._thermal.lay_ghosts(thermal, by_warmth, by_colour, view)
        in_colour.blob[:] += len(by_warmth.blobs)
        outlines = by_warmth.blobs.outlines + by_colour.blobs.outlines
        is_cut = np.concatenate([by_warmth.blobs.touches_border, by_colour.blobs.touches_border])
        sightings = _leave_out(fuse(in_thermal, in_colour), is_cut)
        shown = _leave_out(concatenate([in_thermal, in_colour]), is_cut)
        tracks = self._tracker.predict(time)
        tracks = select(tracks, tracks.hits >= self._settings.tracking.hits_to_count)
        sightings, outlines = join(sightings, outlines, shown, tracks, camera)
        sightings, outlines, is_part = split(sightings, outlines, tracks, camera)
        seen, rows = self._tracker.update(sightings, is_part)
        sightings = select(sightings, rows)
        is_colour_only = (sightings.blob >= len(by_warmth.blobs)) & (sightings.blob < len(is_cut))
        is_doubtful = is_colour_only & (thermal is not None)
        believed, stains = self._stains.judge(time, seen.ids, sightings.position, is_doubtful)
        self._colour.adopt(colour, [outlines[blob] for blob in sightings.blob[stains]], view)
        learnable = self._away_from(outlines, view)
        self._colour.learn(colour, learnable)
        self._thermal.learn(thermal, learnable)
        return select(_percepts(seen, sightings, outlines, colour, thermal), believed)

    def _view_of(self, camera: Camera) -> "View":
        """Return the map as *camera* sees it; a new pose needs new eyes."""
        if self._view is None or self._view.camera != camera:
            self._view = View.of(self._roads, camera, self._settings)
            self._lamp_mask: Image | None = None
            self._colour = Eye(self._settings, self._settings.colour)
            self._thermal = Eye(self._settings, self._settings.thermal)
        return self._view

    def _without_lamps(self, colour: Image, lamps: Lamps, view: "View") -> Image:
        """Return the image with lamps as plain as the road was in the first one."""
        if self._lamp_mask is None:
            self._lamp_mask = mask_of(lamps, view.camera)
            self._plain = np.median(colour[view.road != 0], axis=0).tolist()
        return without_lamps(colour, self._lamp_mask, self._plain)

    def _begin(self, view: "View", colour: Image | None, thermal: Image | None) -> None:
        """Begin to learn with the first image of each camera.

        What stands on the road is taken from both: a grey car on grey asphalt is warm or cold.
        """
        images = ((self._colour, colour), (self._thermal, thermal))
        fresh = [(e, i) for e, i in images if i is not None and not e.has_background]
        if fresh:
            standing = np.zeros_like(view.road)
            for eye, image in images:
                if image is not None:
                    standing |= eye.find_standing(image, view)
            for eye, image in fresh:
                eye.begin(image, standing, view)

    def _away_from(self, outlines: Outlines, view: "View") -> Image:
        """Return where the background may be learned: not near any blob."""
        view.learnable[:] = 255
        guard = max(1, round(self._settings.guard / view.scale))
        for outline in outlines:
            left, top = np.maximum(outline.min(axis=0) - guard, 0)
            right, low = outline.max(axis=0) + guard + 1
            view.learnable[top:low, left:right] = 0
        return view.learnable


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """What the map says about the images of one pose.

    Attributes:
        camera: The pose.
        scale: Metres per pixel.
        road: 255 where the image shows road, else 0.
        region: The same with the roadside: where vehicles are looked for.
        region_size: Number of pixels of the region.
        thinnest: Pixels across the thinnest part of a vehicle.
        min_outline: Pixels on the border of the smallest vehicle, about.
        learnable: A mask to be written to.
    """

    camera: Camera
    scale: float
    road: Image
    region: Image
    region_size: int
    thinnest: int
    min_outline: int
    learnable: Image

    @classmethod
    def of(cls, roads: Sequence[Points], camera: Camera, settings: PipelineSettings) -> "View":
        """Return the view of *camera* on the map."""
        scale = camera.metres_per_pixel()
        region = road_mask(roads, camera, margin=settings.roadside)
        return cls(
            camera,
            scale,
            road_mask(roads, camera, margin=-_ROAD_EDGE),
            region,
            max(1, cv2.countNonZero(region)),
            max(1, int(settings.thinnest / scale)),
            max(6, round(math.sqrt(settings.least_area) / scale)),
            np.empty_like(region),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """What one camera shows of vehicles.

    Attributes:
        blobs: Their outlines.
        sightings: shape (n,), where they are.
        is_ghost: shape (n,), whether the background alone has the outline.
    """

    blobs: Blobs
    sightings: Sightings
    is_ghost: npt.NDArray[np.bool_]


_NOTHING_SEEN = Look(Blobs((), np.zeros(0, bool)), no_sightings(), np.zeros(0, bool))


class Eye:
    """One camera's way from image to sightings, with its background."""

    def __init__(self, settings: PipelineSettings, own: EyeSettings) -> None:
        """Read images with *settings*, and its *own* for this camera."""
        self._settings = settings
        self._own = own
        self._background: Background | None = None

    @property
    def has_background(self) -> bool:
        """Whether an image has been looked at."""
        return self._background is not None

    def find_standing(self, image: Image, view: View) -> Image:
        """Return where vehicles seem to stand, from one image alone."""
        return find_standing(image, view.road, self._own.background, view.scale)

    def begin(self, image: Image, standing: Image, view: View) -> None:
        """Begin to learn the background."""
        settings = self._own.background
        empty = guess_empty_road(image, view.road, standing, settings, view.scale)
        self._background = Background(empty, settings)

    def look(self, image: Image | None, view: View) -> "Look":
        """Return the blobs of *image* that may be vehicles."""
        if image is None or self._background is None:
            return _NOTHING_SEEN
        blobs = self._find(image, self._background, view)
        sightings = locate(blobs, view.camera, noise_px=self._own.noise_px)
        rectangle = sightings.length * sightings.width
        is_vehicle = (
            (sightings.area >= self._settings.least_area)
            & (sightings.width >= self._settings.least_width)
            & (sightings.area >= self._settings.least_fill * rectangle)
            & ((sightings.width >= _NARROW) | (sightings.width >= _SLIM * sightings.length))
        )
        blobs, sightings = blobs.select(is_vehicle), select(sightings, is_vehicle)
        sightings.blob[:] = np.arange(len(blobs))
        return Look(blobs, sightings, self._background.is_ghost(image, blobs))

    def lay_ghosts(
        self, image: Image | None, look: "Look", other: "Look", view: View
    ) -> Sightings:
        """Return the sightings that are real, and learn the road under the others.

        A ghost is believed only where the other camera sees nothing: a grey car that hides a
        marking looks like the ghost of the marking.
        """
        is_ghost = look.is_ghost & ~look.blobs.meets(other.blobs.select(~other.is_ghost))
        self.adopt(image, look.blobs.select(is_ghost).outlines, view)
        return select(look.sightings, ~is_ghost)

    def adopt(self, image: Image | None, outlines: Sequence[Outline], view: View) -> None:
        """Take what lies in *outlines* for the empty road from now on."""
        if len(outlines) and image is not None and self._background is not None:
            self._background.adopt(image, _area_of(outlines, view))

    def learn(self, image: Image | None, learnable: Image) -> None:
        """Learn the background where *learnable* is not zero."""
        if image is not None and self._background is not None:
            self._background.learn(image, learnable)

    def _find(self, image: Image, background: Background, view: View) -> Blobs:
        foreground = background.foreground(image, view.region)
        if cv2.countNonZero(foreground) > self._settings.crowded * view.region_size:
            self._background = background = Background(image, self._own.background)
            foreground = background.foreground(image, view.region)
        return find_blobs(
            foreground,
            bridged=1 + int(self._own.bridged / view.scale),
            thinnest=view.thinnest,
            min_outline=view.min_outline,
        )


def _area_of(outlines: Sequence[Outline], view: View) -> Image:
    """Return a mask of what lies in *outlines* and next to it."""
    mask = np.zeros_like(view.region)
    cv2.drawContours(mask, outlines, -1, 255.0, 5)
    cv2.drawContours(mask, outlines, -1, 255.0, cv2.FILLED)
    return mask


def _leave_out(sightings: Sightings, is_cut: npt.NDArray[np.bool_]) -> Sightings:
    """Return the sightings whose blobs are wholly in the image."""
    return select(sightings, ~is_cut[sightings.blob])


_NARROW = 1.5
_SLIM = 0.3
"""What is narrower than a car and slimmer than a motorcycle is a marking."""

_ROAD_EDGE = 0.3
_SEAM = 0.05
"""Metres by which outlines grow so that those that meet leave no seam."""


def road_mask(roads: Sequence[Points], camera: Camera, *, margin: float) -> Image:
    """Return where the image shows roads, widened by *margin* metres: 255, elsewhere 0."""
    mask = np.zeros((camera.size[1], camera.size[0]), dtype=np.uint8)
    whole = shapely.union_all(shapely.buffer(polygons_of(roads), _SEAM)).buffer(margin)
    fill_areas(mask, shapely.get_parts(whole), camera, 255)
    return mask


def _percepts(
    tracks: Tracks,
    sightings: Sightings,
    outlines: Outlines,
    colour: Image | None,
    thermal: Image | None,
) -> Percepts:
    chosen = [outlines[blob] for blob in sightings.blob]
    unknown: FloatImage = np.full((len(chosen), 3), np.nan, dtype=np.float32)
    mean_colour = unknown if colour is None else mean_within(colour, chosen)[:, ::-1]
    level = unknown if thermal is None else mean_within(thermal, chosen)
    return Percepts(
        tracks.ids,
        sightings.position,
        tracks.states[:, 2:],
        sightings.covariance,
        tracks.length,
        tracks.width,
        mean_colour,
        temperature_from_level(level[:, 0].astype(np.float64)).astype(np.float32),
    )

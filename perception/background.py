"""What the empty road looks like, learned from pixels only.

Each pixel has a running mean and, derived from it, two bounds: while all its channels lie between
them it belongs to the background. The upper bound lies a few deviations of the measured noise
above the mean. So does the lower one below it, except that a colour camera also allows for the
darkening of a shadow. The mean follows slowly, a strip of rows at a time, and never where a
vehicle is or may be: a car that waits at a light for a minute and a half is not absorbed.

Two things can still be wrong. A vehicle that stands there in the first image would be taken for
road; what is as large as a vehicle and differs from the usual road surface is therefore replaced
by road from around it (`guess_empty_road`). And a vehicle that was taken for road after all
leaves a ghost when it goes, a blob that is not there: its outline is an edge in the background
and none in the image (`Background.is_ghost`), and the background is then learned anew.
"""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from perception.blobs import Blobs, per_blob_mean
from perception.painting import FloatImage, Image

__all__ = ["Background", "BackgroundSettings", "find_standing", "guess_empty_road"]


@dataclass(frozen=True, slots=True)
class BackgroundSettings:
    """How a background is learned.

    Attributes:
        darkest_shadow: What a shadow leaves of the light on the road; 1 for none.
        bound: Distance of the bounds from the mean, in deviations of the noise.
        contrast: Grey levels by which vehicles of the first image differ from the road.
        strips: Number of frames in which every row is learned once.
        slowest_rate: Weight of a new image once many have been seen.
    """

    darkest_shadow: float = 1.0
    bound: float = 5.5
    contrast: float = 22.0
    strips: int = 10
    slowest_rate: float = 0.04


class Background:
    """The empty road as one camera at one pose sees it."""

    def __init__(self, first: Image, settings: BackgroundSettings) -> None:
        """Begin with *first*, an image without vehicles as far as is known."""
        self._settings = settings
        self._mean: FloatImage = first.astype(np.float32)
        self._upper = np.empty_like(first)
        self._lower = np.empty_like(first)
        self._foreground = np.zeros(first.shape[:2], dtype=np.uint8)
        self._noise = _noise_of(first)
        self._strip = 0
        self._rounds = 0
        self._set_bounds(slice(None))

    @property
    def noise(self) -> float:
        """The measured deviation of the sensor's noise, in grey levels."""
        return self._noise

    def foreground(self, image: Image, region: Image) -> Image:
        """Return the pixels (255, else 0) of *region* that do not look like the empty road.

        The mask is valid until the next call.
        """
        between = cv2.inRange(image, self._lower, self._upper, dst=self._foreground)
        return np.asarray(cv2.subtract(region, between, dst=self._foreground), dtype=np.uint8)

    def learn(self, image: Image, learnable: Image) -> None:
        """Let the next strip of rows follow *image* where *learnable* is not zero."""
        height = image.shape[0]
        strips = self._settings.strips
        rows = slice(height * self._strip // strips, height * (self._strip + 1) // strips)
        self._measure_noise(image[rows], learnable[rows], rows)
        rate = max(self._settings.slowest_rate, 1.0 / (self._rounds + 2.0))
        cv2.accumulateWeighted(image[rows], self._mean[rows], rate, mask=learnable[rows])
        # What looks unlike the road but is no vehicle was learned wrongly: learn it faster.
        wrong = cv2.bitwise_and(self._foreground[rows], learnable[rows])
        cv2.accumulateWeighted(image[rows], self._mean[rows], _RATE_OF_CHANGE, mask=wrong)
        self._set_bounds(rows)
        self._strip += 1
        if self._strip == strips:
            self._strip = 0
            self._rounds += 1

    def adopt(self, image: Image, area: Image) -> None:
        """Take *image* for the empty road where *area* is not zero."""
        where = area != 0
        self._mean[where] = image[where]
        self._set_bounds(slice(None))

    def is_ghost(self, image: Image, blobs: Blobs) -> npt.NDArray[np.bool_]:
        """Return for which blobs the outline is an edge in the background, not in *image*."""
        if not len(blobs):
            return np.zeros(0, dtype=bool)
        seen = _edge_strength(image, blobs.points)
        learned = _edge_strength(self._mean, blobs.points)
        is_learned = (learned > 2.0 * seen) & (learned > 5.0 * self._noise)
        return np.asarray(per_blob_mean(is_learned, blobs) > _LEAST_GHOSTLY)

    def _set_bounds(self, rows: slice) -> None:
        mean = self._mean[rows]
        reach = self._settings.bound * self._noise
        dark = self._settings.darkest_shadow
        cv2.addWeighted(mean, 1.0, mean, 0.0, reach, dst=self._upper[rows], dtype=cv2.CV_8U)
        cv2.addWeighted(mean, dark, mean, 0.0, -reach, dst=self._lower[rows], dtype=cv2.CV_8U)

    def _measure_noise(self, image: Image, learnable: Image, rows: slice) -> None:
        """Follow the deviation of every eighth pixel of a strip from the mean."""
        here = learnable[::4, ::8] != 0
        if np.count_nonzero(here) < _FEWEST_FOR_NOISE:
            return
        off = np.abs(image[::4, ::8][here].astype(np.float32) - self._mean[rows][::4, ::8][here])
        deviation = _DEVIATION_PER_MEAN_ERROR * float(np.minimum(off, 40.0).mean())
        # The mean of n images is itself uncertain and makes the difference look noisier.
        deviation /= np.sqrt(1.0 + max(self._settings.slowest_rate, 1.0 / (self._rounds + 1.0)))
        weight = 0.05 if self._rounds else 0.3
        self._noise += weight * (max(deviation, _LEAST_NOISE) - self._noise)


def _noise_of(image: Image) -> float:
    """Guess the deviation of the noise from one image: from neighbours that are nearly equal."""
    off = np.abs(np.diff(image[::4].astype(np.int16), axis=1))
    return max(_LEAST_NOISE, float(off[off <= _MOST_NOISE].mean()) / _MEAN_DIFFERENCE)


_MOST_NOISE = 12
_MEAN_DIFFERENCE = 1.128
"""Mean distance of two draws from a normal distribution of deviation 1."""

_RATE_OF_CHANGE = 0.25
_LEAST_GHOSTLY = 0.6
"""Share of a ghost's outline that is an edge of the background only."""

_FEWEST_FOR_NOISE = 100
_DEVIATION_PER_MEAN_ERROR = 1.2533
_LEAST_NOISE = 0.6


def find_standing(
    first: Image, road: Image, settings: BackgroundSettings, metres_per_pixel: float
) -> Image:
    """Return where the first image shows what is as broad as a vehicle and not like the road.

    Args:
        first: The image.
        road: Not zero where the map has road, without any margin.
        settings: What shadows leave of the light, and how vehicles differ from the road.
        metres_per_pixel: Scale of the image; markings are told from vehicles by their breadth.
    """
    usual = _usual(first, road)
    brighter = first > usual + settings.contrast
    darker = first < settings.darkest_shadow * usual - 0.7 * settings.contrast
    differs = _any_channel(brighter | darker) & (road != 0)
    side = max(3, round(_BROADEST_MARKING / metres_per_pixel) | 1)
    return np.asarray(
        cv2.morphologyEx(differs.astype(np.uint8), cv2.MORPH_OPEN, _square(side)), dtype=np.uint8
    )


def guess_empty_road(
    first: Image,
    road: Image,
    standing: Image,
    settings: BackgroundSettings,
    metres_per_pixel: float,
) -> Image:
    """Return the first image with what stands on the road replaced by road from around it.

    The shadow of a vehicle goes with it; the markings beside it stay.

    Args:
        first: The image.
        road: Not zero where the map has road, without any margin.
        standing: Not zero where `find_standing` found something, in this or another camera.
        settings: What shadows leave of the light, and how vehicles differ from the road.
        metres_per_pixel: Scale of the image.
    """
    usual = _usual(first, road)
    is_marking = _any_channel(first > usual + settings.contrast)
    replaced = cv2.dilate(standing, _square(5)) != 0
    if settings.darkest_shadow < 1.0:
        reach = 2 * round(_SHADOW_REACH / metres_per_pixel) + 1
        replaced |= (cv2.dilate(standing, _square(reach)) != 0) & ~is_marking
    replaced &= road != 0
    plain = (road != 0) & ~replaced & ~is_marking
    around = _mean_around(first, plain, usual, metres_per_pixel)
    filled = first.copy()
    filled[replaced] = np.clip(np.rint(around[replaced]), 0, 255).astype(np.uint8)
    return filled


_BROADEST_MARKING = 0.75
_SHADOW_REACH = 0.9
_SURROUNDINGS = 8.0
_WEIGHT_OF_USUAL = 0.1
_GREY = 2
"""Axes of a grey image; the third axis of a colour image has the channels."""


def _square(side: int) -> Image:
    return np.ones((side, side), dtype=np.uint8)


def _usual(image: Image, road: Image) -> FloatImage:
    """Return the median of the road's pixels, for each channel."""
    pixels = image[road != 0]
    if not len(pixels):
        return np.zeros(image.shape[_GREY:], dtype=np.float32)
    return np.asarray(np.median(pixels, axis=0), dtype=np.float32)


def _any_channel(mask: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    return mask if mask.ndim == _GREY else np.asarray(mask.any(axis=_GREY))


def _mean_around(
    first: Image, empty: npt.NDArray[np.bool_], usual: FloatImage, metres_per_pixel: float
) -> FloatImage:
    """Return for each pixel the mean of the empty road around it, or the usual road."""
    side = round(_SURROUNDINGS / metres_per_pixel) | 1
    share = empty.astype(np.float32)
    shape = empty.shape + (1,) * (first.ndim - _GREY)
    weight = np.asarray(cv2.blur(share, (side, side)), dtype=np.float32).reshape(shape)
    total = np.asarray(cv2.blur(first * share.reshape(shape), (side, side)), dtype=np.float32)
    prior = np.float32(_WEIGHT_OF_USUAL)
    return np.asarray((total + prior * usual) / (weight + prior), dtype=np.float32)


def _edge_strength(image: Image | FloatImage, points: npt.NDArray[np.int32]) -> FloatImage:
    """Return how steeply the image changes across each point, in grey levels."""
    layer = image if image.ndim == _GREY else image[..., 1]  # green
    height, width = layer.shape
    u, v = points[:, 0], points[:, 1]
    left, right = layer[v, np.maximum(u - 2, 0)], layer[v, np.minimum(u + 2, width - 1)]
    above, below = layer[np.maximum(v - 2, 0), u], layer[np.minimum(v + 2, height - 1), u]
    across = np.abs(right.astype(np.float32) - left)
    return np.asarray(across + np.abs(below.astype(np.float32) - above), dtype=np.float32)

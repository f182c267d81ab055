"""The pinhole camera of a hovering aircraft: world to image and back.

Frames: the world has x east, y north, z up, in metres, and the ground is the plane z = 0. The
camera frame has x right, y down, z forward. The image has u right and v down, in pixels, and the
centre of the first pixel is (0, 0).

The flat ground is the assumption of Heintz (2009), section 8.7.1, too: the position of what lies
in a pixel is where the ray through the pixel meets the ground model.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from perception.errors import CalibrationError

__all__ = ["Calibration", "Camera", "Points"]

Points = npt.NDArray[np.float64]
"""Points as rows: shape (n, 2) or (n, 3)."""

_NEAR = 0.1
"""Metres; what is nearer to the camera plane than this is not seen."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """What a camera is, wherever it stands: image size and intrinsic parameters.

    Attributes:
        width: Columns of the image.
        height: Rows of the image.
        focal_length_px: Focal length in pixels, the same for both axes.
        centre_px: Where the optical axis meets the image, (u, v).
    """

    width: int
    height: int
    focal_length_px: float
    centre_px: tuple[float, float]

    def __post_init__(self) -> None:
        if self.width < 1 or self.height < 1:
            raise CalibrationError(
                "image size", "at least 1 x 1 pixels", f"{self.width} x {self.height}"
            )
        if not (math.isfinite(self.focal_length_px) and self.focal_length_px > 0):
            raise CalibrationError("focal length", "a positive number", self.focal_length_px)
        if not all(math.isfinite(c) for c in self.centre_px):
            raise CalibrationError("image centre", "finite", self.centre_px)

    @classmethod
    def from_field_of_view(
        cls, *, width: int = 1280, height: int = 720, horizontal: float = math.radians(84.0)
    ) -> "Calibration":
        """Return the calibration of a camera that sees *horizontal* radians across its width."""
        if not 0.0 < horizontal < math.pi:
            raise CalibrationError("horizontal field of view", "between 0 and π", horizontal)
        focal_length_px = 0.5 * width / math.tan(0.5 * horizontal)
        return cls(width, height, focal_length_px, ((width - 1) / 2, (height - 1) / 2))

    @property
    def image_from_camera(self) -> Points:
        """The matrix of intrinsic parameters, shape (3, 3)."""
        u, v = self.centre_px
        f = self.focal_length_px
        return np.array([[f, 0.0, u], [0.0, f, v], [0.0, 0.0, 1.0]])


@dataclass(frozen=True)
class Camera:
    """A camera at a pose above the ground; every pixel looks down at the ground.

    Attributes:
        position: (x, y, z) in the world.
        heading: Where the top of the image points on the ground, counter-clockwise from east.
        pitch: Angle of the optical axis below the horizon; π/2 looks straight down.
        roll: Rotation about the optical axis, clockwise in the world as the camera sees it.
        calibration: Intrinsic parameters and image size.
    """

    position: tuple[float, float, float]
    heading: float = math.pi / 2
    pitch: float = math.pi / 2
    roll: float = 0.0
    calibration: Calibration = field(default_factory=Calibration.from_field_of_view)

    def __post_init__(self) -> None:
        pose = (*self.position, self.heading, self.pitch, self.roll)
        if not all(math.isfinite(number) for number in pose):
            raise CalibrationError("camera pose", "finite", pose)
        if self.position[2] <= _NEAR:
            raise CalibrationError("camera altitude", f"above {_NEAR} m", self.position[2])
        if not (self._corner_rays[:, 2] < 0.0).all():
            raise CalibrationError(
                "camera view", "wholly below the horizon", f"a pitch of {self.pitch:.3f} rad"
            )

    @classmethod
    def looking_at(
        cls,
        x: float,
        y: float,
        altitude: float,
        *,
        heading: float = math.pi / 2,
        pitch: float = math.pi / 2,
        calibration: Calibration | None = None,
    ) -> "Camera":
        """Return a camera at *altitude* whose optical axis meets the ground at (x, y)."""
        if not 0.0 < pitch <= math.pi / 2:
            raise CalibrationError("camera pitch", "above 0 and at most π/2", pitch)
        away = altitude / math.tan(pitch)
        position = (x - away * math.cos(heading), y - away * math.sin(heading), altitude)
        return cls(position, heading, pitch, 0.0, calibration or Calibration.from_field_of_view())

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the image in pixels."""
        return self.calibration.width, self.calibration.height

    @cached_property
    def camera_from_world(self) -> Points:
        """The rotation, shape (3, 3): rows are right, down, and forward in the world."""
        sin_heading, cos_heading = math.sin(self.heading), math.cos(self.heading)
        sin_pitch, cos_pitch = math.sin(self.pitch), math.cos(self.pitch)
        forward = np.array([cos_heading * cos_pitch, sin_heading * cos_pitch, -sin_pitch])
        right = np.array([sin_heading, -cos_heading, 0.0])
        down = np.cross(forward, right)
        sin_roll, cos_roll = math.sin(self.roll), math.cos(self.roll)
        return np.stack(
            [cos_roll * right + sin_roll * down, cos_roll * down - sin_roll * right, forward]
        )

    @cached_property
    def image_from_ground_matrix(self) -> Points:
        """The homography from (x, y, 1) on the ground to homogeneous pixels, shape (3, 3)."""
        rotation = self.camera_from_world
        translation = -rotation @ np.array(self.position)
        columns = np.column_stack([rotation[:, 0], rotation[:, 1], translation])
        return np.asarray(self.calibration.image_from_camera @ columns)

    @cached_property
    def ground_from_image_matrix(self) -> Points:
        """The inverse homography, from homogeneous pixels to the ground, shape (3, 3)."""
        return np.asarray(np.linalg.inv(self.image_from_ground_matrix), dtype=np.float64)

    def depth(self, points: Points) -> Points:
        """Return how far in front of the camera each point (n, 3) of the world lies."""
        return np.asarray((points - np.array(self.position)) @ self.camera_from_world[2])

    def image_from_world(self, points: Points) -> Points:
        """Return the pixels (n, 2) of points (n, 3); NaN for points behind the camera."""
        rays = (np.asarray(points, dtype=np.float64) - self.position) @ self.camera_from_world.T
        depth = np.where(rays[:, 2:] > _NEAR, rays[:, 2:], np.nan)
        centre = np.array(self.calibration.centre_px)
        return np.asarray(self.calibration.focal_length_px * rays[:, :2] / depth + centre)

    def image_from_ground(self, points: Points) -> Points:
        """Return the pixels (n, 2) of points (n, 2) on the ground."""
        return self.image_from_world(np.column_stack([points, np.zeros(len(points))]))

    def ground_from_image(
        self, points: Points, height: float | npt.NDArray[np.float64] = 0.0
    ) -> Points:
        """Return what lies under the rays through pixels, where they are *height* metres up.

        Args:
            points: shape (n, 2), pixels.
            height: One number, or one for each point, above the ground.

        Returns:
            shape (n, 2), metres, in the world. Rays that do not go down give NaN.
        """
        matrix = self.ground_from_image_matrix
        rays = np.asarray(points, dtype=np.float64) @ matrix[:, :2].T + matrix[:, 2]
        # The third component is one over the depth at which the ray meets the ground.
        ground = rays[:, :2] / np.where(rays[:, 2:] > 0.0, rays[:, 2:], np.nan)
        return self.raise_from_ground(ground, height)

    def raise_from_ground(self, points: Points, height: float | npt.NDArray[np.float64]) -> Points:
        """Move points (n, 2) from the ground to *height* along the rays to the camera."""
        share = np.asarray(height, dtype=np.float64).reshape(-1, 1) / self.position[2]
        return np.asarray(points + (np.array(self.position[:2]) - points) * share)

    def ground_per_pixel(self, points: Points) -> Points:
        """Return how ground positions move with pixels: Jacobians (n, 2, 2) at pixels (n, 2)."""
        matrix = self.ground_from_image_matrix
        rays = points @ matrix[:, :2].T + matrix[:, 2]
        ground = rays[:, :2] / rays[:, 2:]
        slope = matrix[None, :2, :2] - ground[:, :, None] * matrix[None, 2:, :2]
        return np.asarray(slope / rays[:, 2, None, None])

    def metres_per_pixel(self) -> float:
        """Return the ground sample distance in the middle of the image, the mean of both axes."""
        middle = np.array([[(self.size[0] - 1) / 2, (self.size[1] - 1) / 2]])
        return math.sqrt(abs(float(np.linalg.det(self.ground_per_pixel(middle)[0]))))

    def footprint(self) -> Points:
        """Return the corners (4, 2) of the ground in view, beginning at the image's first."""
        return self.ground_from_image(self._corners)

    def sees(self, points: Points, margin_px: float = 0.0) -> npt.NDArray[np.bool_]:
        """Return which ground points (n, 2) lie in the image, *margin_px* inside its border."""
        pixels = self.image_from_ground(points)
        low, high = margin_px - 0.5, np.array(self.size) - 0.5 - margin_px
        return np.asarray(((pixels >= low) & (pixels <= high)).all(axis=1))

    @cached_property
    def _corners(self) -> Points:
        right, low = self.size[0] - 0.5, self.size[1] - 0.5
        return np.array([[-0.5, -0.5], [right, -0.5], [right, low], [-0.5, low]])

    @cached_property
    def _corner_rays(self) -> Points:
        offsets = self._corners - np.array(self.calibration.centre_px)
        rays = np.column_stack([offsets / self.calibration.focal_length_px, np.ones(4)])
        return np.asarray(rays @ self.camera_from_world)

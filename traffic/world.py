"""What surrounds the system: the map, the cameras, and chance."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from dyknow.streams.process import Source
from dyknow.streams.sample import Sample
from networks.reading import read_road_map
from networks.roads import RoadMap
from perception.camera import Calibration, Camera
from traffic.errors import ScenarioError
from traffic.scenarios import CameraSettings

__all__ = ["World", "camera_of", "generators_of", "road_map_at"]

_MOST_MAPS = 8


class _Silence:
    """A source that never says anything."""

    def samples(self) -> Iterator[Sample[Any]]:
        """Yield nothing."""
        return iter(())


@dataclass(frozen=True, slots=True)
class World:
    """What surrounds the system: the map, the eyes, and chance.

    Attributes:
        road_map: The map.
        vehicles: The source of true vehicles, which cameras film and noise is added to.
        camera: The pose of the cameras; None if there are none.
        generator: Source of all randomness in sensors.
        signals: The source of what all signals of the map show.
    """

    road_map: RoadMap
    vehicles: Source
    camera: Camera | None
    generator: np.random.Generator
    signals: Source = field(default_factory=_Silence)


def road_map_at(path: Path) -> RoadMap:
    """Return the map of the network at *path*; read once as long as the file stays as it is.

    Raises:
        NetworkError: The network cannot be read.
    """
    try:
        state = path.stat()
    except OSError:
        return read_road_map(path)
    return _road_map(path, state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=_MOST_MAPS)
def _road_map(path: Path, _modified: int, _size: int) -> RoadMap:
    return read_road_map(path)


def generators_of(seed: int) -> tuple[np.random.Generator, np.random.Generator]:
    """Return the sources of all randomness of a run: in traffic, and in sensors."""
    traffic, sensors = np.random.default_rng(seed).spawn(2)  # noqa: TID251, the run's
    return traffic, sensors


def camera_of(settings: CameraSettings | None, road_map: RoadMap) -> Camera:
    """Return the camera that hovers as *settings* say.

    Raises:
        ScenarioError: There are no settings.
        UnknownPlaceError: The camera is to look at a crossing that is not on the map.
    """
    if settings is None:
        raise ScenarioError("the scenario has no camera")
    if isinstance(settings.look_at, str):
        x, y = _centre(settings.look_at, road_map)
    else:
        x, y = settings.look_at
    calibration = Calibration.from_field_of_view(
        width=settings.width,
        height=settings.height,
        horizontal=math.radians(settings.field_of_view),
    )
    heading = math.radians(90.0 - settings.heading)
    return Camera.looking_at(x, y, settings.altitude, heading=heading, calibration=calibration)


def _centre(junction: str, road_map: RoadMap) -> tuple[float, float]:
    x, y = road_map.crossing_centre(road_map.crossing_index(junction))
    return float(x), float(y)

"""What all performances with a path driver do: come in, and drive on behind whoever is ahead."""

from collections.abc import Generator, Mapping, Sequence

import numpy as np

from traffic.sumo.acts.drawing import drawn_type_name
from traffic.sumo.acts.path_driver import PathDriver, towards
from traffic.sumo.acts.stage import Entrance, Stage

__all__ = ["come_in", "drive_on"]

_GENTLE = 2.0
_FIRM = 4.5
"""m/s²; speeding up, and braking."""

Coming = tuple[Mapping[str, float], Sequence[str], int]
"""The weights of vehicle types, the route, and the lane on every road."""


def come_in(
    who: Coming, speed: float, stage: Stage, generator: np.random.Generator
) -> Generator[None, None, PathDriver]:
    """Let a vehicle come in, and return its driver when it is there.

    Args:
        who: Vehicle types, route and lane.
        speed: With which it comes in, m/s.
        stage: Where.
        generator: For what is random in the vehicle.
    """
    types, route, lane = who
    kind = drawn_type_name(types, generator)
    roads = tuple(stage.ways(route))
    vehicle = stage.enter(Entrance(kind, roads, lane, speed=speed), generator)
    path = stage.lane_path(roads, lane)
    while not stage.is_here(vehicle):
        yield
    return PathDriver(stage, vehicle, path)


def drive_on(driver: PathDriver, stage: Stage, wanted: float, aside: float | None = None) -> None:
    """Move the vehicle at the speed wanted, or as fast as whoever is ahead allows.

    Args:
        driver: Of the vehicle.
        stage: Where.
        wanted: m/s.
        aside: Where it is to the left of its path then, metres; where it is now by default.
    """
    safe = min(wanted, driver.safe_speed(_FIRM))
    limit = _GENTLE if safe > driver.speed else 2 * _FIRM
    speed = towards(driver.speed, safe, limit * stage.step_length)
    driver.move(speed, driver.aside if aside is None else aside)

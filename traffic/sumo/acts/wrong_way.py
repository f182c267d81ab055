"""Performances of `drive_opposite`."""

from collections.abc import Iterator

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts.wrong_way import DriveOpposite
from traffic.sumo.acts.path_driver import PathDriver
from traffic.sumo.acts.stage import Stage
from traffic.sumo.acts.steering import come_in, drive_on

__all__ = ["drive_opposite"]

_FASTEST = 20.0
"""m/s at which others may come towards the driver."""

_ROOM = 25.0
"""Metres that are left between the two then."""

_FOLLOWING = 50.0
_BEHIND = 15.0
"""Metres ahead and behind in which nobody may be on the own side, who would be overtaken."""

_WIDE = 1.7
"""Metres from the middle of a lane within which somebody is on it."""


def drive_opposite(
    act: DriveOpposite, stage: Stage, generator: np.random.Generator
) -> Iterator[None]:
    """Come in, go over to the other side when there is room, drive there, and come back."""
    speed = generator.uniform(*act.speed)
    place = generator.uniform(*act.place)
    target = generator.uniform(*act.aside)
    going, duration = (generator.uniform(*span) / SECOND for span in (act.going, act.duration))
    driver = yield from come_in((act.types, act.route, act.lane), speed, stage, generator)
    needed = (speed + _FASTEST) * (duration + 2 * going) + _ROOM
    while driver.s < place or not _has_room(driver, stage, needed):
        if driver.is_at_end:
            return
        drive_on(driver, stage, speed, 0.0)
        yield
    yield from _go_over(driver, stage, speed, (target, going))
    until = stage.now + duration
    while stage.now < until and not driver.is_at_end:
        driver.move(speed, target)
        yield
    yield from _go_over(driver, stage, speed, (0.0, going))


def _go_over(
    driver: PathDriver, stage: Stage, speed: float, to: tuple[float, float]
) -> Iterator[None]:
    """Drive on while the place beside the path changes to a target in some seconds, smoothly."""
    target, duration = to
    begun, was = stage.now, driver.aside
    while not driver.is_at_end and (elapsed := stage.now - begun) < duration:
        share = (1 - np.cos(np.pi * min(1.0, (elapsed + stage.step_length) / duration))) / 2
        driver.move(speed, was + (target - was) * float(share))
        yield


def _has_room(driver: PathDriver, stage: Stage, needed: float) -> bool:
    """Whether nobody comes within *needed* metres, and nobody is near on the own side."""
    vehicles = stage.api.vehicle
    for other in stage.vehicles:
        if other == driver.vehicle:
            continue
        s, aside = driver.path.place_of(*vehicles.getPosition(other))
        ahead = s - driver.s
        if abs(aside) < _WIDE and -_BEHIND < ahead < _FOLLOWING:
            return False
        if _WIDE < abs(aside) < 4 * _WIDE and -_BEHIND < ahead < needed:
            return False
    return True

"""Performances of `park`."""

from collections.abc import Iterator

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts.parking import Park
from traffic.sumo.acts.path_driver import PathDriver
from traffic.sumo.acts.stage import Stage
from traffic.sumo.acts.steering import come_in, drive_on

__all__ = ["park"]

_BRAKING = 1.8
"""m/s²; on the way into the place."""

_LEAVING = 1.2
"""m/s²; on the way out of it."""

_TURNING = 13.0
"""Metres along the lane in which a vehicle gets from the lane into the place, or out of it."""

_CREEPING = 0.6
"""m/s; the last half metre."""

_ROOM = 7.0
"""Metres between the fronts of two vehicles that park one behind the other, at least."""

_LOOK_BACK = 45.0
_LOOK_AHEAD = 12.0
"""Metres of the lane that must be free when a vehicle joins the traffic."""

_BESIDE = 1.7
"""Metres from the middle of the lane within which somebody is on it."""


def park(act: Park, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Come in, get into a place, stand, get out when there is room, and drive on."""
    speed = generator.uniform(*act.speed)
    duration = generator.uniform(*act.duration) / SECOND
    aside = generator.uniform(*act.aside) * (1.0 if act.leftwards else -1.0)
    wanted = generator.permutation(act.places)
    driver = yield from come_in((act.types, act.route, act.lane), speed, stage, generator)
    place = next((each for each in wanted if _is_free(driver, stage, each, aside)), None)
    if place is None:
        return
    at = driver.path.point(place, aside)
    stage.reserved.append(at)
    try:
        yield from _get_in(driver, stage, (speed, place, aside))
        until = stage.now + duration
        while stage.now < until or not _may_join(driver, stage):
            driver.move(0.0, aside)
            yield
    finally:
        stage.reserved.remove(at)
    begun = driver.s
    while not driver.is_at_end and driver.s < begun + 3 * _TURNING:
        share = _share((driver.s - begun) / _TURNING)
        faster = driver.speed + _LEAVING * stage.step_length
        drive_on(driver, stage, min(speed, faster), aside * (1 - share))
        yield


def _get_in(driver: PathDriver, stage: Stage, to: tuple[float, float, float]) -> Iterator[None]:
    """Drive until the vehicle stands in its place."""
    speed, place, aside = to
    while driver.s < place - 0.02:
        left = place - driver.s
        share = _share(1 - (left - 0.5) / _TURNING)
        allowed = max(float(np.sqrt(2 * _BRAKING * left)), _CREEPING)
        drive_on(driver, stage, min(speed, allowed, left / stage.step_length), aside * share)
        yield


def _share(way: float) -> float:
    """Return how far aside one is after a share of the way, smoothly from 0 to 1."""
    return float((1 - np.cos(np.pi * np.clip(way, 0.0, 1.0))) / 2)


def _is_free(driver: PathDriver, stage: Stage, place: float, aside: float) -> bool:
    """Whether nobody stands in a place, or is on the way there, and it can still be reached."""
    x, y = driver.path.point(place, aside)
    apart = [np.hypot(x - other[0], y - other[1]) for other in stage.reserved]
    needed = driver.speed**2 / (2 * _BRAKING) + _TURNING
    return bool(min(apart, default=np.inf) > _ROOM and place - driver.s > needed)


def _may_join(driver: PathDriver, stage: Stage) -> bool:
    """Whether the lane beside the vehicle is free of others who move."""
    vehicles = stage.api.vehicle
    for other in stage.vehicles:
        s, aside = driver.path.place_of(*vehicles.getPosition(other))
        ahead = s - driver.s
        if other != driver.vehicle and -_LOOK_BACK < ahead < _LOOK_AHEAD and abs(aside) < _BESIDE:
            return False
    return True

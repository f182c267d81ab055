"""Performances of `weave` and `swerve`."""

from collections.abc import Iterator

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts.weaving import Swerve, Weave
from traffic.scenarios.fields import DurationRange
from traffic.sumo.acts.path_driver import PathDriver
from traffic.sumo.acts.stage import Stage
from traffic.sumo.acts.steering import come_in, drive_on

__all__ = ["swerve", "weave"]


def weave(act: Weave, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Come in, drive to the place, and sway until the time is over."""
    speed = generator.uniform(*act.speed)
    place = generator.uniform(*act.place)
    duration = _seconds(act.duration, generator)
    driver = yield from come_in((act.types, act.route, act.lane), speed, stage, generator)
    while driver.s < place and not driver.is_at_end:
        drive_on(driver, stage, speed)
        yield
    side = float(generator.choice([-1.0, 1.0]))
    begun = stage.now
    while stage.now - begun < duration:
        target = side * generator.uniform(*act.width) / 2
        yield from _shift(driver, stage, speed, (target, _seconds(act.period, generator) / 2))
        side = -side
    yield from _shift(driver, stage, speed, (0.0, _seconds(act.period, generator) / 2))


def swerve(act: Swerve, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Come in, drive to the place, go aside, come back, and leave the driver alone after that."""
    speed = generator.uniform(*act.speed)
    place = generator.uniform(*act.place)
    target = generator.uniform(*act.width) * (-1.0 if act.rightwards else 1.0)
    driver = yield from come_in((act.types, act.route, act.lane), speed, stage, generator)
    while driver.s < place and not driver.is_at_end:
        drive_on(driver, stage, speed)
        yield
    yield from _shift(driver, stage, speed, (target, _seconds(act.going, generator)))
    yield from _shift(driver, stage, speed, (target, _seconds(act.staying, generator)))
    yield from _shift(driver, stage, speed, (0.0, _seconds(act.going, generator)))


def _shift(
    driver: PathDriver, stage: Stage, speed: float, to: tuple[float, float]
) -> Iterator[None]:
    """Drive on while the place beside the path changes to a target in some seconds, smoothly."""
    target, duration = to
    begun, was = stage.now, driver.aside
    while not driver.is_at_end and (elapsed := stage.now - begun) < duration:
        share = (1 - np.cos(np.pi * (elapsed + stage.step_length) / duration)) / 2
        drive_on(driver, stage, speed, was + (target - was) * min(1.0, float(share)))
        yield


def _seconds(span: DurationRange, generator: np.random.Generator) -> float:
    return float(generator.uniform(*span)) / SECOND

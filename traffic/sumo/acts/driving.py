"""Performances of `drive` and `halt`."""

from collections.abc import Iterator

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts.driving import Drive, Halt
from traffic.sumo.acts.drawing import drawn_type_name
from traffic.sumo.acts.native_driver import NativeDriver
from traffic.sumo.acts.stage import Entrance, Stage

__all__ = ["drive", "halt"]

_REACHED = 0.05
"""m/s by which a speed may be missed."""


def drive(act: Drive, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Come in and hold the speed until the vehicle leaves."""
    speed = generator.uniform(*act.speed)
    kind = drawn_type_name(act.types, generator)
    vehicle = stage.enter(Entrance(kind, act.route, act.lane), generator)
    with NativeDriver(stage, vehicle) as driver:
        while not driver.is_here:
            yield
        driver.keep_lane()
        driver.drive_at(speed, careful=True)
        while driver.is_here:
            yield


def halt(act: Halt, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Come in, stop on the last road, and leave the driver alone after that."""
    place = generator.uniform(*act.place)
    duration = generator.uniform(*act.duration) / SECOND
    kind = drawn_type_name(act.types, generator)
    vehicle = stage.enter(Entrance(kind, act.route), generator)
    while not stage.is_here(vehicle):
        yield
    stage.api.vehicle.setStop(vehicle, act.route[-1], place, act.lane, duration)

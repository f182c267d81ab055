"""Performances of `cut_off`, `cross_with_room` and `brake_late`."""

from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np
import shapely

from dyknow.time import SECOND
from traffic.errors import SimulatorError
from traffic.scenarios.acts.danger import BrakeLate, CrossWithRoom, CutOff
from traffic.scenarios.fields import Distances, TypeWeights
from traffic.sumo.acts.drawing import drawn_type_name
from traffic.sumo.acts.path_driver import PathDriver, towards
from traffic.sumo.acts.paths import Path
from traffic.sumo.acts.stage import Entrance, Stage
from traffic.sumo.acts.steering import drive_on

__all__ = ["brake_late", "cross_with_room", "cut_off"]

_SPEEDS = (3.0, 13.0)
"""m/s; of a driver who wants to be somewhere in time."""

_DECIDED = 2.0
"""Seconds before the meeting from which a driver keeps the speed."""

_HARDEST = 9.5
"""m/s²; how hard one brakes who is cut off."""

_HALF_WIDTH = 1.0
"""Metres; of what crosses."""

_BEYOND = 12.0
"""Metres behind the place where the ways cross at which all is over."""

_STANDING = 0.1
"""m/s."""


@dataclass(slots=True)
class _Meeting:
    """Two drivers whose ways cross.

    Attributes:
        first: The driver who goes first.
        second: The other one.
        first_at: Where the ways cross, along the way of the first, metres.
        second_at: The same along the way of the second.
        length: Of the first one's vehicle, metres.
        speed: That the second one wants, m/s.
    """

    first: PathDriver
    second: PathDriver
    first_at: float
    second_at: float
    length: float
    speed: float

    @property
    def seconds_left(self) -> float:
        """How long the second one needs to the place where the ways cross."""
        return (self.second_at - self.second.s) / max(self.second.speed, 1.0)

    @property
    def is_over(self) -> bool:
        """Whether the first one is well beyond that place."""
        return self.first.s > self.first_at + self.length + _BEYOND or self.first.is_at_end


def cut_off(act: CutOff, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Let the first one cross when the second one is there, and the second one brake for it."""
    brakes_at = generator.uniform(*act.brakes_at) / SECOND
    meeting = yield from _come_together(act, stage, generator)
    # The middle of the first one is to be where the second one's front gets to.
    yield from _approach(meeting, stage, meeting.length / 2, 0.0)
    first, second = meeting.first, meeting.second
    is_braking = False
    while not meeting.is_over:
        drive_on(first, stage, max(first.speed, _SPEEDS[0]))
        room = meeting.second_at - _HALF_WIDTH - second.s
        has_gone = first.s > meeting.first_at + meeting.length + _HALF_WIDTH
        is_braking = not has_gone and (is_braking or 0 <= room <= brakes_at * second.speed)
        if is_braking:
            second.move(max(0.0, second.speed - _HARDEST * stage.step_length), second.aside)
        else:
            drive_on(second, stage, meeting.speed)
        yield


def cross_with_room(
    act: CrossWithRoom, stage: Stage, generator: np.random.Generator
) -> Iterator[None]:
    """Let the first one cross so early that the second one need not mind."""
    gap = generator.uniform(*act.gap) / SECOND
    meeting = yield from _come_together(act, stage, generator)
    yield from _approach(meeting, stage, meeting.length + _HALF_WIDTH, gap)
    while not meeting.is_over:
        drive_on(meeting.first, stage, max(meeting.first.speed, _SPEEDS[0]))
        drive_on(meeting.second, stage, meeting.speed)
        yield


def brake_late(act: BrakeLate, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Let one stop on the lane, and another one come and brake behind it at the last moment."""
    speed, braking, left = (
        generator.uniform(*each) for each in (act.speed, act.braking, act.left)
    )
    place, duration = generator.uniform(*act.place), generator.uniform(*act.duration) / SECOND
    vehicles = stage.api.vehicle
    ahead = stage.enter(Entrance(drawn_type_name(act.types, generator), act.route), generator)
    while not stage.is_here(ahead):
        yield
    vehicles.setStop(ahead, act.route[-1], place, 0, duration)
    while not stage.is_here(ahead) or vehicles.getSpeed(ahead) > _STANDING:
        yield
    driver = yield from _come_in(stage, generator, (act.types, act.route, None, speed))
    while not driver.is_at_end:
        gap = _gap(driver, stage)
        if driver.speed < _STANDING and gap > left + 1.0:
            return
        allowed = float(np.sqrt(2 * braking * max(gap - left, 0.0)))
        quicker = towards(driver.speed, speed, 2.0 * stage.step_length)
        driver.move(min(quicker, allowed))
        yield


def _gap(driver: PathDriver, stage: Stage) -> float:
    """Return the metres to the rear of whoever is ahead on the lane."""
    vehicles = stage.api.vehicle
    found = vehicles.getLeader(driver.vehicle, 100.0)
    if found is None or not found[0]:
        return np.inf
    s, _ = driver.path.place_of(*vehicles.getPosition(found[0]))
    return float(s - vehicles.getLength(found[0]) - driver.s)


def _come_together(
    act: CutOff | CrossWithRoom, stage: Stage, generator: np.random.Generator
) -> Generator[None, None, _Meeting]:
    """Let both come in, and return their meeting when they are there."""
    speed = generator.uniform(*act.other_speed)
    others = (act.other_types, act.other_route, act.other_place, speed)
    second = yield from _come_in(stage, generator, others)
    first = yield from _come_in(stage, generator, (act.types, act.route, act.place, speed), second)
    first_at, second_at = _crossing_of(first.path, second.path)
    length = float(stage.api.vehicle.getLength(first.vehicle))
    return _Meeting(first, second, first_at, second_at, length, speed)


def _come_in(
    stage: Stage,
    generator: np.random.Generator,
    who: tuple[TypeWeights, tuple[str, ...], Distances | None, float],
    beside: PathDriver | None = None,
) -> Generator[None, None, PathDriver]:
    """Let a vehicle come in somewhere on its first road, while another one drives on."""
    types, route, span, speed = who
    place = None if span is None else float(generator.uniform(*span))
    roads = tuple(stage.ways(route))
    kind = drawn_type_name(types, generator)
    vehicle = stage.enter(Entrance(kind, roads, 0, place, speed), generator)
    while not stage.is_here(vehicle):
        if beside is not None:
            drive_on(beside, stage, speed)
        yield
    return PathDriver(stage, vehicle, stage.lane_path(roads))


def _approach(meeting: _Meeting, stage: Stage, further: float, earlier: float) -> Iterator[None]:
    """Drive on until the meeting is near.

    The first one drives so that it is *further* metres beyond the place where the ways cross
    *earlier* seconds before the second one gets there.
    """
    first, second = meeting.first, meeting.second
    while meeting.seconds_left > _DECIDED + earlier:
        left = meeting.first_at + further - first.s
        wanted = float(np.clip(left / (meeting.seconds_left - earlier), *_SPEEDS))
        drive_on(first, stage, wanted)
        drive_on(second, stage, meeting.speed)
        yield


def _crossing_of(first: Path, second: Path) -> tuple[float, float]:
    """Return where two paths cross, along each of them."""
    lines = [
        shapely.LineString([path.point(s) for s in np.arange(0.0, path.length, 0.5)])
        for path in (first, second)
    ]
    meeting = lines[0].intersection(lines[1])
    if meeting.is_empty:
        raise SimulatorError("the ways of an act do not cross")
    point = meeting.centroid
    return first.place_of(point.x, point.y)[0], second.place_of(point.x, point.y)[0]

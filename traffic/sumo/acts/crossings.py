"""Performances of `run_red_light`, `creep_over_line` and `halt_in_crossing`."""

from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from dyknow.time import SECOND
from networks.signals import SignalState
from traffic.scenarios.acts.base import Act
from traffic.scenarios.acts.crossings import CreepOverLine, HaltInCrossing, RunRedLight
from traffic.sumo.acts.path_driver import PathDriver
from traffic.sumo.acts.signals import LaneSignal, signal_of
from traffic.sumo.acts.stage import Stage
from traffic.sumo.acts.steering import come_in, drive_on

__all__ = ["creep_over_line", "halt_in_crossing", "run_red_light"]

_BRAKING = 2.5
"""m/s²; before a line."""

_BEFORE_LINE = 1.0
"""Metres from the line to the front of one who waits."""

_CROSSING = 24.0
"""Metres; others who move so near to the middle of the crossing are in the way."""

_NEAR = 30.0
"""Metres before the line; from there on a driver decides to run a red light."""

_INSIDE = 15.0
"""Metres from the line to the middle of the crossing."""

_SLOW = 2.0
_LEAVING = 45.0
"""Metres behind the line after which the driver is like any other."""


def run_red_light(
    act: RunRedLight, stage: Stage, generator: np.random.Generator
) -> Iterator[None]:
    """Come in when it will be red, and pass the line as soon as the crossing is free."""
    speed = generator.uniform(*act.speed)
    after = generator.uniform(*act.after) / SECOND
    signal = signal_of(f"{act.route[0]}_{act.lane}", stage)
    yield from _wait_to_arrive(act.route[0], signal, stage, (speed, after))
    approach = yield from _approach(act, act.lane, speed, (stage, generator))
    has_decided = False
    while not approach.is_over:
        has_decided |= approach.is_alone and (
            signal.state is SignalState.RED and approach.is_crossing_free()
        )
        may_go = has_decided or signal.is_free or approach.has_passed
        approach.go_on(speed, None if may_go else -_BEFORE_LINE)
        yield


def creep_over_line(
    act: CreepOverLine, stage: Stage, generator: np.random.Generator
) -> Iterator[None]:
    """Come in, stop past the line unless it is green, and wait for green there."""
    speed = generator.uniform(*act.speed)
    over = generator.uniform(*act.over)
    signal = signal_of(f"{act.route[0]}_{act.lane}", stage)
    approach = yield from _approach(act, act.lane, speed, (stage, generator))
    while not approach.is_over:
        may_go = signal.is_free or approach.past > over + 1.0
        approach.go_on(speed, None if may_go else over)
        yield


def halt_in_crossing(
    act: HaltInCrossing, stage: Stage, generator: np.random.Generator
) -> Iterator[None]:
    """Come in, wait for green, stop inside the crossing, and drive on when the time is over."""
    speed = generator.uniform(*act.speed)
    into = generator.uniform(*act.into)
    duration = generator.uniform(*act.duration) / SECOND
    signal = signal_of(f"{act.route[0]}_{act.lane}", stage)
    approach = yield from _approach(act, act.lane, speed, (stage, generator))
    while approach.past < into - 0.1 and not approach.is_over:
        may_go = signal.is_free or approach.has_passed
        approach.go_on(speed, into if may_go else -_BEFORE_LINE)
        yield
    until = stage.now + duration
    while stage.now < until:
        approach.driver.move(0.0, 0.0)
        yield
    while not approach.is_over:
        approach.go_on(speed, None)
        yield


@dataclass(frozen=True, slots=True)
class _Approach:
    """A driver who comes to the stop line of a crossing.

    Attributes:
        driver: On a path through the crossing.
        stage: Where.
        line: Where the line is along the path, metres.
    """

    driver: PathDriver
    stage: Stage
    line: float

    @property
    def past(self) -> float:
        """How far past the line the front is, metres."""
        return self.driver.s - self.line

    @property
    def has_passed(self) -> bool:
        """Whether the front is past the line."""
        return self.past > 0.0

    @property
    def is_over(self) -> bool:
        """Whether the crossing is behind the driver."""
        return self.driver.is_at_end or self.past > _LEAVING

    @property
    def is_alone(self) -> bool:
        """Whether the driver is near the line and nobody is ahead before it."""
        left = -self.past
        if not 0.0 < left < _NEAR:
            return False
        ahead = self.stage.api.vehicle.getLeader(self.driver.vehicle, left)
        return ahead is None or not ahead[0] or ahead[1] > left

    def is_crossing_free(self) -> bool:
        """Whether nobody else moves in the crossing, or close to it."""
        middle = np.array(self.driver.path.point(self.line + _INSIDE))
        vehicles = self.stage.api.vehicle
        return not any(
            np.hypot(*(np.array(vehicles.getPosition(other)) - middle)) < _CROSSING
            and vehicles.getSpeed(other) > _SLOW
            for other in self.stage.vehicles
            if other != self.driver.vehicle
        )

    def go_on(self, speed: float, stop: float | None) -> None:
        """Drive on at *speed*, so that the front comes to rest *stop* metres past the line."""
        if stop is not None:
            left = max(0.0, self.line + stop - self.driver.s)
            speed = min(speed, float(np.sqrt(2 * _BRAKING * left)), left / self.stage.step_length)
        drive_on(self.driver, self.stage, speed, 0.0)


def _approach(
    act: Act, lane: int, speed: float, where: tuple[Stage, np.random.Generator]
) -> Generator[None, None, _Approach]:
    """Let the driver of an act come in."""
    stage, generator = where
    driver = yield from come_in((act.types, act.route, lane), speed, stage, generator)
    end = stage.api.lane.getShape(f"{act.route[0]}_{lane}")[-1]
    line, _ = driver.path.place_of(*end)
    return _Approach(driver, stage, line)


def _wait_to_arrive(
    road: str, signal: LaneSignal, stage: Stage, wanted: tuple[float, float]
) -> Iterator[None]:
    """Wait until one who comes in now gets to the line so many seconds after it turns red."""
    speed, after = wanted
    travel = float(stage.api.lane.getLength(f"{road}_0")) / speed
    if not signal.light:
        return
    while signal.seconds_until_red() + after > travel:
        yield

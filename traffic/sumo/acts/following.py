"""Performances of `column`, `tailgate`, `close_up` and `tail`."""

from collections.abc import Generator, Iterator, Sequence
from contextlib import ExitStack

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts.following import CloseUp, Column, Tail, Tailgate
from traffic.scenarios.fields import DurationRange
from traffic.sumo.acts.drawing import drawn_type_name
from traffic.sumo.acts.native_driver import NativeDriver
from traffic.sumo.acts.path_driver import towards
from traffic.sumo.acts.stage import Entrance, Stage

__all__ = ["close_up", "column", "tail", "tailgate"]

_ROOM = 14.0
"""Metres for the longest vehicle, and the gap that SUMO wants ahead of a new one."""

_SAFE = 1.2
"""Time gap, seconds, that SUMO wants ahead of a new vehicle."""

_IN_A_HURRY = 1.3
"""Speed of the others, in shares of what is allowed."""

_CATCHING_UP = 2.5
"""How much faster than the first one the others drive until they have come close, m/s."""

_STANDING_GAP = 2.0
"""Metres that are kept however slow both drive, if that is less than half of the gap at speed."""

_HASTE = 0.6
"""Who comes close drives as if to come closer still, by this share of the time gap."""

_PATIENCE = 12.0
"""How long a driver tries to reach a time gap, seconds."""

_CHANGE = 0.6
"""How fast a time gap changes, seconds per second."""


def tailgate(act: Tailgate, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Let two come in, of which the second stays close behind the first until that leaves."""
    with ExitStack() as stack:
        row = _Row(act, stage, generator, stack)
        yield from row.come_in([_seconds(act.time_gap, generator)])
        yield from row.stay()


def column(act: Column, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Let several come in, of which each stays behind the one ahead until the first leaves."""
    n = int(generator.integers(*act.number, endpoint=True))
    place = None if act.place is None else float(generator.uniform(*act.place))
    with ExitStack() as stack:
        row = _Row(act, stage, generator, stack, place)
        yield from row.come_in([_seconds(act.time_gap, generator) for _ in range(n - 1)])
        yield from row.stay()


def close_up(act: CloseUp, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Let two come in, of which the second comes close now and then until the first leaves."""
    distance = _seconds(act.distance, generator)
    with ExitStack() as stack:
        row = _Row(act, stage, generator, stack)
        yield from row.come_in([distance])
        while True:
            yield from row.stay(_seconds(act.pause, generator))
            yield from row.close_in(_seconds(act.time_gap, generator))
            yield from row.stay(_seconds(act.moment, generator))
            yield from row.fall_back(distance)


def tail(act: Tail, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Let two come in, one some time behind the other, and leave both alone."""
    lag = _seconds(act.lag, generator)
    kinds = [drawn_type_name(act.types, generator) for _ in range(2)]
    ahead = stage.enter(Entrance(kinds[0], act.route), generator)
    while not stage.is_here(ahead):
        yield
    until = stage.now + lag
    while stage.now < until:
        yield
    stage.enter(Entrance(kinds[1], act.tail_route or act.route), generator)


class _Row:
    """Vehicles that drive one behind the other on one lane, each at its time gap.

    The first one drives at its speed, if lights and others let it; the others would be a little
    faster, and are as close as SUMO's drivers are whose reaction time is their time gap.

    Args:
        act: Says who comes in, where, and how fast.
        stage: Where.
        generator: Draws vehicles and speed.
        stack: Gives the vehicles back at the end.
        place: Where on the first road they come in, metres; None for its begin.
    """

    def __init__(
        self,
        act: Column | Tailgate | CloseUp,
        stage: Stage,
        generator: np.random.Generator,
        stack: ExitStack,
        place: float | None = None,
    ) -> None:
        self._act = act
        self._stage = stage
        self._generator = generator
        self._stack = stack
        self._place = place
        self._speed = float(generator.uniform(*act.speed))
        self._drivers: list[NativeDriver] = []
        self._time_gap = 0.0

    def come_in(self, time_gaps: Sequence[float]) -> Iterator[None]:
        """Let the first come in, and behind it one with each of the time gaps."""
        driver = yield from self._enter()
        driver.drive_at(self._speed, careful=True)
        for time_gap in time_gaps:
            room = _ROOM + max(time_gap, _SAFE) * self._speed
            while self._stage.api.vehicle.getDistance(driver.vehicle) < room:
                self._require_all()
                yield
            driver = yield from self._enter()
            self._stage.api.vehicle.setImperfection(driver.vehicle, 0.0)
            self._stage.api.vehicle.setSpeedFactor(driver.vehicle, _IN_A_HURRY)
            self._stage.api.vehicle.setMaxSpeed(driver.vehicle, self._speed + _CATCHING_UP)
            self._keep(driver, time_gap)

    def stay(self, seconds: float = np.inf) -> Iterator[None]:
        """Let some time pass, or all of it until one of them leaves."""
        until = self._stage.now + seconds
        while self._stage.now < until:
            self._require_all()
            yield

    def close_in(self, wanted: float) -> Iterator[None]:
        """Let the last one come close quickly, until it has or gives up."""
        until = self._stage.now + _PATIENCE
        while self._stage.now < until and self._actual_gap() > wanted:
            self._change(_HASTE * wanted)
            yield
        self._keep(self._drivers[-1], wanted)

    def fall_back(self, wanted: float) -> Iterator[None]:
        """Let the last one fall back by and by, until it has or gives up."""
        until = self._stage.now + _PATIENCE
        while self._stage.now < until and self._actual_gap() < wanted:
            self._change(wanted)
            yield
        self._keep(self._drivers[-1], wanted)

    def _change(self, wanted: float) -> None:
        """Bring the time gap that the last one keeps a step nearer to what is wanted."""
        self._require_all()
        step = _CHANGE * self._stage.step_length
        self._keep(self._drivers[-1], towards(self._time_gap, wanted, step))

    def _actual_gap(self) -> float:
        """Return the time gap of the last one at the speed of the row, seconds."""
        self._require_all()
        ahead, behind = self._drivers[-2:]
        api = self._stage.api.vehicle
        (x, y), (a, b) = behind.position, ahead.position
        gap = float(np.hypot(a - x, b - y)) - float(api.getLength(ahead.vehicle))
        return gap / self._speed

    def _enter(self) -> Generator[None, None, NativeDriver]:
        kind = drawn_type_name(self._act.types, self._generator)
        entrance = Entrance(kind, self._act.route, self._act.lane, self._place, self._speed)
        vehicle = self._stage.enter(entrance, self._generator)
        driver = self._stack.enter_context(NativeDriver(self._stage, vehicle))
        while not driver.is_here:
            yield
        driver.keep_lane()
        self._drivers.append(driver)
        return driver

    def _keep(self, driver: NativeDriver, time_gap: float) -> None:
        """Let SUMO's driver keep a time gap at the speed of the row."""
        standing = min(_STANDING_GAP, time_gap * self._speed / 2)
        self._stage.api.vehicle.setMinGap(driver.vehicle, standing)
        self._stage.api.vehicle.setTau(driver.vehicle, time_gap - standing / self._speed)
        self._time_gap = time_gap

    def _require_all(self) -> None:
        """End the performance if one of them is gone."""
        for driver in self._drivers:
            driver.require_here()


def _seconds(span: DurationRange, generator: np.random.Generator) -> float:
    return float(generator.uniform(*span)) / SECOND

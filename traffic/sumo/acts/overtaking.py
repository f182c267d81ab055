"""Performances of `overtake`, `abort_overtake` and `drive_beside`."""

from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts.overtaking import (
    AbortOvertake,
    DriveBeside,
    Oncoming,
    Overtake,
    Pair,
)
from traffic.scenarios.fields import DurationRange
from traffic.sumo.acts.drawing import drawn_type_name
from traffic.sumo.acts.path_driver import PathDriver, towards
from traffic.sumo.acts.stage import Entrance, Stage
from traffic.sumo.acts.steering import come_in, drive_on

__all__ = ["abort_overtake", "drive_beside", "overtake"]

_ACCELERATION = 2.5
_BRAKING = 3.5
"""m/s², of the driver who comes from behind."""

_APPROACH = 0.7
"""1/s, how fast a driver corrects where it is beside another."""

_NEAR = 0.8
"""Metres at which it has got where it wants to be."""

_EAGER = 3.0
"""m/s by which it is faster until it has closed up."""

_ROOM_AHEAD = 60.0
_ROOM_BEHIND = 25.0
"""Metres in which nobody may be on the side to which a driver goes."""

_WIDE = 1.9
"""Metres to the side within which somebody is in the way."""

_ROOM_TO_RETURN = 10.0
"""Metres that are left to whoever is ahead on the own lane when the driver has come back."""

_MINDS = 3.0
_BRAKES = 1.5
"""Seconds before two meet on one side: when who comes makes room, and when it brakes."""

_CLEAR = 2.9
"""Metres between the middles of two that meet, from which they pass each other."""

_SHOULDER = 2.8
_SIDEWAYS = 1.5
"""Metres by which who comes makes room at most, and m/s at which it does."""

_CREEPING = 4.0
"""m/s to which it brakes."""


@dataclass(slots=True)
class _Duo:
    """Two drivers, of whom one came behind the other.

    Attributes:
        driver: Who came behind.
        other: Who came first.
        speed: At which the other one drives if it can, m/s.
        aside: Where the driver drives beside the other, metres to the left.
        going: How long it takes to go there, seconds.
        lengths: Of both vehicles, metres.
        stage: Where.
    """

    driver: PathDriver
    other: PathDriver
    speed: float
    aside: float
    going: float
    lengths: tuple[float, float]
    stage: Stage

    @property
    def lead(self) -> float:
        """How far the front bumper of the driver is in front of the other's, metres."""
        return self.driver.s - self.other.s

    @property
    def is_over(self) -> bool:
        """Whether one of the two has come to the end of its way."""
        return self.driver.is_at_end or self.other.is_at_end

    def behind(self, gap: float) -> float:
        """Return the lead of a driver behind the other, with a gap between the bumpers."""
        return -(gap + self.lengths[1])

    def in_front(self, gap: float) -> float:
        """Return the lead of a driver in front of the other, with a gap between the bumpers."""
        return gap + self.lengths[0]

    def step(self, relative: float, aside: float) -> None:
        """Let the coming step happen.

        Args:
            relative: How much faster than the other the driver wants to be, m/s.
            aside: Where it wants to be, metres to the left of the lane; it gets there smoothly.
        """
        drive_on(self.other, self.stage, self.speed, 0.0)
        dt, driver = self.stage.step_length, self.driver
        wanted = max(0.0, min(self.other.speed + relative, self._safe_speed()))
        limit = _ACCELERATION if wanted > driver.speed else _BRAKING
        driver.move(towards(driver.speed, wanted, limit * dt), aside)

    def hold(self, lead: float, aside: float, fastest: float) -> None:
        """Let the coming step bring the driver nearer to a lead, or keep it there."""
        relative = float(np.clip(_APPROACH * (lead - self.lead), -fastest, fastest))
        self.step(relative, aside)

    def has_room(self) -> bool:
        """Whether nobody is near where the driver wants to go aside."""
        driver, vehicles = self.driver, self.stage.api.vehicle
        for each in self.stage.vehicles:
            s, aside = driver.path.place_of(*vehicles.getPosition(each))
            is_in_the_way = -_ROOM_BEHIND < s - driver.s < _ROOM_AHEAD
            if is_in_the_way and abs(aside - self.aside) < _WIDE:
                return False
        return True

    def sees_way_free(self, passing: "_Passing") -> bool:
        """Whether nobody comes before the driver is back, and there is room for it then."""
        driver, vehicles = self.driver, self.stage.api.vehicle
        place = self.other.s + self.in_front(passing.ahead) + passing.faster * self.going
        for each in self.stage.vehicles:
            if each in (driver.vehicle, self.other.vehicle):
                continue
            s, aside = driver.path.place_of(*vehicles.getPosition(each))
            if abs(aside) < _WIDE:
                rear = s - vehicles.getLength(each)
                if s > self.other.s and rear < place + _ROOM_TO_RETURN:
                    return False
            elif abs(aside - self.aside) < _WIDE and _comes_at(driver, each, self.stage):
                closing = self.speed + passing.faster + vehicles.getSpeed(each)
                if 0 < s - driver.s < closing * (passing.lasts(self) + self.going):
                    return False
        return True

    def _safe_speed(self) -> float:
        """Return how fast the driver may be because of anybody else than the other driver."""
        ahead = self.stage.api.vehicle.getLeader(self.driver.vehicle, _ROOM_AHEAD)
        if ahead is None or ahead[0] in ("", self.other.vehicle):
            return np.inf
        return self.driver.safe_speed(_BRAKING)

    def sideways(self, begun: float, was: float, target: float) -> float:
        """Return where the driver is now on its way to the side, metres."""
        share = min(1.0, (self.stage.now + self.stage.step_length - begun) / self.going)
        return was + (target - was) * float((1 - np.cos(np.pi * share)) / 2)


@dataclass(frozen=True, slots=True)
class _Passing:
    """How a driver passes another.

    Attributes:
        faster: By how much it is faster than the other, m/s.
        ahead: Gap between the bumpers at which it begins to come back, metres.
    """

    faster: float
    ahead: float

    def lasts(self, duo: _Duo) -> float:
        """Return about how long it is until it begins to come back, seconds."""
        way = duo.in_front(self.ahead) - duo.lead
        return way / self.faster + self.faster / _ACCELERATION / 2


def overtake(act: Overtake, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Close up, go aside, pass the other, come back, and leave both alone after that."""
    faster = generator.uniform(*act.faster)
    ahead = generator.uniform(*act.ahead)
    duo = yield from _begin(act, stage, generator)
    passing = _Passing(faster, ahead)
    yield from _await_room(duo, passing if act.oncoming is not None else None)
    met = _meeting(act.oncoming, duo, passing, generator)
    next(met)
    for target, front in ((duo.aside, duo.in_front(ahead)), (0.0, -np.inf)):
        begun, was = stage.now, duo.driver.aside
        while not duo.is_over and (stage.now - begun < duo.going or duo.lead < front):
            duo.step(faster, duo.sideways(begun, was, target))
            next(met, None)
            yield
    yield from met


def abort_overtake(
    act: AbortOvertake, stage: Stage, generator: np.random.Generator
) -> Iterator[None]:
    """Close up; go aside, get level, fall back and come back, as often as drawn."""
    faster = generator.uniform(*act.faster)
    attempts = int(generator.integers(act.attempts[0], act.attempts[1] + 1))
    duo = yield from _begin(act, stage, generator)
    rear = duo.lead
    for _ in range(attempts):
        level = generator.uniform(*act.level)
        staying = _seconds(act.staying, generator)
        waiting = _seconds(act.waiting, generator)
        yield from _await_room(duo)
        yield from _move(duo, level, duo.aside, fastest=faster)
        yield from _stay(duo, level, duo.aside, staying)
        yield from _fall_back(duo, rear, faster)
        yield from _stay(duo, rear, 0.0, waiting)


def drive_beside(act: DriveBeside, stage: Stage, generator: np.random.Generator) -> Iterator[None]:
    """Close up, get beside the other, and sway there, now ahead and now behind."""
    sway = generator.uniform(*act.sway)
    period = _seconds(act.period, generator)
    duration = _seconds(act.duration, generator)
    duo = yield from _begin(act, stage, generator)
    level = (duo.lengths[0] - duo.lengths[1]) / 2
    yield from _await_room(duo)
    yield from _move(duo, level, duo.aside, fastest=_EAGER)
    begun = stage.now
    while not duo.is_over and stage.now - begun < duration:
        phase = 2 * np.pi * (stage.now - begun) / period
        duo.hold(level + sway * float(np.sin(phase)), duo.aside, _EAGER)
        yield
    while not duo.is_over:
        duo.hold(level, duo.aside, _EAGER)
        yield


def _begin(act: Pair, stage: Stage, generator: np.random.Generator) -> Generator[None, None, _Duo]:
    """Let both come in, and drive until the one is close behind the other at the place."""
    speed = generator.uniform(*act.speed)
    place = generator.uniform(*act.place)
    gap = generator.uniform(*act.gap)
    aside, going = act.aside, _seconds(act.going, generator)
    other = yield from come_in((act.others, act.route, act.lane), speed, stage, generator)
    coming = come_in((act.types, act.route, act.lane), speed, stage, generator)
    driver = None
    while driver is None:
        drive_on(other, stage, speed, 0.0)
        try:
            next(coming)
        except StopIteration as arrived:
            driver = arrived.value
        yield
    api = stage.api.vehicle
    lengths = float(api.getLength(driver.vehicle)), float(api.getLength(other.vehicle))
    duo = _Duo(driver, other, speed, aside, going, lengths, stage)
    rear = duo.behind(gap)
    while not duo.is_over and (other.s < place or abs(duo.lead - rear) > _NEAR):
        duo.hold(rear, 0.0, _EAGER)
        yield
    return duo


def _await_room(duo: _Duo, passing: _Passing | None = None) -> Iterator[None]:
    """Stay behind the other until nobody is in the way, nor will be if it passes like this."""
    rear = duo.lead
    while not duo.is_over and not (
        duo.has_room() and (passing is None or duo.sees_way_free(passing))
    ):
        duo.hold(rear, 0.0, _EAGER)
        yield


def _move(duo: _Duo, lead: float, aside: float, *, fastest: float) -> Iterator[None]:
    """Go to the side and to a lead, until both are reached."""
    begun, was = duo.stage.now, duo.driver.aside
    while not duo.is_over:
        duo.hold(lead, duo.sideways(begun, was, aside), fastest)
        yield
        if duo.stage.now - begun >= duo.going and abs(duo.lead - lead) < _NEAR:
            return


def _fall_back(duo: _Duo, rear: float, fastest: float) -> Iterator[None]:
    """Fall back, and come back behind the other once there is room."""
    room = duo.behind(1.5)
    while not duo.is_over and duo.lead > room:
        duo.hold(rear, duo.aside, fastest)
        yield
    yield from _move(duo, rear, 0.0, fastest=fastest)


def _stay(duo: _Duo, lead: float, aside: float, duration: float) -> Iterator[None]:
    begun = duo.stage.now
    while not duo.is_over and duo.stage.now - begun < duration:
        duo.hold(lead, aside, _EAGER)
        yield


def _meeting(
    oncoming: Oncoming | None, duo: _Duo, passing: _Passing, generator: np.random.Generator
) -> Iterator[None]:
    """Let somebody come the other way, who meets the driver as long after it as wanted."""
    yield
    if oncoming is None:
        return
    stage = duo.stage
    speed = generator.uniform(*oncoming.speed)
    lasting = passing.lasts(duo) + _seconds(oncoming.spare, generator)
    distance = (duo.speed + passing.faster + speed) * lasting
    roads = tuple(stage.ways(oncoming.route))
    path = stage.lane_path(roads, oncoming.lane)
    place, _ = path.place_of(*duo.driver.path.point(duo.driver.s + distance))
    kind = drawn_type_name(oncoming.types, generator)
    vehicle = stage.enter(
        Entrance(kind, roads, oncoming.lane, place=max(place, 1.0), speed=speed), generator
    )
    while not stage.is_here(vehicle):
        yield
    driver = PathDriver(stage, vehicle, path)
    while not driver.is_at_end and stage.is_here(vehicle):
        _come_towards(driver, stage, speed)
        yield


def _come_towards(driver: PathDriver, stage: Stage, speed: float) -> None:
    """Let the coming step happen to who comes: it makes room for who is on its side, or brakes."""
    time, room = _next_met(driver, stage)
    target = -min(_CLEAR - room, _SHOULDER) if room < _CLEAR else 0.0
    aside = towards(driver.aside, target, _SIDEWAYS * stage.step_length)
    would_touch = time < _BRAKES and room - driver.aside < _CLEAR
    drive_on(driver, stage, _CREEPING if would_touch else speed, aside)


def _next_met(driver: PathDriver, stage: Stage) -> tuple[float, float]:
    """Return in how many seconds a driver meets the next one who comes at it, and where.

    Returns:
        The seconds, and how far to the left of its path that one is, metres; both infinite if
        it meets nobody soon.
    """
    vehicles = stage.api.vehicle
    met = np.inf, np.inf
    for each in stage.vehicles:
        if not _comes_at(driver, each, stage):
            continue
        s, aside = driver.path.place_of(*vehicles.getPosition(each))
        closing = driver.speed + vehicles.getSpeed(each)
        both = vehicles.getLength(each) + vehicles.getLength(driver.vehicle)
        if -both < s - driver.s < closing * _MINDS and abs(aside) < _CLEAR:
            met = min(met, (max(s - driver.s, 0.0) / max(closing, 0.1), aside))
    return met


def _comes_at(driver: PathDriver, vehicle: str, stage: Stage) -> bool:
    """Whether a vehicle goes against the direction in which a driver goes."""
    heading = np.radians(90.0 - stage.api.vehicle.getAngle(vehicle))
    return bool(np.cos(heading - driver.path.heading(driver.s)) < 0)


def _seconds(span: DurationRange, generator: np.random.Generator) -> float:
    return float(generator.uniform(*span)) / SECOND

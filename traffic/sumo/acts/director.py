"""Lets the acts of a scenario begin when they are due, and go on until they are over."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dyknow.time import SECOND
from traffic.scenarios.acts import Act
from traffic.scenarios.model import Scenario
from traffic.sumo.acts.performance import Performance, VehicleGoneError
from traffic.sumo.acts.registry import performance_of
from traffic.sumo.acts.stage import Stage

__all__ = ["Beginning", "Director", "beginnings"]


@dataclass(frozen=True, slots=True)
class Beginning:
    """A performance that is to begin.

    Attributes:
        time: Seconds from time 0.
        act: What is performed.
        generator: For all that is random in it.
    """

    time: float
    act: Act
    generator: np.random.Generator


def beginnings(scenario: Scenario, generator: np.random.Generator) -> list[Beginning]:
    """Draw when the acts of *scenario* begin, in order of time.

    Each performance has a generator of its own, so that what one draws changes no other.
    """
    first, last = -scenario.warm_up / SECOND, scenario.duration / SECOND
    drawn: list[Beginning] = []
    for act, own in zip(scenario.acts, generator.spawn(len(scenario.acts)), strict=True):
        times = [time / SECOND for time in act.times]
        if act.rate_per_hour is not None:
            times = _arrivals(act.rate_per_hour, first, last, own)
        drawn += [
            Beginning(time, act, each)
            for time, each in zip(times, own.spawn(len(times)), strict=True)
        ]
    return sorted(drawn, key=lambda beginning: beginning.time)


class Director:
    """Steps every performance before each step of the simulator.

    A performance whose vehicle is gone is over; its `finally` blocks have run then.

    Args:
        due: What begins when, in order of time.
    """

    def __init__(self, due: Sequence[Beginning]) -> None:
        self._due = list(due)
        self._running: list[Performance] = []

    @property
    def n_running(self) -> int:
        """How many performances have begun and are not over."""
        return len(self._running)

    def step(self, stage: Stage, now: float) -> None:
        """Let all that is due before the coming step happen.

        Args:
            stage: Where.
            now: Time of the frame that the coming step makes, seconds from time 0.
        """
        stage.begin_step(now)
        while self._due and self._due[0].time <= now:
            begun = self._due.pop(0)
            self._running.append(performance_of(begun.act, stage, begun.generator))
        self._running = [each for each in self._running if not _is_over(each, now)]


def _is_over(performance: Performance, now: float) -> bool:
    try:
        return performance.step(now)
    except VehicleGoneError:
        return True


def _arrivals(
    rate_per_hour: float, first: float, last: float, generator: np.random.Generator
) -> list[float]:
    times: list[float] = []
    time = first + generator.exponential(3600 / rate_per_hour)
    while time < last:
        times.append(time)
        time += generator.exponential(3600 / rate_per_hour)
    return times

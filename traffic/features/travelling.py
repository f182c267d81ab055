"""Whether a car travels, decided afterwards from the way it went.

How fast a car is now is what a filter knows least about: braking shows in its positions only
after a while. How fast it was a moment ago follows from how far it got since. So what is not
urgent is decided later and better.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.table import Table, positions_of
from dyknow.time import SECOND, Duration, TimePoint
from traffic.features.decisions import Decisions

__all__ = ["Travelling"]

Floats = npt.NDArray[np.float64]

_SURER = 0.5
"""By what factor a speed is better known afterwards than at once."""

_LEAST_DEVIATION = 0.1
"""m/s by which a speed is uncertain at least."""


@dataclass(slots=True)
class _Entry:
    """The cars of one table.

    Attributes:
        time: When it was valid.
        cars: It.
    """

    time: TimePoint
    cars: Table


class Travelling(Reactive):
    """Decides of each car whether it travels faster than *speed*, in a column `travelling`.

    For each table of cars one comes out that is valid half of *over* and *within* earlier. The
    speed at a time is the mean of two: how far the car got from half of *over* before to half
    of *over* after, and how fast it was believed to be at both ends. Of a car that was not known
    so long before, or is gone so soon after, it is that at the time itself.

    Args:
        speed: m/s.
        over: How long the way is from which the speed is taken.
        certainty: Standard deviations from which an estimate is believed.
        within: How long it may take to become certain.
    """

    def __init__(
        self, *, speed: float, over: Duration, certainty: float, within: Duration
    ) -> None:
        self._speed = speed
        self._half = Duration(over // 2)
        self._entries: list[_Entry] = []
        self._next = 0
        self._decisions = Decisions(1, certainty=certainty, within=within)

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> Iterable[Sample[Table]]:
        """Emit the cars about which the newest table decides."""
        (sample,) = inputs
        self._entries.append(_Entry(sample.valid_time, sample.value))
        for entry, evidence in self._known():
            for time, cars, codes in self._decisions.push(entry.time, entry.cars, evidence):
                yield Sample(Table(cars.sort, cars.ids, {"travelling": codes[:, 0]}), time, now)

    def _known(self) -> Iterator[tuple[_Entry, Floats]]:
        """Yield the tables of which it is known now how the cars went on."""
        newest = self._entries[-1]
        while self._next < len(self._entries):
            entry = self._entries[self._next]
            if entry.time + self._half > newest.time:
                return
            while self._next and self._entries[1].time + self._half <= entry.time:
                del self._entries[0]
                self._next -= 1
            yield entry, self._evidence(entry, self._entries[0], newest)
            self._next += 1

    def _evidence(self, entry: _Entry, before: _Entry, after: _Entry) -> Floats:
        cars = entry.cars
        speed = cars["speed"].copy()
        deviation = np.hypot(np.sqrt(cars["speed_variance"]), _LEAST_DEVIATION)
        first = positions_of(cars.ids, before.cars.ids)
        last = positions_of(cars.ids, after.cars.ids)
        (both,) = np.nonzero((first >= 0) & (last >= 0))
        if after.time > before.time:
            start, end = before.cars.select(first[both]), after.cars.select(last[both])
            way = np.linalg.norm(end["position"] - start["position"], axis=1)
            mean = way / ((after.time - before.time) / SECOND)
            speed[both] = mean / 2 + (start["speed"] + end["speed"]) / 4
            deviation[both] *= _SURER
        evidence: Floats = (speed - self._speed) / deviation
        return evidence[:, None]

"""Instants that know from which state they were reckoned, and what was asked about them.

A `Moment` is an integer that stands for the time of some state plus a constant. Computing with
moments instead of plain instants gives the same results, and a record of the comparisons on which
they depended: under other times for which each comparison turns out the same, the same moments
come out. What follows from the order of the states and from earlier comparisons is not recorded
again; for this a matrix of the known bounds on all differences is kept closed, as for simple
temporal networks (Dechter, Meiri and Pearl 1991).
"""

from collections.abc import Sequence
from typing import NoReturn, Protocol

import numpy as np
import numpy.typing as npt

from dyknow.mtl.instants import FUTURE, PAST

__all__ = ["Comparison", "Comparisons", "Moment", "PlainComparisons", "RecordedComparisons"]

Comparison = tuple[int, int, int, bool]
"""The times of two states, a bound, and whether the first less the second is below the bound."""

_UNBOUNDED = 1 << 61


class Comparisons(Protocol):
    """Decides whether one time lies less than a bound after another."""

    def are_closer(self, one: int, other: int, bound: int) -> bool:
        """Return whether the time of state *one* less that of state *other* is below *bound*."""


class PlainComparisons:
    """Comparisons of known times."""

    def __init__(self, times: Sequence[int]) -> None:
        self._times = times

    def are_closer(self, one: int, other: int, bound: int) -> bool:
        """Return whether the time of state *one* less that of state *other* is below *bound*."""
        return self._times[one] - self._times[other] < bound


class RecordedComparisons:
    """Comparisons of known times that are recorded, each once and only if it says something new.

    Attributes:
        record: The comparisons that were made.
    """

    def __init__(self, times: Sequence[int]) -> None:
        """Take the times of states, from the last one backwards, and then that of the new one."""
        self._times = times
        self.record: list[Comparison] = []
        n = len(times)
        newest_first = np.array([n - 1, *range(n - 1)])
        order = np.argsort(newest_first)
        later = order[:, None] - order[None, :]
        self._most: npt.NDArray[np.int64] = np.where(later >= 0, -later, _UNBOUNDED)

    def are_closer(self, one: int, other: int, bound: int) -> bool:
        """Return whether the time of state *one* less that of state *other* is below *bound*."""
        if self._most.item(one, other) < bound:
            return True
        if self._most.item(other, one) <= -bound:
            return False
        closer = self._times[one] - self._times[other] < bound
        self.record.append((one, other, bound, closer))
        if closer:
            self._note(one, other, bound - 1)
        else:
            self._note(other, one, -bound)
        return closer

    def _note(self, one: int, other: int, most: int) -> None:
        through = self._most[:, one, None] + most + self._most[None, other, :]
        np.minimum(self._most, through, out=self._most)


class Moment(int):
    """An instant relative to now that is the time of a state plus a constant.

    Plain integers that it meets are instants relative to now, with no bound if they are `PAST`
    or `FUTURE`, and durations where they are added or subtracted.

    Attributes:
        state: The number of the state.
        offset: The duration since the time of the state.
    """

    state: int
    offset: int
    _now: int
    _comparisons: Comparisons

    @classmethod
    def make(
        cls, state: int, offset: int, times: Sequence[int], comparisons: Comparisons
    ) -> "Moment":
        """Return the moment *offset* after a state; the last one of *times* is now."""
        moment = cls(times[state] + offset - times[-1])
        moment.state, moment.offset = state, offset
        moment._now = len(times) - 1
        moment._comparisons = comparisons
        return moment

    def __add__(self, duration: int) -> "Moment":
        moment = Moment(int(self) + duration)
        moment.state, moment.offset = self.state, self.offset + duration
        moment._now, moment._comparisons = self._now, self._comparisons
        return moment

    __radd__ = __add__

    def __sub__(self, duration: int) -> "Moment":
        return self + -duration

    def __lt__(self, other: int) -> bool:
        return self._is_before(other)

    def __le__(self, other: int) -> bool:
        return not self._is_after(other)

    def __gt__(self, other: int) -> bool:
        return self._is_after(other)

    def __ge__(self, other: int) -> bool:
        return not self._is_before(other)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, int):
            return NotImplemented
        return not self._is_before(other) and not self._is_after(other)

    def __hash__(self) -> NoReturn:
        """Refuse, as a set or a dictionary would compare moments without asking them."""
        raise TypeError("moments are compared, never looked up")

    def _is_before(self, other: int) -> bool:
        if isinstance(other, Moment):
            if other.state == self.state:
                return self.offset < other.offset
            bound = other.offset - self.offset
            return self._comparisons.are_closer(self.state, other.state, bound)
        if other in {PAST, FUTURE}:
            return other == FUTURE
        return self._comparisons.are_closer(self.state, self._now, other - self.offset)

    def _is_after(self, other: int) -> bool:
        if isinstance(other, Moment):
            return other < self
        if other in {PAST, FUTURE}:
            return other == PAST
        return self._comparisons.are_closer(self._now, self.state, self.offset - other)

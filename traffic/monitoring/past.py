"""The states that a verdict can depend on, as long as memory allows.

A formula that is to hold henceforth, `always f` or several of these, begins anew with each state:
if what is left of it after a state is what would be left had the monitor begun with that state,
the states before do not matter any more and are forgotten. Of other formulas all states are kept,
up to a limit.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from dyknow.mtl import syntax
from dyknow.mtl.monitors import Monitor
from dyknow.mtl.syntax import ALWAYS_HENCEFORTH, Formula
from dyknow.time import TimePoint

__all__ = ["MOST_KEPT", "Past", "PastState"]

MOST_KEPT = 100_000
"""States."""

_RESERVE = 1_000
_MOST_BEGINNINGS = 4_096


@dataclass(frozen=True, slots=True)
class PastState:
    """A state that was seen.

    Attributes:
        time: When.
        bits: The truth of atom number i of the formula in bit i.
        values: The features.
    """

    time: TimePoint
    bits: int
    values: Mapping[str, Any]


class Past:
    """What a monitor has seen.

    Attributes:
        monitor: The monitor.
        is_lost: Whether states are missing that the verdict may depend on.
    """

    def __init__(self, monitor: Monitor, most_kept: int = MOST_KEPT) -> None:
        """Remember what *monitor* sees from its first state on."""
        self.monitor = monitor
        self.is_lost = False
        self._most_kept = most_kept
        self._begins_anew = _is_henceforth(monitor.table.formula)
        self._states: list[PastState] = []
        self._begin = 0
        self._beginnings: dict[int, Formula] = {}

    def add(self, now: TimePoint, bits: int, values: Mapping[str, Any], residual: Formula) -> None:
        """Remember a state, and forget those that do not matter for *residual*, what is left."""
        if self.is_lost:
            return
        if self._begins_anew and self._beginning(bits) == residual:
            self._begin = len(self._states)
        self._states.append(PastState(now, bits, values))
        if self._begin > 2 * _RESERVE:
            self._forget(self._begin - _RESERVE)
        if len(self._states) > 2 * self._most_kept:
            self._forget(self._most_kept)
            self.is_lost = not self._begins_anew

    def stretches(self) -> list[list[PastState]]:
        """Return the states on which the verdict depends, up to the last one.

        If there are several stretches, each ends with the one before; a longer one is there in
        case that states were forgotten that did matter.
        """
        if self.is_lost:
            return []
        begins = dict.fromkeys((self._begin, 0)) if self._begins_anew else (0,)
        return [self._states[begin:] for begin in begins]

    def _beginning(self, bits: int) -> Formula:
        """Return what is left of the formula after a first state."""
        residual = self._beginnings.get(bits)
        if residual is None:
            if len(self._beginnings) >= _MOST_BEGINNINGS:
                self._beginnings.clear()
            fresh = Monitor(self.monitor.table)
            fresh.step_bits(TimePoint(0), bits)
            residual = self._beginnings[bits] = fresh.residual
        return residual

    def _forget(self, count: int) -> None:
        del self._states[:count]
        self._begin = max(0, self._begin - count)


def _is_henceforth(formula: Formula) -> bool:
    match formula:
        case syntax.Always(within):
            return within == ALWAYS_HENCEFORTH
        case syntax.Conjunction(bodies):
            return all(map(_is_henceforth, bodies))
        case _:
            return False

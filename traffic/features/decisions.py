"""Truths that turn when there is enough evidence, dated back to when it began to say so.

Evidence is a number of standard deviations: how far an estimate lies on the side on which
something is true, or, if it is negative, on the other side. One that is small says nothing. So a
truth turns only if the evidence becomes greater than some number, and then it turned when the
evidence last changed its sign: the estimate was right from there on, and only not sure yet.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dyknow.streams.table import Table, positions_of
from dyknow.time import Duration, TimePoint
from traffic.features.stability import UNKNOWN

__all__ = ["Codes", "Decisions"]

Floats = npt.NDArray[np.float64]
Codes = npt.NDArray[np.int32]


@dataclass(slots=True)
class _Entry:
    """A table that has not been decided on.

    Attributes:
        time: When it was valid.
        table: It.
        evidence: shape (n, k), standard deviations, for each row and each truth.
    """

    time: TimePoint
    table: Table
    evidence: Floats


class Decisions:
    """Decides on truths about the objects of tables, some time after the tables.

    A truth about an object is unknown until it is decided. It becomes true at the first time
    since which the evidence is positive without interruption until it is at least *certainty*, if
    that is so at most *within* later; it becomes false in the same way. Evidence that says
    neither for longer leaves it as it is, and turns it late once it does.

    Args:
        n_truths: How many truths there are about each object.
        certainty: Standard deviations.
        within: How long the evidence may take to become certain.
    """

    def __init__(self, n_truths: int, *, certainty: float, within: Duration) -> None:
        if certainty < 0:
            raise ValueError(f"expected a certainty of at least 0, found {certainty}")
        self._certainty = certainty
        self._within = within
        self._waiting: list[_Entry] = []
        self._decided = Table("none", (), {})
        self._codes: Codes = np.empty((0, n_truths), dtype=np.int32)

    def push(
        self, time: TimePoint, table: Table, evidence: Floats
    ) -> Iterator[tuple[TimePoint, Table, Codes]]:
        """Take in a table; yield those on which all is decided.

        Args:
            time: When the table is valid.
            table: The objects.
            evidence: shape (n, k), for each of them and each truth; NaN for none.

        Yields:
            Earlier tables, each once and in order, with when they were valid, and for each row
            and each truth 1, 0 or `UNKNOWN`.
        """
        self._waiting.append(_Entry(time, table, evidence))
        while self._waiting and self._waiting[0].time + self._within <= time:
            entry = self._waiting[0]
            self._decide(entry.table)
            del self._waiting[0]
            yield entry.time, entry.table, self._codes

    def _decide(self, table: Table) -> None:
        """Decide on the first of the tables that wait, knowing all that came after it."""
        before = positions_of(table.ids, self._decided.ids)
        shape = len(table), self._codes.shape[1]
        codes = np.full(shape, UNKNOWN, dtype=np.int32)
        codes[before >= 0] = self._codes[before[before >= 0]]
        becomes_true, becomes_false = np.zeros((2, *shape), dtype=np.bool_)
        latest = self._waiting[0].time + self._within
        for entry in reversed(self._waiting):
            if entry.time > latest:
                continue
            evidence = _aligned(entry, table)
            becomes_true = (evidence > 0) & (becomes_true | (evidence >= self._certainty))
            becomes_false = (evidence < 0) & (becomes_false | (evidence <= -self._certainty))
        codes[becomes_true] = 1
        codes[becomes_false] = 0
        self._decided, self._codes = table, codes


def _aligned(entry: _Entry, table: Table) -> Floats:
    """Return the evidence of an entry about the objects of *table*, NaN about others."""
    if entry.table is table:
        return entry.evidence
    at = positions_of(table.ids, entry.table.ids)
    if not (at < 0).any():
        return entry.evidence[at]
    evidence = np.full((len(table), entry.evidence.shape[1]), np.nan)
    evidence[at >= 0] = entry.evidence[at[at >= 0]]
    return evidence

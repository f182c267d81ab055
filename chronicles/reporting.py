"""Which matches of a chronicle are reported as recognitions.

Formally every assignment that satisfies a chronicle is a match. What a person counts is often
less: a car that passes another is one overtake, however many ways there are to choose the
instants. `report non_overlapping (t1, t2)` says so.
"""

from chronicles.events import Recognition
from chronicles.matching import Matcher
from chronicles.patterns import Values

__all__ = ["NonOverlapping"]

_LEAST_TO_SWEEP = 1024


class NonOverlapping:
    """Reports matches with the same arguments only if they share no instant.

    Of two matches whose intervals share an instant the one that was recognised first is
    reported; among those recognised at the same time, the one that ends first, and then the one
    that begins first.
    """

    def __init__(self, matcher: Matcher, interval: tuple[int, int]) -> None:
        self._matcher = matcher
        self._first, self._last = interval
        self._reported: dict[Values, list[tuple[int, int]]] = {}
        self._n_reported = 0
        self._sweep_at = _LEAST_TO_SWEEP

    def __len__(self) -> int:
        return self._n_reported

    def admits(self, recognition: Recognition, times: list[int], clock: int) -> bool:
        """Return whether to report *recognition* of a match with *times*; remember it if so."""
        arguments = tuple(recognition.arguments.values())
        begin, end = times[self._first], times[self._last]
        reported = self._reported.setdefault(arguments, [])
        if any(begin <= last and first <= end for first, last in reported):
            return False
        reported.append((begin, end))
        self._n_reported += 1
        if self._n_reported > self._sweep_at:
            self._sweep(clock)
        return True

    def _sweep(self, clock: int) -> None:
        """Forget the intervals that no later match can reach."""
        reach = self._matcher.earliest_begin(self._first, clock)
        kept = {
            arguments: [interval for interval in reported if interval[1] >= reach]
            for arguments, reported in self._reported.items()
        }
        self._reported = {arguments: found for arguments, found in kept.items() if found}
        self._n_reported = sum(map(len, self._reported.values()))
        self._sweep_at = max(_LEAST_TO_SWEEP, 2 * self._n_reported)

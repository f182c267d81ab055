"""How sure one can be of a share that was counted."""

import math
from typing import NamedTuple

__all__ = ["Interval", "difference", "wilson"]

_Z = 1.959963984540054
"""Of a confidence of 95 %."""


class Interval(NamedTuple):
    """Where the truth lies with a confidence of 95 %."""

    low: float
    high: float


def wilson(successes: int, trials: int) -> Interval:
    """Return the interval of Wilson (1927) for the probability behind *successes* in *trials*.

    It keeps its confidence near 0 and 1 and for few trials, where the textbook interval has no
    width. Nothing is known of no trials: 0 to 1.
    """
    if not 0 <= successes <= trials:
        raise ValueError(f"expected at most {trials} successes, found {successes}")
    if trials == 0:
        return Interval(0.0, 1.0)
    share, z2 = successes / trials, _Z * _Z
    centre = (share + z2 / (2 * trials)) / (1 + z2 / trials)
    spread = math.sqrt(share * (1 - share) / trials + z2 / (4 * trials * trials))
    half = _Z * spread / (1 + z2 / trials)
    low = 0.0 if successes == 0 else max(0.0, centre - half)
    high = 1.0 if successes == trials else min(1.0, centre + half)
    return Interval(low, high)


def difference(one: tuple[int, int], other: tuple[int, int]) -> Interval:
    """Return the interval of the *other* probability minus the *one*.

    Both are given as successes and trials. This is the method of Newcombe (1998), number 10,
    which puts two intervals of Wilson together.
    """
    if not one[1] or not other[1]:
        return Interval(-1.0, 1.0)
    p1, p2 = one[0] / one[1], other[0] / other[1]
    (l1, u1), (l2, u2) = wilson(*one), wilson(*other)
    gap = p2 - p1
    low = gap - math.hypot(p2 - l2, u1 - p1)
    high = gap + math.hypot(u2 - p2, p1 - l1)
    return Interval(low, high)

"""What sums, intersections and unions of intervals amount to."""

from chronicles.syntax import Interval
from dyknow.time import Duration

__all__ = ["intersection_of", "is_empty", "negated", "sum_of", "union_of"]


def negated(interval: Interval) -> Interval:
    """Return what is as much earlier as *interval* is later."""
    lower = None if interval.upper is None else Duration(-interval.upper)
    upper = None if interval.lower is None else Duration(-interval.lower)
    return Interval(interval.span, lower, upper)


def sum_of(left: Interval, right: Interval) -> Interval:
    """Return the sums of a length of one and a length of the other."""

    def plus(one: Duration | None, other: Duration | None) -> Duration | None:
        return None if one is None or other is None else Duration(one + other)

    return Interval(left.span, plus(left.lower, right.lower), plus(left.upper, right.upper))


def intersection_of(left: Interval, right: Interval) -> Interval:
    """Return what is in both, perhaps an interval that is empty."""
    lowers = [limit for limit in (left.lower, right.lower) if limit is not None]
    uppers = [limit for limit in (left.upper, right.upper) if limit is not None]
    return Interval(left.span, max(lowers, default=None), min(uppers, default=None))


def is_empty(interval: Interval, by: int = 0) -> bool:
    """Return whether an interval ends before it begins, by more than *by*."""
    lower, upper = interval.lower, interval.upper
    return lower is not None and upper is not None and lower > upper + by


def union_of(left: Interval, right: Interval) -> Interval:
    """Return what is in either, and between them."""
    lower = upper = None
    if left.lower is not None and right.lower is not None:
        lower = min(left.lower, right.lower)
    if left.upper is not None and right.upper is not None:
        upper = max(left.upper, right.upper)
    return Interval(left.span, lower, upper)

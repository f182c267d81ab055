"""From the constraints of a stream term to the policy they make."""

from collections.abc import Iterable

from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    AnyChange,
    AnyOrder,
    AnyUpdate,
    Constraint,
    Endless,
    FromTo,
    MaxDelay,
    MonotoneOrder,
    Name,
    NoApproximation,
    SampleEvery,
    StrictOrder,
    Time,
    To,
    UseMostRecent,
)
from dyknow.streams import policy
from dyknow.streams.policy import ANY_CHANGE, ANY_UPDATE, Approximation, Change, Order, Policy
from dyknow.time import Duration, TimePoint

__all__ = ["policy_from_constraints"]

_KINDS: dict[type[Constraint], str] = {
    NoApproximation: "approximation",
    UseMostRecent: "approximation",
    AnyUpdate: "change",
    AnyChange: "change",
    SampleEvery: "change",
    MaxDelay: "delay",
    FromTo: "duration",
    To: "duration",
    AnyOrder: "order",
    MonotoneOrder: "order",
    StrictOrder: "order",
}
_ORDERS: dict[type[Constraint], Order] = {
    AnyOrder: Order.ANY,
    MonotoneOrder: Order.MONOTONE,
    StrictOrder: Order.STRICT,
}


def policy_from_constraints(constraints: Iterable[Constraint]) -> Policy:
    """Return the policy of a stream term whose parameters are bound.

    Raises:
        ValueError: No stream can keep the constraints, or there are two of one kind.
    """
    by_kind: dict[str, Constraint] = {}
    for constraint in constraints:
        kind = _KINDS[type(constraint)]
        if kind in by_kind:
            first, second = text_from(by_kind[kind]), text_from(constraint)
            raise ValueError(f"there are two {kind} constraints, '{first}' and '{second}'")
        by_kind[kind] = constraint
    start, end = _duration(by_kind.get("duration"))
    return Policy(
        approximation=_approximation(by_kind.get("approximation")),
        change=_change(by_kind.get("change")),
        max_delay=_max_delay(by_kind.get("delay")),
        start=start,
        end=end,
        order=_ORDERS.get(type(by_kind.get("order", AnyOrder())), Order.ANY),
    )


def _approximation(constraint: Constraint | None) -> Approximation:
    is_approximated = isinstance(constraint, UseMostRecent)
    return Approximation.MOST_RECENT if is_approximated else Approximation.NONE


def _change(constraint: Constraint | None) -> Change:
    match constraint:
        case SampleEvery(period):
            return policy.SampleEvery(_finite(period))
        case AnyChange():
            return ANY_CHANGE
        case _:
            return ANY_UPDATE


def _max_delay(constraint: Constraint | None) -> Duration | None:
    return _time(constraint.delay) if isinstance(constraint, MaxDelay) else None


def _duration(constraint: Constraint | None) -> tuple[TimePoint | None, TimePoint | None]:
    match constraint:
        case FromTo(start, end):
            return TimePoint(_finite(start)), _point(end)
        case To(end):
            return None, _point(end)
        case _:
            return None, None


def _point(time: Time | Name | Endless | None) -> TimePoint | None:
    found = _time(time)
    return None if found is None else TimePoint(found)


def _time(time: Time | Name | Endless | None) -> Duration | None:
    return None if time is None or isinstance(time, Endless) else _finite(time)


def _finite(time: Time | Name) -> Duration:
    if isinstance(time, Name):
        raise TypeError(f"the parameter '{time.text}' is not bound")
    return time.time

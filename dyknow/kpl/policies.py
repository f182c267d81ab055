"""From the constraints of a policy, as written, to the policy they make, and back."""

from collections.abc import Iterable, Mapping

from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    AllUpdates,
    AnyChange,
    AnyOrder,
    AnyUpdate,
    AtMaxDelay,
    Capacity,
    Constraint,
    DelayBeforeApproximation,
    Endless,
    FromTo,
    MaxDelay,
    MonotoneOrder,
    Name,
    NoApproximation,
    SampleEvery,
    SampleEveryCommonPeriod,
    StrictOrder,
    Time,
    To,
    UseLatest,
    UseLinear,
    UseMostRecent,
)
from dyknow.streams import policy
from dyknow.streams.policy import ANY_CHANGE, ANY_UPDATE, Approximation, Change, Order, Policy
from dyknow.time import Duration, TimePoint

__all__ = [
    "by_kind",
    "constraints_from_policy",
    "duration_from",
    "finite",
    "max_delay_from",
    "policy_from_constraints",
    "text_from_policy",
]

_KINDS: dict[type, str] = {
    NoApproximation: "approximation",
    UseMostRecent: "approximation",
    UseLinear: "approximation",
    UseLatest: "approximation",
    AnyUpdate: "change",
    AnyChange: "change",
    AllUpdates: "change",
    SampleEvery: "change",
    SampleEveryCommonPeriod: "change",
    DelayBeforeApproximation: "delay before approximation",
    MaxDelay: "delay",
    AtMaxDelay: "settling",
    Capacity: "capacity",
    FromTo: "duration",
    To: "duration",
    AnyOrder: "order",
    MonotoneOrder: "order",
    StrictOrder: "order",
}
_OF_STATES_ALONE = (
    UseLatest,
    UseLinear,
    AllUpdates,
    SampleEveryCommonPeriod,
    DelayBeforeApproximation,
    AtMaxDelay,
    Capacity,
)
_ORDERS: dict[type, Order] = {
    AnyOrder: Order.ANY,
    MonotoneOrder: Order.MONOTONE,
    StrictOrder: Order.STRICT,
}


def policy_from_constraints(constraints: Iterable[Constraint]) -> Policy:
    """Return the policy of a stream whose parameters are bound.

    Raises:
        ValueError: No stream can keep the constraints, there are two of one kind, or one is for
            synchronisations.
    """
    given = by_kind(constraints)
    if unfit := [each for each in given.values() if isinstance(each, _OF_STATES_ALONE)]:
        raise ValueError(f"'{text_from(unfit[0])}' is for sync(...) alone")
    start, end = duration_from(given.get("duration"))
    is_approximated = isinstance(given.get("approximation"), UseMostRecent)
    return Policy(
        approximation=Approximation.MOST_RECENT if is_approximated else Approximation.NONE,
        change=_change(given.get("change")),
        max_delay=max_delay_from(given.get("delay")),
        start=start,
        end=end,
        order=_ORDERS.get(type(given.get("order")), Order.ANY),
    )


def constraints_from_policy(of: Policy) -> tuple[Constraint, ...]:
    """Return the constraints that make a policy; those that restrict nothing are left out."""
    found: list[Constraint | None] = [
        _written_change(of.change),
        UseMostRecent() if of.approximation is Approximation.MOST_RECENT else None,
        None if of.max_delay is None else MaxDelay(Time(of.max_delay)),
        _written_duration(of),
        _written_order(of.order),
    ]
    return tuple(each for each in found if each is not None)


def text_from_policy(of: Policy) -> str:
    """Write a policy as it stands after `with`; nothing for the one that restricts nothing."""
    return ", ".join(map(text_from, constraints_from_policy(of)))


def _written_change(change: Change) -> Constraint | None:
    if isinstance(change, policy.SampleEvery):
        deviation = Time(change.deviation) if change.deviation else None
        longest = None if change.longest is None else Time(change.longest)
        return SampleEvery(Time(change.period), deviation, longest)
    return AnyChange() if change is ANY_CHANGE else None


def _written_order(order: Order) -> Constraint | None:
    if order is Order.STRICT:
        return StrictOrder()
    return MonotoneOrder() if order is Order.MONOTONE else None


def _written_duration(of: Policy) -> Constraint | None:
    """Return the duration constraint; `use most recent` is written with both its ends."""
    end = None if of.end is None else Time(Duration(of.end))
    if of.start is None:
        return None if end is None else To(end)
    if of.approximation is Approximation.MOST_RECENT:
        return FromTo(Time(Duration(of.start)), end or Endless())
    return FromTo(Time(Duration(of.start)), end)


def by_kind(constraints: Iterable[Constraint]) -> Mapping[str, Constraint]:
    """Return constraints by kind: `approximation`, `change`, `delay`, `duration`, `order` ...

    Raises:
        ValueError: There are two of one kind.
    """
    found: dict[str, Constraint] = {}
    for constraint in constraints:
        kind = _KINDS[type(constraint)]
        if kind in found:
            first, second = text_from(found[kind]), text_from(constraint)
            raise ValueError(f"there are two {kind} constraints, '{first}' and '{second}'")
        found[kind] = constraint
    return found


def _change(constraint: Constraint | None) -> Change:
    match constraint:
        case SampleEvery(period, deviation, longest):
            return policy.SampleEvery(
                finite(period),
                Duration(0) if deviation is None else finite(deviation),
                None if longest is None else finite(longest),
            )
        case AnyChange():
            return ANY_CHANGE
        case _:
            return ANY_UPDATE


def max_delay_from(constraint: Constraint | None) -> Duration | None:
    """Return the largest delay that a delay constraint allows, None for any."""
    return _time(constraint.delay) if isinstance(constraint, MaxDelay) else None


def duration_from(constraint: Constraint | None) -> tuple[TimePoint | None, TimePoint | None]:
    """Return the beginning and the end that a duration constraint gives, None for any."""
    match constraint:
        case FromTo(start, end):
            return TimePoint(finite(start)), _point(end)
        case To(end):
            return None, _point(end)
        case _:
            return None, None


def _point(time: Time | Name | Endless | None) -> TimePoint | None:
    found = _time(time)
    return None if found is None else TimePoint(found)


def _time(time: Time | Name | Endless | None) -> Duration | None:
    return None if time is None or isinstance(time, Endless) else finite(time)


def finite(time: Time | Name) -> Duration:
    """Return a time of a constraint whose parameters are bound."""
    if isinstance(time, Name):
        raise TypeError(f"the parameter '{time.text}' is not bound")
    return time.time

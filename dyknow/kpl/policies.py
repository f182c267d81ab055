"""From the constraints of a policy, as written, to the policy they make, and back.

A synchronisation is followed by a state policy (Heintz 2009, definition 7.8.4), everything else
by a policy (definition 4.4.8). They share most constraints; what belongs to one of them alone is
refused in the other.
"""

from collections.abc import Iterable, Mapping
from typing import Any

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
    UseLinear,
    UseMostRecent,
)
from dyknow.streams import policy
from dyknow.streams.policy import ANY_CHANGE, ANY_UPDATE, Approximation, Change, Order, Policy
from dyknow.streams.state_policy import Occasion, Settling, StateApproximation, StatePolicy
from dyknow.time import Duration, TimePoint

__all__ = [
    "constraints_from_policy",
    "policy_from_constraints",
    "policy_of_states",
    "state_policy_from_constraints",
    "text_from_policy",
]

_KINDS: dict[type, str] = {
    NoApproximation: "approximation",
    UseMostRecent: "approximation",
    UseLinear: "approximation",
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
_OCCASIONS: dict[type, Occasion] = {
    AnyUpdate: Occasion.ANY_UPDATE,
    AnyChange: Occasion.ANY_CHANGE,
    AllUpdates: Occasion.ALL_UPDATES,
    SampleEvery: Occasion.SAMPLED,
    SampleEveryCommonPeriod: Occasion.SAMPLED,
}
_STATE_APPROXIMATIONS: dict[type, StateApproximation] = {
    NoApproximation: StateApproximation.NONE,
    UseMostRecent: StateApproximation.MOST_RECENT,
    UseLinear: StateApproximation.LINEAR,
}


def policy_from_constraints(constraints: Iterable[Constraint]) -> Policy:
    """Return the policy of a stream whose parameters are bound.

    Raises:
        ValueError: No stream can keep the constraints, there are two of one kind, or one is for
            synchronisations.
    """
    given = _by_kind(constraints)
    if unfit := [each for each in given.values() if isinstance(each, _OF_STATES_ALONE)]:
        raise ValueError(f"'{text_from(unfit[0])}' is for sync(...) alone")
    start, end = _duration(given.get("duration"))
    is_approximated = isinstance(given.get("approximation"), UseMostRecent)
    return Policy(
        approximation=Approximation.MOST_RECENT if is_approximated else Approximation.NONE,
        change=_change(given.get("change")),
        max_delay=_max_delay(given.get("delay")),
        start=start,
        end=end,
        order=_ORDERS.get(type(given.get("order")), Order.ANY),
    )


def state_policy_from_constraints(constraints: Iterable[Constraint]) -> StatePolicy:
    """Return the state policy of a synchronisation whose parameters are bound.

    Raises:
        ValueError: No stream of states can keep the constraints, there are two of one kind, or
            one is not for synchronisations.
    """
    given = _by_kind(constraints)
    if order := given.get("order"):
        written = text_from(order)
        raise ValueError(f"'{written}' is not for sync(...): states come in strict order")
    start, end = _duration(given.get("duration"))
    change, patience = given.get("change"), given.get("delay before approximation")
    settings: dict[str, Any] = {
        "occasion": _OCCASIONS.get(type(change), Occasion.ANY_UPDATE),
        "period": _period_of_states(change),
        "start": start,
        "end": end,
        "max_delay": _max_delay(given.get("delay")),
        "approximation": _STATE_APPROXIMATIONS.get(
            type(given.get("approximation")), StateApproximation.NONE
        ),
    }
    if isinstance(patience, DelayBeforeApproximation):
        settings["delay_before_approximation"] = _finite(patience.delay)
    if "settling" in given:
        settings["settling"] = Settling.AT_MAX_DELAY
    if isinstance(capacity := given.get("capacity"), Capacity):
        settings["capacity"] = capacity.count
    return StatePolicy(**settings)


def policy_of_states(policy_: StatePolicy) -> Policy:
    """Return what a stream of states that are made under a state policy keeps."""
    change: Change = ANY_UPDATE
    if policy_.period is not None:
        change = policy.SampleEvery(policy_.period)
    return Policy(
        change=change,
        max_delay=policy_.max_delay,
        start=policy_.start,
        end=policy_.end,
        order=Order.STRICT,
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


def _by_kind(constraints: Iterable[Constraint]) -> Mapping[str, Constraint]:
    by_kind: dict[str, Constraint] = {}
    for constraint in constraints:
        kind = _KINDS[type(constraint)]
        if kind in by_kind:
            first, second = text_from(by_kind[kind]), text_from(constraint)
            raise ValueError(f"there are two {kind} constraints, '{first}' and '{second}'")
        by_kind[kind] = constraint
    return by_kind


def _change(constraint: Constraint | None) -> Change:
    match constraint:
        case SampleEvery(period, deviation, longest):
            return policy.SampleEvery(
                _finite(period),
                Duration(0) if deviation is None else _finite(deviation),
                None if longest is None else _finite(longest),
            )
        case AnyChange():
            return ANY_CHANGE
        case _:
            return ANY_UPDATE


def _period_of_states(constraint: Constraint | None) -> Duration | None:
    if not isinstance(constraint, SampleEvery):
        return None
    if constraint.deviation is not None or constraint.longest is not None:
        raise ValueError("states are sampled exactly: expected 'sample every' and a period alone")
    return _finite(constraint.period)


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

"""From a synchronisation, as written, to the unit that makes its states.

A synchronisation is followed by a state policy (Heintz 2009, definition 7.8.4), everything else
by a policy (definition 4.4.8). They share most constraints; what belongs to one of them alone is
refused in the other. `use latest` makes it one of the available joins, which wait for nothing;
all others are reproducible.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from dyknow.kpl.policies import by_kind, duration_from, finite, max_delay_from
from dyknow.kpl.printer import text_from
from dyknow.kpl.syntax import (
    AllUpdates,
    AnyChange,
    AnyUpdate,
    Capacity,
    Constraint,
    DelayBeforeApproximation,
    Label,
    NoApproximation,
    SampleEvery,
    SampleEveryCommonPeriod,
    StreamTerm,
    UseLatest,
    UseLinear,
    UseMostRecent,
)
from dyknow.streams import policy
from dyknow.streams.joining import Latest
from dyknow.streams.policy import Order, Policy
from dyknow.streams.process import Reactive
from dyknow.streams.sample import Sample
from dyknow.streams.selecting import Select
from dyknow.streams.state_policy import Occasion, Settling, StateApproximation, StatePolicy
from dyknow.streams.synchronisation import Synchronisation
from dyknow.time import Duration, TimePoint

__all__ = [
    "SelectOfStates",
    "field_names_of_states",
    "policy_of_states",
    "state_policy_from_constraints",
    "synchroniser",
]

_OCCASIONS: dict[type, Occasion] = {
    AnyUpdate: Occasion.ANY_UPDATE,
    AnyChange: Occasion.ANY_CHANGE,
    AllUpdates: Occasion.ALL_UPDATES,
    SampleEvery: Occasion.SAMPLED,
    SampleEveryCommonPeriod: Occasion.SAMPLED,
}
_APPROXIMATIONS: dict[type, StateApproximation] = {
    NoApproximation: StateApproximation.NONE,
    UseMostRecent: StateApproximation.MOST_RECENT,
    UseLinear: StateApproximation.LINEAR,
    UseLatest: StateApproximation.MOST_RECENT,
}


def synchroniser(
    names: Sequence[str], constraints: Iterable[Constraint], inputs: Sequence[Policy]
) -> Synchronisation | Latest:
    """Return the unit of a synchronisation.

    Args:
        names: What violations call the inputs.
        constraints: The state policy; its parameters are bound.
        inputs: What the input streams keep.

    Raises:
        ValueError: No stream of states can keep the constraints, or not with such inputs.
    """
    written = tuple(constraints)
    states = state_policy_from_constraints(written)
    if _takes_latest(written):
        return Latest(names, states)
    return Synchronisation(names, states, inputs)


def state_policy_from_constraints(constraints: Iterable[Constraint]) -> StatePolicy:
    """Return the state policy of a synchronisation whose parameters are bound.

    Raises:
        ValueError: No stream of states can keep the constraints, there are two of one kind, or
            one is not for synchronisations.
    """
    given = by_kind(constraints)
    if order := given.get("order"):
        written = text_from(order)
        raise ValueError(f"'{written}' is not for sync(...): the order of states is not to choose")
    start, end = duration_from(given.get("duration"))
    change, patience = given.get("change"), given.get("delay before approximation")
    settings: dict[str, Any] = {
        "occasion": _OCCASIONS.get(type(change), Occasion.ANY_UPDATE),
        "period": _period(change),
        "start": start,
        "end": end,
        "max_delay": max_delay_from(given.get("delay")),
        "approximation": _APPROXIMATIONS.get(
            type(given.get("approximation")), StateApproximation.NONE
        ),
    }
    if isinstance(patience, DelayBeforeApproximation):
        settings["delay_before_approximation"] = finite(patience.delay)
    if "settling" in given:
        settings["settling"] = Settling.AT_MAX_DELAY
    if isinstance(capacity := given.get("capacity"), Capacity):
        settings["capacity"] = capacity.count
    return StatePolicy(**settings)


def policy_of_states(constraints: Iterable[Constraint]) -> Policy:
    """Return what a stream of states keeps that is made under a state policy.

    Raises:
        ValueError: See `state_policy_from_constraints`.
    """
    written = tuple(constraints)
    states = state_policy_from_constraints(written)
    is_strict = states.is_sampled or not _takes_latest(written)
    return Policy(
        change=policy.ANY_UPDATE if states.period is None else policy.SampleEvery(states.period),
        max_delay=states.max_delay,
        start=states.start,
        end=states.end,
        order=Order.STRICT if is_strict else Order.MONOTONE,
    )


def field_names_of_states(streams: Sequence[StreamTerm]) -> tuple[str, ...]:
    """Return what the values of a state are called in a selection, in their order.

    The value of `speed[uav1]` is `speed`, or `speed_uav1` if another one has that feature too;
    that of a process without a label is called after its place, such as `input2`.
    """
    labels = [each.provider if isinstance(each.provider, Label) else None for each in streams]
    features = [label.feature.text for label in labels if label is not None]
    return tuple(
        f"input{number}" if label is None else _field_name(label, features)
        for number, label in enumerate(labels, start=1)
    )


class SelectOfStates(Reactive):
    """A selection whose fields are values of states, by name."""

    def __init__(self, names: Sequence[str], select: Select) -> None:
        self._names = tuple(names)
        self._select = select

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> tuple[Sample[Any], ...]:
        """Emit what is wanted of the new state."""
        (state,) = inputs
        value = dict(zip(self._names, state.value, strict=True))
        named = Sample(value, state.valid_time, state.available_time)
        return self._select.push(now, (named,))


def _takes_latest(constraints: Iterable[Constraint]) -> bool:
    return any(isinstance(each, UseLatest) for each in constraints)


def _field_name(label: Label, features: Sequence[str]) -> str:
    feature = label.feature.text
    if features.count(feature) == 1:
        return feature
    return "_".join([feature, *(each.text for each in label.objects)])


def _period(constraint: Constraint | None) -> Duration | None:
    if not isinstance(constraint, SampleEvery):
        return None
    if constraint.deviation is not None or constraint.longest is not None:
        raise ValueError("states are sampled exactly: expected 'sample every' and a period alone")
    return finite(constraint.period)

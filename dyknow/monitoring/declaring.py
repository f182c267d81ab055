"""What has to be declared in KPL for a formula, and from when on there are states for it."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from dyknow.errors import PolicyError, SpecificationError
from dyknow.kpl.build import application, compunit, label, stream, strmgen, term
from dyknow.kpl.members import label_from
from dyknow.kpl.names import descendants
from dyknow.kpl.parser import parse_policy, parse_value
from dyknow.kpl.states import policy_of_states, state_policy_from_constraints
from dyknow.kpl.syntax import (
    ANY_SORT,
    Constraint,
    Declaration,
    Endless,
    FromTo,
    GeneratorDeclaration,
    Name,
    Setting,
    StreamTerm,
    Synchronisation,
    Text,
    Time,
    To,
    Values,
)
from dyknow.runtime.generators import Label as GeneratorLabel
from dyknow.runtime.kernel import Kernel
from dyknow.source_text import Span
from dyknow.streams.policy import Order
from dyknow.streams.state_policy import StatePolicy
from dyknow.time import Duration, TimePoint

__all__ = [
    "UNIT",
    "VERDICTS",
    "Beginning",
    "beginning_of_states",
    "constraints_of_states",
    "declaration_of_states",
    "declaration_of_unit",
    "declarations_of_verdicts",
    "is_name",
]

UNIT = "EvaluateFormulas"
"""The symbol of the computational unit that makes verdicts out of states."""

VERDICTS = "verdicts"
"""The feature in the labels of streams of verdicts."""

_VERDICT_SORT = "verdict"


@dataclass(frozen=True)
class Beginning:
    """From when on streams are taken, and states are made of them.

    Attributes:
        streams: By label, the valid time of the first sample; with the next one if not there.
        states: The valid time from which on there are states; None to leave it to the streams.
    """

    streams: Mapping[str, TimePoint]
    states: TimePoint | None = None


def is_name(text: str) -> bool:
    """Return whether *text* can stand as an object in a label."""
    return parse_value(text) == Name(text)


def constraints_of_states(policy: str) -> tuple[Constraint, ...]:
    """Return the constraints of a state policy, as it is written after `with`.

    Raises:
        KPLSyntaxError: The text is no policy.
        PolicyError: No states can keep it, or formulas cannot be evaluated in such states.
        SpecificationError: There is a name in it.
    """
    constraints = parse_policy(policy, "<state policy>")
    for each in descendants(constraints):
        if isinstance(each, Name):
            raise SpecificationError(f"expected a time, found the name '{each.text}'", each.span)
    try:
        is_strict = policy_of_states(constraints).effective_order is Order.STRICT
    except ValueError as fault:
        raise PolicyError(str(fault), _span(constraints)) from None
    if not is_strict:
        message = "formulas need one state for each valid time; 'use latest' may make several"
        raise PolicyError(message, _span(constraints))
    return constraints


def beginning_of_states(
    streams: Collection[str], constraints: Sequence[Constraint], kernel: Kernel
) -> Beginning:
    """Return how states begin so that a stream that seldom speaks does not hold them up.

    Where values may be approximated, what streams have said before counts: they are taken from
    their newest sample on. If all have spoken, there are states from now on, and at regular times
    those times follow on the newest sample of all.
    """
    policy = state_policy_from_constraints(constraints)
    if not policy.is_approximated:
        return Beginning({})
    newest = {label: time for label in streams if (time := _newest(label, kernel)) is not None}
    if policy.start is not None or len(newest) < len(streams):
        return Beginning(newest)
    return Beginning(newest, _first_state(policy, max(newest.values()), kernel.now))


def declaration_of_unit() -> Declaration:
    """Declare the computational unit that makes verdicts out of states."""
    return compunit(_VERDICT_SORT, UNIT, ANY_SORT)


def declaration_of_states(
    name: str, streams: Sequence[str], constraints: Sequence[Constraint], beginning: Beginning
) -> Declaration:
    """Declare the stream of states that are made of some streams."""
    terms = tuple(_term(each, beginning.streams.get(each)) for each in streams)
    kept = _beginning_at(beginning.states, constraints)
    span = _span(constraints)
    return GeneratorDeclaration(label(name), Synchronisation(terms), kept, span=span)


def declarations_of_verdicts(
    name: str, states: str, formulas: Mapping[str, str]
) -> tuple[Declaration, ...]:
    """Declare the stream of verdicts on formulas, and an output without which it is not made."""
    written = [text if each == name else f"{each}: {text}" for each, text in formulas.items()]
    settings = [
        Setting("name", Text(name)),
        Setting("formulas", Values(tuple(map(Text, written)))),
    ]
    verdicts = label(VERDICTS, name)
    unit = application(UNIT, [term(label(states))], settings)
    return strmgen(verdicts, unit), stream(verdicts, term(verdicts))


def _newest(name: str, kernel: Kernel) -> TimePoint | None:
    """Return the valid time of the newest sample of a generator from which it can be taken."""
    process = kernel.processes.get(GeneratorLabel(name))
    if process is None or not process.generator.size:
        return None
    newest = process.generator.latest_valid().valid_time
    return newest if newest > process.generator.lost_until else None


def _first_state(policy: StatePolicy, newest: TimePoint, now: TimePoint) -> TimePoint | None:
    if not policy.is_sampled:
        return now
    if policy.period is None:
        return None
    steps = max(0, -((newest - now) // policy.period))
    return TimePoint(newest + steps * policy.period)


def _term(name: str, start: TimePoint | None) -> StreamTerm:
    provider = label_from(name)
    return term(provider) if start is None else term(provider, _from(start))


def _beginning_at(
    start: TimePoint | None, constraints: Sequence[Constraint]
) -> tuple[Constraint, ...]:
    if start is None:
        return tuple(constraints)
    others = [each for each in constraints if not isinstance(each, To)]
    (end,) = [each.end for each in constraints if isinstance(each, To)] or [Endless()]
    return (*others, replace(_from(start), end=end))


def _from(start: TimePoint) -> FromTo:
    return FromTo(Time(Duration(start)))


def _span(constraints: Sequence[Constraint]) -> Span:
    return constraints[0].span if constraints else Synchronisation(()).span

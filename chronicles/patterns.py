"""Event types turned into functions that match events.

Each event type is taken apart once, when its chronicle is loaded. What is left to do for an
event is one call of a function made for that event type.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from operator import itemgetter

from chronicles.events import Event
from chronicles.syntax import EventType, Parameter, Star, Value, Variable

__all__ = ["Filter", "Pattern", "Values", "pattern_from_event_type", "projection"]

Values = tuple[str, ...]
"""The values of some variables, in an order that is known from elsewhere."""


_Row = tuple[str | None, ...]


@dataclass(frozen=True, slots=True)
class Filter:
    """A condition on the star variables of an event type.

    Attributes:
        names: The variables that it looks at.
        allows: Whether it allows their values, in that order.
    """

    names: tuple[str, ...]
    allows: Callable[[Sequence[str | None]], bool]


class Pattern:
    """An event type, ready to be matched.

    Attributes:
        event_type: What it was made from.
        variables: Names of its `?` variables, each once, in the order of the text.
        to_value: The constant value that the attribute must have afterwards, if there is one.
        constants: The arguments that must have a certain value, by their places.
        loose: Whether different events may match with the same values of the variables.
        match: Returns the values of the variables if an event of the right name is of this
            type, and None otherwise. A named variable does not match an unknown value.
    """

    __slots__ = ("constants", "event_type", "loose", "match", "to_value", "variables")

    def __init__(
        self,
        event_type: EventType,
        variables: tuple[str, ...],
        match: Callable[[Event], Values | None],
    ) -> None:
        change = event_type.change
        parameters = _parameters(event_type)
        self.event_type = event_type
        self.variables = variables
        self.match = match
        self.to_value = change.after.text if change and isinstance(change.after, Value) else None
        arguments = enumerate(event_type.arguments)
        self.constants = {i: a.text for i, a in arguments if isinstance(a, Value)}
        is_exact = all(isinstance(p, Variable | Value) for p in parameters)
        self.loose = change is None or not is_exact


def pattern_from_event_type(event_type: EventType, filters: Sequence[Filter] = ()) -> Pattern:
    """Return the pattern of *event_type*, for events that also pass *filters*."""
    names = [p.name for p in _parameters(event_type) if isinstance(p, Variable)]
    variables = tuple(dict.fromkeys(names))
    n_arguments = len(event_type.arguments)
    arguments_alone = len(variables) == n_arguments and all(
        isinstance(p, Variable) for p in event_type.arguments
    )
    if not arguments_alone or variables != tuple(names):
        match = _general_match(event_type, variables)
    elif event_type.change is None:
        match = _message_match(n_arguments)
    else:
        match = _change_match(n_arguments, event_type.change.before, event_type.change.after)
    if filters:
        match = _filtered(match, event_type, filters)
    return Pattern(event_type, variables, match)


def projection(source: Sequence[str], target: Sequence[str]) -> Callable[[Values], Values] | None:
    """Return a function from the values of *source* to those of *target*; None if the same."""
    places = [source.index(name) for name in target]
    if places == list(range(len(source))):
        return None
    return _picker(places)  # type: ignore[return-value]  # what is taken from values are values


def _picker(places: Sequence[int]) -> Callable[[_Row], _Row]:
    """Return a function that takes the entries at *places* out of a row."""
    if len(places) > 1:
        return itemgetter(*places)
    if not places:
        return lambda _row: ()
    (place,) = places
    return lambda row: (row[place],)


def _parameters(event_type: EventType) -> tuple[Parameter, ...]:
    change = event_type.change
    return (*event_type.arguments, *((change.before, change.after) if change else ()))


def _message_match(n_arguments: int) -> Callable[[Event], Values | None]:
    """Match a message all of whose arguments are different variables."""

    def match(event: Event) -> Values | None:
        return event.arguments if len(event.arguments) == n_arguments else None

    return match


def _change_match(
    n_arguments: int, before: Parameter, after: Parameter
) -> Callable[[Event], Values | None]:
    """Match a change with different variables as arguments and none among the values."""
    from_value = before.text if isinstance(before, Value) else None
    to_value = after.text if isinstance(after, Value) else None

    def match_value(event: Event) -> Values | None:
        is_it = event.to_value == to_value and len(event.arguments) == n_arguments
        return event.arguments if is_it else None

    def match(event: Event) -> Values | None:
        if to_value is not None:
            if event.to_value != to_value:
                return None
        elif event.to_value is None and event.from_value is None:
            return None
        if from_value is not None and event.from_value != from_value:
            return None
        return event.arguments if len(event.arguments) == n_arguments else None

    return match_value if from_value is None and to_value is not None else match


def _general_match(
    event_type: EventType, variables: tuple[str, ...]
) -> Callable[[Event], Values | None]:
    """Match anything: constants, repeated variables, variables as values."""
    parameters = _parameters(event_type)
    n_arguments = len(event_type.arguments)
    is_message = event_type.change is None
    constants = tuple((i, p.text) for i, p in enumerate(parameters) if isinstance(p, Value))
    at: dict[str, list[int]] = {name: [] for name in variables}
    for i, parameter in enumerate(parameters):
        if isinstance(parameter, Variable):
            at[parameter.name].append(i)
    pick = _picker([places[0] for places in at.values()])
    same = tuple((places[0], other) for places in at.values() for other in places[1:])
    unconditional = not constants and not same

    def fits(row: _Row) -> bool:
        return all(row[place] == text for place, text in constants) and all(
            row[place] == row[other] for place, other in same
        )

    def match(event: Event) -> Values | None:
        before, after = event.from_value, event.to_value
        if len(event.arguments) != n_arguments:
            return None
        if before is None and after is None and not is_message:
            return None
        row = (*event.arguments, before, after)
        if not (unconditional or fits(row)):
            return None
        values = pick(row)
        return None if None in values else values  # type: ignore[return-value]  # just checked

    return match


def _filtered(
    match: Callable[[Event], Values | None], event_type: EventType, filters: Sequence[Filter]
) -> Callable[[Event], Values | None]:
    """Match what *match* does if it passes *filters*, whichever place a star stands at."""
    names = [p.name if isinstance(p, Variable | Star) else "" for p in _parameters(event_type)]
    tests: list[tuple[Callable[[_Row], _Row], Callable[[Sequence[str | None]], bool]]] = []
    for each in filters:
        places = [[i for i, name in enumerate(names) if name == wanted] for wanted in each.names]
        tests.extend((_picker(chosen), each.allows) for chosen in product(*places))

    def matches(event: Event) -> Values | None:
        values = match(event)
        if values is None:
            return None
        row = (*event.arguments, event.from_value, event.to_value)
        return values if all(allows(pick(row)) for pick, allows in tests) else None

    return matches

"""How the events of a recognition met the predicates of its chronicle."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

from chronicles.conditions import holds, variables_in
from chronicles.constraints import floor_to_instant
from chronicles.events import Event, Recognition, json_from_event, json_from_time
from chronicles.expansion import Expansion, expand
from chronicles.printer import text_of
from chronicles.syntax import (
    Change,
    Chronicle,
    ChronicleFile,
    Comparison,
    Condition,
    Domain,
    EventAt,
    EventType,
    NoEvent,
    Occurs,
    Parameter,
    Star,
    Value,
    Variable,
    Within,
    names_in,
)
from traffic.errors import ExplanationError
from traffic.explaining.constraining import condition_explained, constraint_explained
from traffic.explaining.explanation import Constraint, Counted, FactEvent

__all__ = ["Match", "fact_of", "match_of", "named_in"]

_MOST_TOLD = 20


@dataclass(frozen=True)
class Match:
    """A recognition put beside its chronicle.

    Attributes:
        chronicle: The chronicle.
        expansion: What it says, with everything put in that it refers to.
        domains: The named domains of its file.
        values: The value of each variable.
        times: When each instant was, nanoseconds.
        events: The events, one for each `event` predicate in the order of the expansion.
    """

    chronicle: Chronicle
    expansion: Expansion
    domains: Mapping[str, Domain]
    values: Mapping[str, str]
    times: Mapping[str, int]
    events: Sequence[Event]

    def predicates_met(self) -> list[tuple[Event, list[EventAt]]]:
        """Return each event once, with the predicates that it met, in order of time."""
        met: dict[tuple[object, ...], tuple[Event, list[EventAt]]] = {}
        for event, predicate in zip(self.events, self.expansion.events, strict=True):
            met.setdefault(_key(event), (event, []))[1].append(predicate)
        return sorted(met.values(), key=lambda pair: pair[0].time)

    def constraints(self) -> Iterator[Constraint]:
        """Yield the constraints on times and values, and what they came to."""
        for statement in self.expansion.statements:
            match statement:
                case Comparison() | Within():
                    yield constraint_explained(statement, self.times)
                case _ if isinstance(statement, Condition):
                    told = condition_explained(statement, self.values, self.domains)
                    if told is not None:
                        yield told
                case _:
                    pass

    def counters(self) -> list[NoEvent | Occurs]:
        """Return the predicates that count events."""
        return [s for s in self.expansion.statements if isinstance(s, NoEvent | Occurs)]

    def counted(self, predicate: NoEvent | Occurs, events: Iterable[Event]) -> Counted:
        """Return what *predicate* counted among *events*, which hold all of its attribute."""
        begin = self.times[predicate.begin.name] + predicate.begin.offset
        end = self.times[predicate.end.name] + predicate.end.offset
        found = {
            _key(event): event
            for event in events
            if begin <= floor_to_instant(event.time) < end
            and self.fits(event, predicate.event_type)
        }
        least, most = (
            (0, 0) if isinstance(predicate, NoEvent) else (predicate.least, predicate.most)
        )
        in_order = sorted(found.values(), key=lambda event: event.time)
        return Counted(
            text=self.text_with_values(predicate),
            attribute=predicate.event_type.name,
            arguments=self._arguments(predicate.event_type),
            begin=json_from_time(begin),
            end=json_from_time(end),
            least=least,
            most=most,
            count=len(found),
            holds=least <= len(found) and (most is None or len(found) <= most),
            events=[fact_of(event) for event in in_order[:_MOST_TOLD]],
        )

    def fits(self, event: Event, event_type: EventType) -> bool:
        """Return whether *event* is of a type, whose `?` variables have their values."""
        bound = _bound(event, event_type, self.values)
        return bound is not None and self._stars_hold(event, event_type)

    def text_with_values(self, predicate: EventAt | NoEvent | Occurs) -> str:
        """Return the text of a predicate with the values of its variables in their places."""
        event_type = predicate.event_type
        change = event_type.change
        told = replace(
            event_type,
            arguments=tuple(map(self._told, event_type.arguments)),
            change=None
            if change is None
            else Change(change.span, self._told(change.before), self._told(change.after)),
        )
        return text_of(replace(predicate, event_type=told))

    def _arguments(self, event_type: EventType) -> list[str] | None:
        """Return what events of a type are about; None if that may differ among them."""
        told = [self._told(parameter) for parameter in event_type.arguments]
        known = [each.text for each in told if isinstance(each, Value)]
        return known if len(known) == len(told) else None

    def _told(self, parameter: Parameter) -> Parameter:
        if isinstance(parameter, Variable) and parameter.name in self.values:
            return Value(parameter.span, self.values[parameter.name])
        return parameter

    def _stars_hold(self, event: Event, event_type: EventType) -> bool:
        """Return whether the conditions on `*` variables hold for *event*."""
        stars: dict[str, list[str]] = {}
        for parameter, value in _pairs(event, event_type):
            if isinstance(parameter, Star):
                stars.setdefault(parameter.name, []).append(value or "")
        own = names_in(event_type)
        for condition in self.expansion.statements:
            if not isinstance(condition, Condition):
                continue
            names = {each.name for each in variables_in(condition)}
            if stars.keys() & names and names <= own:
                for chosen in product(*stars.values()):
                    values = {**self.values, **dict(zip(stars, chosen, strict=True))}
                    if not holds(condition, values, self.domains):
                        return False
        return True


def match_of(recognition: Recognition, chronicle: Chronicle, file: ChronicleFile) -> Match:
    """Put *recognition* beside its *chronicle*, which stands in *file*.

    Raises:
        ExplanationError: The events are not those that the chronicle asks for.
    """
    expansion = expand(chronicle, file)
    predicates = expansion.events
    if len(predicates) != len(recognition.events):
        raise ExplanationError(
            f"'{chronicle.name}' asks for {len(predicates)} events, and the recognition has "
            f"{len(recognition.events)}: its chronicle has been changed"
        )
    values: dict[str, str] = {}
    times: dict[str, int] = {}
    for event, predicate in zip(recognition.events, predicates, strict=True):
        bound = _bound(event, predicate.event_type, values)
        if bound is None:
            raise ExplanationError(
                f"an event of the recognition does not meet {text_of(predicate)}: "
                "its chronicle has been changed"
            )
        values = bound
        times[predicate.instant] = recognition.instants.get(
            predicate.instant, floor_to_instant(event.time)
        )
    for name, extreme in expansion.extremes.items():
        moments = [times[member] for member in extreme.members]
        times[name] = max(moments) if extreme.is_end else min(moments)
    return Match(
        chronicle=chronicle,
        expansion=expansion,
        domains={each.name: each.domain for each in file.domains},
        values=values,
        times={**recognition.instants, **times},
        events=recognition.events,
    )


def fact_of(event: Event) -> FactEvent:
    """Return *event* as an explanation tells it."""
    told = json_from_event(event)
    return FactEvent(
        time=told["t"],
        attribute=event.attribute,
        arguments=list(event.arguments),
        before=event.from_value,
        after=event.to_value,
    )


def named_in(match: Match, symbol: str) -> list[str]:
    """Return the variables of which *symbol* is the value."""
    return [name for name, value in match.values.items() if value == symbol]


def _bound(event: Event, event_type: EventType, known: Mapping[str, str]) -> dict[str, str] | None:
    """Return the values of variables if *event* is of a type, given those *known*."""
    is_message = event.from_value is None and event.to_value is None
    if event.attribute != event_type.name or len(event.arguments) != len(event_type.arguments):
        return None
    if event_type.change is not None and is_message:
        return None
    values = dict(known)
    for parameter, value in _pairs(event, event_type):
        if isinstance(parameter, Value) and value != parameter.text:
            return None
        if isinstance(parameter, Variable) and (
            value is None or values.setdefault(parameter.name, value) != value
        ):
            return None
    return values


def _pairs(event: Event, event_type: EventType) -> Iterator[tuple[Parameter, str | None]]:
    change = event_type.change
    parameters = (*event_type.arguments, *((change.before, change.after) if change else ()))
    found = (*event.arguments, *((event.from_value, event.to_value) if change else ()))
    yield from zip(parameters, found, strict=True)


def _key(event: Event) -> tuple[object, ...]:
    return event.time, event.attribute, event.arguments, event.from_value, event.to_value

"""Which handlers an event goes to: those that may do something with it, out of many.

Handlers are found by the name of the event and its value after the change. Where ten thousand
chronicles ask for the same attribute, each for an object of its own, they are found by that
object as well.
"""

from collections import Counter
from collections.abc import Iterable, Sequence

from chronicles.events import Event
from chronicles.matching import Handler, Matcher
from chronicles.patterns import Pattern

__all__ = ["Routes", "route"]

Routes = dict[str, dict[str | None, tuple[Handler, ...]]]
"""Handlers by the name of an event and its value, those for any other value at None."""

_Entry = tuple[Pattern, Handler]

_MANY = 4
"""From how many handlers for certain objects on they are found by the object."""


def route(matchers: Iterable[Matcher]) -> Routes:
    """Return the handlers of *matchers*; an event counts before it fills a slot."""
    entries: dict[str, tuple[list[_Entry], list[_Entry]]] = {}
    for matcher in matchers:
        for phase, found in enumerate((matcher.counting, matcher.filling)):
            for entry in found:
                name = entry[0].event_type.name
                entries.setdefault(name, ([], []))[phase].append(entry)
    return {name: _by_value(*phases) for name, phases in entries.items()}


def _by_value(
    counting: Sequence[_Entry], filling: Sequence[_Entry]
) -> dict[str | None, tuple[Handler, ...]]:
    """Return the handlers by value: those for one value and those for any, or these alone."""
    counting_by, filling_by = _grouped(counting), _grouped(filling)
    for_any = [_together(_handlers(by.get(None, []))) for by in (counting_by, filling_by)]
    return {
        value: (
            *(_handlers(counting_by.get(value, [])) if value is not None else ()),
            *for_any[0],
            *(_handlers(filling_by.get(value, [])) if value is not None else ()),
            *for_any[1],
        )
        for value in {*counting_by, *filling_by, None}
    }


def _grouped(entries: Sequence[_Entry]) -> dict[str | None, list[_Entry]]:
    found: dict[str | None, list[_Entry]] = {}
    for entry in entries:
        found.setdefault(entry[0].to_value, []).append(entry)
    return found


def _together(handlers: list[Handler]) -> list[Handler]:
    """Return handlers that do the same as *handlers* and are few."""
    if len(handlers) < _MANY:
        return handlers

    def handle(event: Event, now: int) -> None:
        for each in handlers:
            each(event, now)

    return [handle]


def _handlers(entries: Sequence[_Entry]) -> list[Handler]:
    """Return the handlers, many for certain objects behind one that knows the object."""
    places = Counter(place for pattern, _ in entries for place in pattern.constants)
    if not places or places.most_common(1)[0][1] < _MANY:
        return [handle for _, handle in entries]
    place = places.most_common(1)[0][0]
    certain: dict[str, list[_Entry]] = {}
    others = []
    for entry in entries:
        value = entry[0].constants.get(place)
        if value is None:
            others.append(entry)
        else:
            certain.setdefault(value, []).append(entry)
    table = {value: tuple(handle for _, handle in found) for value, found in certain.items()}
    return [_choice(place, table), *_handlers(others)]


def _choice(place: int, table: dict[str, tuple[Handler, ...]]) -> Handler:
    def choose(event: Event, now: int) -> None:
        if place < len(event.arguments):
            for handle in table.get(event.arguments[place], ()):
                handle(event, now)

    return choose

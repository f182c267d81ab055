"""Partial instances and the end of the events as plain data; times are milliseconds."""

from typing import Any

from chronicles.events import json_from_event, json_from_time
from chronicles.prospects import Awaited, PartialInstance
from traffic.recognising.following import Outcome

__all__ = ["document_of_end", "document_of_instance"]


def document_of_instance(instance: PartialInstance) -> dict[str, Any]:
    """Return a partial instance: what it has seen, and what it awaits."""
    times = instance.instants.items()
    return {
        "chronicle": instance.chronicle,
        "arguments": dict(instance.values),
        "times": {name: json_from_time(time) for name, time in times},
        "events": [json_from_event(event) for event in instance.events],
        "awaits": [_document_of_awaited(awaited) for awaited in instance.awaited],
    }


def document_of_end(outcome: Outcome) -> dict[str, Any]:
    """Return what is to be said at the end of the events, apart from instances."""
    return {
        "events": outcome.n_events,
        "clock": None if outcome.clock is None else json_from_time(outcome.clock),
        "remarks": {kind.value: n for kind, n in outcome.remarks.items()},
        "given_up": dict(outcome.given_up),
    }


def _document_of_awaited(awaited: Awaited) -> dict[str, Any]:
    return {
        "what": awaited.predicate,
        "from": json_from_time(awaited.earliest),
        "until": None if awaited.latest is None else json_from_time(awaited.latest),
    }

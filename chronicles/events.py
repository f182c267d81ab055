"""What the recogniser takes in and gives out, and the JSON forms of both.

Times are nanoseconds here and milliseconds in JSON, a whole number where they are whole.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from dyknow.time import MILLISECOND, TimePoint, milliseconds

__all__ = [
    "LAST_TIME",
    "Event",
    "Recognition",
    "event_from_json",
    "event_from_recognition",
    "json_from_event",
    "json_from_recognition",
    "json_from_time",
    "recognition_from_json",
    "text_from_value",
]

LAST_TIME: Final = (1 << 63) - 1
"""The last time, and the first with a minus before it: nanoseconds have 64 bits."""


@dataclass(slots=True)
class Event:
    """A change of an attribute at one time-point, or a message; immutable by convention.

    Attributes:
        attribute: Name of the attribute or message.
        arguments: What it is about.
        from_value: The value before the change; None while it was unknown.
        to_value: The value after the change; None if it is no longer known. Both are None for a
            message.
        time: When it happened.
    """

    attribute: str
    arguments: tuple[str, ...]
    from_value: str | None
    to_value: str | None
    time: TimePoint


@dataclass(slots=True)
class Recognition:
    """A partial instance that became complete; immutable by convention.

    Attributes:
        chronicle: Name of the chronicle.
        arguments: Its parameters without their mark, in the order of the model, with values.
        instants: The instants of its events, in the order of the model, with times.
        events: The events that made it, one for each `event` of the model, in its order.
        begin: When what a person would count began: the first instant of the `report` statement,
            or else the earliest of all.
        end: When it ended: the second instant of the `report` statement, or else the latest.
        recognised_at: From when on nothing could take it back.
    """

    chronicle: str
    arguments: dict[str, str]
    instants: dict[str, TimePoint]
    events: tuple[Event, ...]
    begin: TimePoint
    end: TimePoint
    recognised_at: TimePoint


def event_from_json(document: Mapping[str, Any]) -> Event:
    """Return the event of one JSON document.

    Raises:
        ValueError: The document is no event; the message says what was expected.
    """
    time = document.get("t")
    if isinstance(time, bool) or not isinstance(time, int | float):
        raise ValueError(f"expected a number of milliseconds as 't', found {time!r}")  # noqa: TRY004
    kinds = [kind for kind in ("attribute", "message") if kind in document]
    if len(kinds) != 1:
        raise ValueError(f"expected either 'attribute' or 'message', found {kinds or 'none'}")
    is_message = kinds == ["message"]
    return Event(
        attribute=_text(document, kinds[0]),
        arguments=_arguments(document),
        from_value=None if is_message else _value(document.get("from"), "from"),
        to_value=None if is_message else _text(document, "to"),
        time=_time(time),
    )


def event_from_recognition(recognition: Recognition) -> Event:
    """Return the event that *recognition* is for other chronicles.

    It is named after the chronicle, has its arguments, happens when it was recognised, and has
    its beginning and its end, in milliseconds, as the values before and after.
    """
    return Event(
        attribute=recognition.chronicle,
        arguments=tuple(recognition.arguments.values()),
        from_value=str(json_from_time(recognition.begin)),
        to_value=str(json_from_time(recognition.end)),
        time=recognition.recognised_at,
    )


def json_from_event(event: Event) -> dict[str, Any]:
    """Return the JSON document of *event*."""
    document: dict[str, Any] = {"t": json_from_time(event.time)}
    if event.from_value is None and event.to_value is None:
        return {**document, "message": event.attribute, "arguments": list(event.arguments)}
    return {
        **document,
        "attribute": event.attribute,
        "arguments": list(event.arguments),
        "from": event.from_value,
        "to": event.to_value,
    }


def json_from_recognition(recognition: Recognition) -> dict[str, Any]:
    """Return the JSON document of *recognition*."""
    times = recognition.instants.items()
    return {
        "chronicle": recognition.chronicle,
        "arguments": dict(recognition.arguments),
        "times": {name: json_from_time(time) for name, time in times},
        "begin": json_from_time(recognition.begin),
        "end": json_from_time(recognition.end),
        "recognised_at": json_from_time(recognition.recognised_at),
        "events": [json_from_event(event) for event in recognition.events],
    }


def recognition_from_json(document: Mapping[str, Any]) -> Recognition:
    """Return the recognition of a document that `json_from_recognition` made."""
    return Recognition(
        chronicle=document["chronicle"],
        arguments=dict(document["arguments"]),
        instants={name: TimePoint(milliseconds(t)) for name, t in document["times"].items()},
        events=tuple(event_from_json(event) for event in document["events"]),
        begin=TimePoint(milliseconds(document["begin"])),
        end=TimePoint(milliseconds(document["end"])),
        recognised_at=TimePoint(milliseconds(document["recognised_at"])),
    )


def json_from_time(time: int) -> int | float:
    """Return *time* in milliseconds, as a whole number where it is one."""
    whole, rest = divmod(time, MILLISECOND)
    return time / MILLISECOND if rest else whole


def _time(amount: float) -> TimePoint:
    if abs(amount) <= LAST_TIME / MILLISECOND:
        return TimePoint(milliseconds(amount))
    raise ValueError(f"expected a time within 292 years of time zero as 't', found {amount!r}")


def _text(document: Mapping[str, Any], key: str) -> str:
    value = _value(document.get(key), key)
    if value is None:
        raise ValueError(f"expected a value for '{key}', found none")
    return value


def _arguments(document: Mapping[str, Any]) -> tuple[str, ...]:
    arguments = document.get("arguments", [])
    if not isinstance(arguments, list):
        raise ValueError(f"expected a list as 'arguments', found {arguments!r}")  # noqa: TRY004
    return tuple(_text({"arguments": argument}, "arguments") for argument in arguments)


def text_from_value(value: object) -> str | None:
    """Return a value as chronicles write it, `true` for True, digits for a number, or None."""
    match value:
        case str():
            return value
        case bool():
            return str(value).lower()
        case int() | float():
            return str(value)
        case _:
            return None


def _value(value: object, key: str) -> str | None:
    text = text_from_value(value)
    if text is None and value is not None:
        message = f"expected a text, a number or a truth value as '{key}', found {value!r}"
        raise ValueError(message)
    return text

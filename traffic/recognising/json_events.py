"""Events as lines of JSON.

`{"t": 5, "attribute": "behind", "arguments": ["car1", "car2"], "from": "false", "to": "true"}` or
`{"t": 5, "message": "A", "arguments": []}`. Other entries are not looked at, but a name that
stands twice in an object and a number that is not finite are faults wherever they are.
"""

from collections.abc import Iterator
from typing import Any

from pydantic_core import from_json

from chronicles.events import Event, text_from_value
from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import LineError
from traffic.reading.json_lines import columns_in, forbid_repetition, refuse
from traffic.reading.lines import Lines
from traffic.reading.times import LATEST, described, time_from

__all__ = ["JsonEvents"]

_LATEST_WHOLE = LATEST // MILLISECOND
_ALL_TEXTS = frozenset({str})
_KINDS = ("attribute", "message")


class JsonEvents:
    """Reads events from lines of JSON; empty lines are passed over."""

    def __init__(self, lines: Lines) -> None:
        self._lines = lines

    def __iter__(self) -> Iterator[Event]:
        """Yield the events.

        Raises:
            LineError: Something is wrong with one.
        """
        all_texts, none, latest = _ALL_TEXTS, (), _LATEST_WHOLE
        for line in self._lines:
            try:
                document = from_json(line, allow_inf_nan=False)
            except ValueError as error:
                if line.strip():
                    refuse(self._lines, error, "event")
                continue
            if type(document) is not dict:
                raise LineError(self._lines.place(1), "an object", described(document))
            if line.count(b":") != len(document):
                forbid_repetition(self._lines)
            get = document.get
            t, name, before, after = get("t"), get("attribute"), get("from"), get("to")
            arguments = get("arguments", none)
            if (
                type(t) is int
                and -latest <= t <= latest
                and type(name) is str
                and type(after) is str
                and (before is None or type(before) is str)
                and type(arguments) is list
                and all_texts.issuperset(map(type, arguments))
                and "message" not in document
            ):
                time = TimePoint(t * MILLISECOND)
                yield Event(name, tuple(arguments), before, after, time)
            else:
                yield self._event(document)

    def place(self) -> str:
        """Return the place of the present event."""
        return self._lines.place()

    def _event(self, document: dict[str, Any]) -> Event:
        """Return the event that a document is about, whichever way it is written."""
        kinds = [kind for kind in _KINDS if kind in document]
        if len(kinds) != 1:
            found = "both" if kinds else "neither"
            raise LineError(self._lines.place(1), "either 'attribute' or 'message'", found)
        (kind,) = kinds
        name = document[kind]
        if type(name) is not str or not name:
            raise self._unfit(kind, "a name", name)
        before = after = None
        if kind == "attribute":
            before, after = self._value(document, "from"), self._value(document, "to")
            if before is None and after is None:
                expected = "'to', the value after the change"
                raise LineError(
                    self._lines.place(columns_in(self._lines).get("to", 1)), expected, "none"
                )
        return Event(name, self._arguments(document), before, after, self._time(document))

    def _time(self, document: dict[str, Any]) -> TimePoint:
        if "t" not in document:
            raise LineError(self._lines.place(1), "'t', a time", "none")
        t = document["t"]
        if isinstance(t, bool) or not isinstance(t, int | float):
            raise self._unfit("t", "a number of milliseconds", t)
        return TimePoint(time_from(t, lambda: self._place_of("t")))

    def _arguments(self, document: dict[str, Any]) -> tuple[str, ...]:
        arguments = document.get("arguments")
        if arguments is None:
            return ()
        if not isinstance(arguments, list):
            raise self._unfit("arguments", "an array", arguments)
        found = [text_from_value(argument) for argument in arguments]
        for argument, text in zip(arguments, found, strict=True):
            if text is None:
                raise self._unfit("arguments", "texts, numbers or booleans in the array", argument)
        return tuple(text for text in found if text is not None)

    def _value(self, document: dict[str, Any], key: str) -> str | None:
        value = document.get(key)
        text = text_from_value(value)
        if text is None and value is not None:
            raise self._unfit(key, "a text, a number or a boolean", value)
        return text

    def _unfit(self, key: str, expected: str, value: object) -> LineError:
        return LineError(self._place_of(key), f"{expected} as '{key}'", described(value))

    def _place_of(self, key: str) -> str:
        return self._lines.place(columns_in(self._lines).get(key))

r"""States as lines of JSON: `{"t": 1000, "values": {"p": true, "speed[uav1]": 29.7}}`.

Of each line only `t` and `values` are looked at, and of the values only those that the formula
needs; but a name that stands twice in an object, a value that is an array or an object, and a
number that is not finite are faults wherever they are.
"""

from collections.abc import Collection, Iterator, Mapping
from typing import Any, NoReturn

from pydantic_core import from_json

from dyknow.time import MILLISECOND, TimePoint
from traffic.errors import LineError
from traffic.monitoring.states import (
    check_order,
    match_features,
    missing_feature,
    printed_feature,
)
from traffic.reading.json_lines import columns_in, forbid_repetition, refuse
from traffic.reading.lines import Lines
from traffic.reading.times import BEFORE_ALL, LATEST, described, time_from

__all__ = ["JsonStates"]

_INFINITE = (float("inf"), float("-inf"))
_UNFIT = frozenset({*_INFINITE, None})


class JsonStates:
    """Reads states from lines of JSON; empty lines are passed over."""

    def __init__(self, lines: Lines, terms: Collection[str]) -> None:
        """Read from *lines* the features with the printed *terms*."""
        self._lines = lines
        self._terms = frozenset(terms)
        self._keys: dict[str, str] = {}
        self._is_as_printed = False

    @property
    def name(self) -> str:
        """How messages refer to what is read."""
        return self._lines.name

    def __iter__(self) -> Iterator[tuple[TimePoint, Mapping[str, Any]]]:
        """Yield time and features of each state.

        Raises:
            LineError: There is no state, or something is wrong with one.
        """
        last = BEFORE_ALL
        for line in self._lines:
            try:
                document = from_json(line, allow_inf_nan=False)
            except ValueError as error:
                if line.strip():
                    refuse(self._lines, error, "state")
                continue
            now, values = self._parts(document, line)
            if now <= last:
                check_order(last, now, self._place_of_time())
            last = now
            yield TimePoint(now), values
        if last == BEFORE_ALL:
            raise LineError(self.name, "at least one state", "none")

    def place(self, term: str | None = None) -> str:
        """Return the place of the present state, or of the value of a feature in it."""
        key = None if term is None else self._keys.get(term, term)
        return self._place_of_value(key)

    def terms(self) -> Collection[str]:
        """Return the features that are there in the present state, as they are printed."""
        return list(map(printed_feature, from_json(self._lines.line)["values"]))

    def _parts(self, document: Any, line: bytes) -> tuple[int, Mapping[str, Any]]:
        """Return the time, in nanoseconds, and the features that a line is about."""
        if type(document) is not dict:
            raise LineError(self._lines.place(1), "an object", described(document))
        t, values = document.get("t"), document.get("values")
        if type(values) is not dict or t is None:
            self._refuse_parts(document)
        if line.count(b":") != len(document) + len(values):
            forbid_repetition(self._lines)
        now = t * MILLISECOND if type(t) is int else LATEST + 1
        if not -LATEST <= now <= LATEST:
            if isinstance(t, str):
                raise LineError(self._place_of_time(), "a number of milliseconds", described(t))
            now = time_from(t, self._place_of_time)
        return now, self._fit(values)

    def _fit(self, values: dict[str, Any]) -> Mapping[str, Any]:
        """Return the features of a state by their printed terms."""
        try:
            is_fit = _UNFIT.isdisjoint(values.values())
        except TypeError:
            is_fit = False
        if not is_fit:
            self._forbid_unfit(values)
        if self._is_as_printed:
            return values
        try:
            if self._keys:
                return {term: values[key] for term, key in self._keys.items()}
        except KeyError:
            pass  # this state calls its features by other names than those before
        return self._matched(values)

    def _matched(self, values: dict[str, Any]) -> Mapping[str, Any]:
        """Find out by which names the features that are needed are called."""
        self._keys, twice = match_features(self._terms, values)
        for term, (_, other) in twice.items():
            raise LineError(self._place_of_value(other), f"'{term}' once", f"'{other}' as well")
        complete = len(self._keys) == len(self._terms)
        self._is_as_printed = complete and all(t == key for t, key in self._keys.items())
        return {term: values[key] for term, key in self._keys.items()}

    def _place_of_time(self) -> str:
        return self._lines.place(columns_in(self._lines).get("t"))

    def _place_of_value(self, key: str | None) -> str:
        """Return where the value of a feature is, or only the line if that is not to be found."""
        if key is None:
            return self._lines.place()
        return self._lines.place(columns_in(self._lines, "values").get(key))

    def _refuse_parts(self, document: dict[str, Any]) -> NoReturn:
        """Say what is wrong with a line that has no time or no values."""
        for key, what in (("t", "a time"), ("values", "an object with the features")):
            if key not in document:
                found = missing_feature(key, document)
                raise LineError(self._lines.place(1), f"'{key}', {what}", found)
        if document["t"] is None:
            raise LineError(self._place_of_time(), "a number of milliseconds", "null")
        place = self._lines.place(columns_in(self._lines)["values"])
        raise LineError(place, "an object with the features", described(document["values"]))

    def _forbid_unfit(self, values: Mapping[str, Any]) -> None:
        for key, value in values.items():
            if isinstance(value, list | dict):
                expected, found = "a boolean, a number or a text", described(value)
            elif value in _INFINITE:
                expected, found = "a number below 1.8e308", "a greater one"
            elif value is None and match_features(self._terms, [key])[0]:
                expected, found = f"a value of '{key}'", "null"
            else:
                continue
            raise LineError(self._place_of_value(key), expected, found)

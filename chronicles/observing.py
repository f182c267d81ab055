"""From the samples of a stream to the changes of attributes."""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from chronicles.attributes import AttributeOrigin
from chronicles.events import Event, Recognition, event_from_recognition
from dyknow.errors import FeatureError
from dyknow.streams.policy import Constraint, Violation
from dyknow.streams.process import Element, Reactive
from dyknow.streams.sample import NO_VALUE, Heartbeat, Sample
from dyknow.streams.selecting import find_field
from dyknow.streams.table import Column, Table, positions_of
from dyknow.time import TimePoint

__all__ = ["AttributeChanges", "value_text"]

_NOTHING = Sample(NO_VALUE, TimePoint(-1), TimePoint(-1))

Rows = npt.NDArray[np.intp]


class AttributeChanges(Reactive):
    """Emits the changes of attributes from sample to sample of a stream (Heintz 2009, 8.7.3).

    One tuple of events comes out for each sample, also an empty one: it says that nothing changed
    up to its valid time. The first value of an attribute is a change from unknown, and so is the
    first of an object in a table. A value is unknown again when the sample has none, when a table
    has the object no more, and where its naming says so. Events, and recognitions, are passed on
    if they have the name of an attribute. Heartbeats are passed on.

    A sample of which no discrete value can be taken is left out; that is published as a violation.
    """

    def __init__(self, stream: str) -> None:
        """Look at the stream with the label *stream*."""
        self._stream = stream
        self._origins: dict[AttributeOrigin, int] = {}
        self._last: Sample[Any] = _NOTHING
        self._violations: list[Violation] = []

    @property
    def origins(self) -> tuple[AttributeOrigin, ...]:
        """What is looked at."""
        return tuple(self._origins)

    def watch(self, origins: Iterable[AttributeOrigin]) -> None:
        """Look at some attributes, for one more who needs them."""
        for origin in origins:
            self._origins[origin] = self._origins.get(origin, 0) + 1

    def leave(self, origins: Iterable[AttributeOrigin]) -> None:
        """Look at some attributes for one less."""
        for origin in origins:
            self._origins[origin] -= 1
            if not self._origins[origin]:
                del self._origins[origin]

    def begin(self, sample: Sample[Any]) -> None:
        """Take *sample* for the last one before what is pushed."""
        self._last = sample

    def present(self, origins: Iterable[AttributeOrigin]) -> Sample[tuple[Event, ...]] | None:
        """Return the present values of some attributes as changes from unknown, if there are any.

        They are valid at the time of the last sample. What only happens, at one time, is not
        present.
        """
        last = self._last
        states = [each for each in origins if not each.is_message]
        if last is _NOTHING or _is_happening(last.value):
            return None
        try:
            events = tuple(self._changes(states, NO_VALUE, last.value, last.valid_time))
        except FeatureError:  # which was published when the sample came
            return None
        return Sample(events, last.valid_time, last.available_time) if events else None

    def push(self, now: TimePoint, inputs: tuple[Sample[Any], ...]) -> list[Element]:
        """Emit what has changed since the sample before."""
        (sample,) = inputs
        last, time = self._last, sample.valid_time
        try:
            events = tuple(self._changes(self._origins, last.value, sample.value, time))
        except FeatureError as fault:
            reason = str(fault)
            self._violations.append(Violation(Constraint.CHANGE, time, now, reason, sample))
            return []
        self._last = sample
        return [Sample(events, time, now)]

    def beat(self, now: TimePoint, at: int, heartbeat: Heartbeat) -> list[Element]:  # noqa: ARG002, the protocol's
        """Pass on how far the stream is complete."""
        return [Heartbeat(heartbeat.until, now)]

    def take_violations(self) -> list[Violation]:
        """Return the samples that were unfit since this was last asked."""
        taken, self._violations = self._violations, []
        return taken

    def _changes(
        self, origins: Iterable[AttributeOrigin], old: Any, new: Any, time: TimePoint
    ) -> Iterator[Event]:
        if _is_happening(new):
            yield from _named(new, {origin.attribute for origin in origins})
            return
        for origin in origins:
            if origin.is_message:
                yield Event(origin.attribute, origin.objects or (), None, None, time)
            elif origin.objects is not None:
                yield from _change(origin, _value(origin, old), _value(origin, new), time)
            else:
                yield from _changes_of_rows(origin, old, new, time)


def value_text(value: Any) -> str | None:
    """Return what a value is called in chronicles; None if it is not known.

    Raises:
        ValueError: It is not discrete.
    """
    if isinstance(value, np.generic):
        value = value.item()
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return value
        case float() if value != value:  # noqa: PLR0124, NaN alone is not itself
            return None
        case int() | float():
            return str(value)
        case None:
            return None
        case _ if value is NO_VALUE:
            return None
        case _:
            raise ValueError(f"{type(value).__name__} {value!r}")


def _is_happening(value: Any) -> bool:
    """Return whether a value tells of events, or of recognitions."""
    return isinstance(value, tuple) and all(isinstance(e, Event | Recognition) for e in value)


def _named(happening: tuple[Event | Recognition, ...], names: set[str]) -> Iterator[Event]:
    for each in happening:
        event = event_from_recognition(each) if isinstance(each, Recognition) else each
        if event.attribute in names:
            yield event


def _value(origin: AttributeOrigin, value: Any) -> str | None:
    """Return the value of an attribute that is about the same objects all the time."""
    if value is NO_VALUE:
        return None
    return _text(origin, _field(origin, value, origin.path))


def _change(
    origin: AttributeOrigin, old: str | None, new: str | None, time: TimePoint
) -> Iterator[Event]:
    if old != new:
        yield Event(origin.attribute, origin.objects or (), old, new, time)


def _changes_of_rows(
    origin: AttributeOrigin, old: Any, new: Any, time: TimePoint
) -> Iterator[Event]:
    """Yield the changes of an attribute in the rows of two tables, in the order of the newer."""
    was, becomes = _table(origin, old), _table(origin, new)
    gone = was.select(positions_of(was.ids, becomes.ids) < 0) if len(was) else was
    before = positions_of(becomes.ids, was.ids)
    if len(gone):
        for objects, value in zip(_objects(origin, gone), _texts(origin, gone), strict=True):
            if value is not None:
                yield Event(origin.attribute, objects, value, None, time)
    rows = _changed(origin, was, becomes, before)
    if not len(rows):
        return
    changed, at = becomes.select(rows), before[rows]
    old_texts = [None] * len(rows) if not len(was) else _texts(origin, was.select(at))
    for objects, is_new, value, other in zip(
        _objects(origin, changed), at < 0, old_texts, _texts(origin, changed), strict=True
    ):
        last = None if is_new else value
        if last != other:
            yield Event(origin.attribute, objects, last, other, time)


def _changed(origin: AttributeOrigin, was: Table, becomes: Table, before: Rows) -> Rows:
    """Return the rows that are new, or whose value is not the same as before."""
    if not len(was) or not len(becomes):
        return np.arange(len(becomes))
    new = _column(origin, becomes)
    old = _column(origin, was)[before]
    differs = new != old
    if new.dtype.kind == "f" and old.dtype.kind == "f":
        differs &= ~(np.isnan(new) & np.isnan(old))
    return np.flatnonzero(differs | (before < 0))


def _table(origin: AttributeOrigin, value: Any) -> Table:
    if value is NO_VALUE:
        return _EMPTY
    if not isinstance(value, Table):
        found = type(value).__name__
        raise FeatureError(origin.attribute, f"a table in '{origin.stream}'", found)
    return value


def _column(origin: AttributeOrigin, table: Table) -> Column:
    column: Column = _field(origin, table, origin.path[:1])
    if len(origin.path) > 1:
        column = np.array([_field(origin, each, origin.path[1:]) for each in column], dtype=object)
    if column.ndim != 1:
        found = f"{column.ndim - 1} dimensions"
        raise FeatureError(origin.attribute, "one value in each row", found)
    return column


def _texts(origin: AttributeOrigin, table: Table) -> list[str | None]:
    return [_text(origin, value) for value in _column(origin, table).tolist()]


def _text(origin: AttributeOrigin, value: Any) -> str | None:
    naming = origin.naming or value_text
    try:
        return naming(value)
    except (ValueError, LookupError) as fault:
        expected = "a value that has a name" if origin.naming else "a discrete value"
        raise FeatureError(origin.attribute, expected, str(fault)) from None


def _objects(origin: AttributeOrigin, table: Table) -> list[tuple[str, ...]]:
    """Return what the rows of a table are about."""
    if origin.rows is None:
        return [(table.symbol(each),) for each in table.ids.tolist()]
    columns = [_names(origin, table, pattern) for pattern in origin.rows]
    return list(zip(*columns, strict=True))


def _names(origin: AttributeOrigin, table: Table, pattern: str) -> list[str]:
    """Return, for each row, a text between whose percent signs stand columns."""
    names = [""] * len(table)
    for at, part in enumerate(pattern.split("%")):
        if at % 2 == 0:
            names = [name + part for name in names]
            continue
        column = table.ids if part == "id" else _field(origin, table, (part,))
        names = [f"{name}{each}" for name, each in zip(names, column.tolist(), strict=True)]
    return names


def _field(origin: AttributeOrigin, value: Any, path: tuple[str, ...]) -> Any:
    try:
        return find_field(value, path)
    except ValueError as fault:
        expected = f"a field '{'.'.join(path)}' in the values of '{origin.stream}'"
        raise FeatureError(origin.attribute, expected, str(fault)) from None


_EMPTY = Table("none", (), {})
